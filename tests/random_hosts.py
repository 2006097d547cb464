"""Random hosts, as systems and as what the player of `played_host` knows."""

from itertools import pairwise

from played_host import Callback, Thread

from amalthea_uros.perf.events import CustomEvent, EventChain, Events, Segment, Sequence
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.perf.host import (
    Host,
    HostCallback,
    HostComputer,
    HostExecutor,
    HostExecutorKind,
    HostPolicy,
    HostThread,
    HostTopic,
    RosRelease,
)
from amalthea_uros.perf.network import Span
from amalthea_uros.perf.system import System

KINDS = {
    "single": (HostExecutorKind.SINGLE_THREADED, RosRelease.JAZZY),
    "batch": (HostExecutorKind.STATIC, RosRelease.HUMBLE),
    "first": (HostExecutorKind.STATIC, RosRelease.JAZZY),
    "events": (HostExecutorKind.EVENTS, RosRelease.JAZZY),
}


def random_threads(random, kind):
    """One to three executors, with chains through them and topics from outside; at most about 70 % of the core."""
    count = random.choice([1, 1, 2, 3])
    threads, sources, paths = [Thread(kind, 10 - index, []) for index in range(count)], {}, []
    left = random.uniform(0.2, 0.7)
    for number in range(random.randint(1, 4)):
        period, hops = random.choice([20, 30, 40, 60, 100]), random.choice([1, 1, 2, 3])
        share, names, before = left * random.uniform(0.2, 0.6), [], None
        left -= share
        for hop in range(hops):
            worst = max(1, int(period * share / hops))
            each = Callback(f"c{number}_{hop}", worst, random.randint(1, worst))
            names.append(each.name)
            if before is not None:
                each.topic = f"m{number}_{hop}"
                before.sends[each.topic] = random.choice([0, 0, 0, 3])
            elif random.random() < 0.4:
                each.topic = f"in{number}"
                sources[each.topic] = (period, random.choice([0, period // 2, 2 * period]))
            else:
                each.period = period
            before = each
            random.choice(threads).callbacks.append(each)
        paths.append(names)
    return [thread for thread in threads if thread.callbacks], sources, paths


def chain_of(names):
    events = [f"{names[0]}_start", *(f"{name}_finish" for name in names)]
    segments = tuple(Segment(stimulus=one, response=other) for one, other in pairwise(events))
    return [CustomEvent(name=each) for each in events], EventChain(
        name=names[-1], stimulus=events[0], response=events[-1], items=Sequence(segments)
    )


def system_of(threads, sources, paths):
    latencies = {topic: latency for thread in threads for each in thread.callbacks for topic, latency in each.sends.items()}
    chains = [chain_of(path) for path in paths]
    kind, release = KINDS[threads[0].kind]
    host = Host(
        release=release,
        computers=(HostComputer(name="pc", cores=1),),
        executors=tuple(
            HostExecutor(
                name=f"E{index}",
                computer="pc",
                kind=kind,
                thread=HostThread(policy=HostPolicy.FIFO, priority=thread.priority),
                callbacks=tuple(
                    HostCallback(
                        name=each.name,
                        kind=HandleKind.TIMER if each.period else HandleKind.SUBSCRIPTION,
                        execution=Span(least=each.best, most=each.worst),
                        period=each.period or None,
                        topic=each.topic or None,
                        depth=each.depth,
                        publishes=tuple(each.sends),
                    )
                    for each in thread.callbacks
                ),
            )
            for index, thread in enumerate(threads)
        ),
        topics=(
            *(HostTopic(name=name, latency=Span(least=time, most=time)) for name, time in latencies.items()),
            *(HostTopic(name=name, interval=interval, jitter=jitter) for name, (interval, jitter) in sources.items()),
        ),
    )
    events = Events(events=tuple(event for names, _ in chains for event in names), chains=tuple(chain for _, chain in chains))
    return System(host=host, events=events)
