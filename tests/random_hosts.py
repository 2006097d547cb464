"""Random hosts, as systems and as what the player of `played_host` knows."""

from dataclasses import replace
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
    threads = [Thread(kind, 10 - index, []) for index in range(count)]
    callbacks, sources, paths = random_callbacks(random, random.uniform(0.2, 0.7), 4)
    for each in callbacks:
        random.choice(threads).callbacks.append(each)
    return [thread for thread in threads if thread.callbacks], sources, paths


def random_callbacks(random, left, chains):
    """Callbacks of chains with topics from outside, which need so much of a core."""
    callbacks, sources, paths = [], {}, []
    for number in range(random.randint(1, chains)):
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
            callbacks.append(each)
        paths.append(names)
    return callbacks, sources, paths


def random_groups(random):
    """Callbacks of a multi-threaded executor with their groups ("": reentrant), sources and paths, and its number of threads."""
    threads = random.randint(2, 4)
    callbacks, sources, paths = random_callbacks(random, random.choice([0.7, 0.5 * threads]), 5)
    names = random.choice([["a"], ["a", "b"], ["a", "b", "c", "d"], ["", "a"], [""], ["", "a", "b", "c"]])
    if random.random() < 0.3:
        groups = {name: path[0] for path in paths for name in path}
    else:
        groups = {each.name: random.choice(names) for each in callbacks}
    return callbacks, groups, sources, paths, threads


def arrivals(random, period, jitter, horizon):
    """Messages that come with a jitter; often all of it at first and then none, so that they come close to each other."""
    phase, style = random.randrange(period), random.random()
    times = []
    for nominal in range(phase, horizon, period):
        late = jitter if nominal < horizon // 2 and style < 0.5 else 0
        times.append(nominal + (late if style < 0.5 else random.randint(0, jitter)))
    return sorted(times)


def phases(random, callbacks):
    return {each.name: random.randrange(each.period) for each in callbacks if each.period}


def chain_of(names):
    events = [f"{names[0]}_start", *(f"{name}_finish" for name in names)]
    segments = tuple(Segment(stimulus=one, response=other) for one, other in pairwise(events))
    return [CustomEvent(name=each) for each in events], EventChain(
        name=names[-1], stimulus=events[0], response=events[-1], items=Sequence(segments)
    )


def system_of(threads, sources, paths, release=None):
    """The system of executors on one core; its distribution is that of `KINDS` if none is given."""
    kind, usual = KINDS[threads[0].kind]
    release = release or usual
    executors = (
        HostExecutor(
            name=f"E{index}",
            computer="pc",
            kind=kind,
            thread=HostThread(policy=HostPolicy.FIFO, priority=thread.priority),
            callbacks=tuple(map(host_callback, thread.callbacks)),
        )
        for index, thread in enumerate(threads)
    )
    callbacks = [each for thread in threads for each in thread.callbacks]
    return _system(release, 1, executors, callbacks, sources, paths)


def multi_threaded_system_of(callbacks, groups, sources, paths, threads, release):
    """The system of a multi-threaded executor with a core for each thread."""
    executor = HostExecutor(
        name="E",
        computer="pc",
        kind=HostExecutorKind.MULTI_THREADED,
        thread=HostThread(policy=HostPolicy.FIFO, priority=1),
        threads=threads,
        callbacks=tuple(
            replace(host_callback(each), group=groups[each.name], is_reentrant=not groups[each.name]) for each in callbacks
        ),
    )
    return _system(release, threads, [executor], callbacks, sources, paths)


def host_callback(each):
    return HostCallback(
        name=each.name,
        kind=HandleKind.TIMER if each.period else HandleKind.SUBSCRIPTION,
        execution=Span(least=each.best, most=each.worst),
        period=each.period or None,
        topic=each.topic or None,
        depth=each.depth,
        publishes=tuple(each.sends),
    )


def _system(release, cores, executors, callbacks, sources, paths):
    latencies = {topic: latency for each in callbacks for topic, latency in each.sends.items()}
    chains = [chain_of(path) for path in paths]
    host = Host(
        release=release,
        computers=(HostComputer(name="pc", cores=cores),),
        executors=tuple(executors),
        topics=(
            *(HostTopic(name=name, latency=Span(least=time, most=time)) for name, time in latencies.items()),
            *(HostTopic(name=name, interval=interval, jitter=jitter) for name, (interval, jitter) in sources.items()),
        ),
    )
    events = Events(events=tuple(event for names, _ in chains for event in names), chains=tuple(chain for _, chain in chains))
    return System(host=host, events=events)
