"""Random hosts with everything that a description has: computers, policies, kinds of executors, groups, services, variables, topics."""

from random_hosts import chain_of

from amalthea_uros.perf.events import Events
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
)
from amalthea_uros.perf.network import Span
from amalthea_uros.perf.system import System

ONE_THREAD = (HostExecutorKind.SINGLE_THREADED, HostExecutorKind.STATIC, HostExecutorKind.EVENTS)


class Chains:
    """Callbacks in chains: each hop is a topic, a service, a variable, or a topic of an earlier chain; `callbacks` are keywords.

    Variables are read by timers, and by subscriptions that another timer wakes. If the chains are closed, timers alone begin them, and
    topics take no time.
    """

    def __init__(self, random, load, is_closed):
        self.random, self.callbacks, self.topics, self.paths = random, {}, [], []
        self.outside, self.latencies = (0, [(0, 0)]) if is_closed else (0.35, [(0, 0), (0, 0), (0, 3), (2, 2), (1, 9)])
        for number in range(random.randint(1, 4)):
            share = load * random.uniform(0.1, 0.5)
            load -= share
            self.add_chain(number, share)

    def add_chain(self, number, share):
        period, hops = self.random.choice([20, 30, 40, 60, 100]), self.random.randint(1, 3)
        cost = max(1, int(period * share / hops))
        name = f"c{number}_0"
        if self.random.random() < self.outside:
            topic = HostTopic(name=f"in{number}", interval=period, jitter=self.random.choice([0, period // 2, 2 * period]))
            self.topics.append(topic)
            self.add(name, cost, topic=topic.name)
        else:
            self.add(name, cost, period=period)
        path = [name]
        for hop in range(1, hops):
            path += self.add_hop(path[-1], f"{number}_{hop}", cost)
        self.paths.append(path)

    def add_hop(self, before, label, cost):
        """Add what comes after a callback, and return the names of the path."""
        kind = self.random.choice(["topic"] * 5 + ["service", "variable", "join"])
        joined = [each for each in self.callbacks.values() if each["topic"] and not each["name"].startswith(f"c{label[0]}")]
        if kind == "join" and joined:
            other = self.random.choice(joined)
            if other["topic"] not in [each.name for each in self.topics if each.interval]:
                self.callbacks[before]["publishes"].append(other["topic"])
            self.callbacks[before]["publishes"] = list(dict.fromkeys(self.callbacks[before]["publishes"]))
        if kind == "service":
            server, client = f"c{label}_server", f"c{label}_client"
            self.add(server, cost, kind=HandleKind.SERVICE, topic=self.topic(f"s{label}/request"))
            self.add(client, cost, kind=HandleKind.CLIENT, topic=self.topic(f"s{label}/response"))
            self.callbacks[before]["publishes"].append(f"s{label}/request")
            self.callbacks[server]["publishes"].append(f"s{label}/response")
            return [server, client]
        name = f"c{label}"
        if kind == "variable":
            self.callbacks[before]["writes"].append(f"v{label}")
            period = self.random.choice([20, 30, 50])
            if self.random.random() < 0.5:
                self.add(name, cost, period=period, reads=[f"v{label}"])
                return [name]
            self.add(f"{name}_clock", cost, period=period)
            self.callbacks[f"{name}_clock"]["publishes"].append(self.topic(f"k{label}"))
            self.add(name, cost, topic=f"k{label}", reads=[f"v{label}"])
            return [name]
        self.callbacks[before]["publishes"].append(self.topic(f"m{label}"))
        self.add(name, cost, topic=f"m{label}")
        if self.random.random() < 0.2:
            self.add(f"{name}_too", cost, topic=f"m{label}")
        return [name]

    def topic(self, name):
        least, most = self.random.choice(self.latencies)
        self.topics.append(HostTopic(name=name, latency=Span(least=least, most=most)))
        return name

    def add(self, name, cost, kind=HandleKind.SUBSCRIPTION, period=None, topic=None, reads=()):
        worst = self.random.randint(max(1, cost // 2), cost)
        self.callbacks[name] = {
            "name": name,
            "kind": HandleKind.TIMER if period else kind,
            "execution": Span(least=self.random.randint(1, worst), most=worst),
            "period": period,
            "topic": topic,
            "depth": self.random.choice([1, 1, 2, 10, 10, 10]),
            "publishes": [],
            "reads": list(reads),
            "writes": [],
        }


def random_executors(random, computer):
    """Executors without callbacks, their number of cores, and which of them are isolated."""
    executors, isolated, core = [], [], 0

    def add(kind, thread, threads=1):
        name = f"{computer}/E{len(executors)}"
        executors.append({"name": name, "computer": computer, "kind": kind, "thread": thread, "threads": threads})

    def fifo(*cores):
        return HostThread(policy=HostPolicy.FIFO, priority=random.randint(1, 4), cores=cores)

    for _ in range(random.randint(1, 3)):
        match random.choice(["fifo", "fifo", "reserved", "global", "shared", "own", "other"]):
            case "fifo":
                for _ in range(random.randint(1, 3)):
                    add(random.choice(ONE_THREAD), fifo(core))
            case "reserved":
                count = random.randint(1, 2)
                for _ in range(count):
                    period = random.choice([5, 10, 20])
                    budget = max(1, period * random.choice([45, 70, 90]) // 100 // count)
                    reserved = HostThread(policy=HostPolicy.DEADLINE, budget=budget, period=period, cores=(core,))
                    add(random.choice(ONE_THREAD), reserved)
                if random.random() < 0.5:
                    add(random.choice(ONE_THREAD), fifo(core))
            case "global":
                cores = range(core, core + random.randint(2, 3))
                for _ in range(random.randint(1, len(cores) + 2)):
                    period = random.choice([5, 10, 20])
                    budget = max(1, period * random.choice([15, 30, 45, 60]) // 100)
                    reserved = HostThread(policy=HostPolicy.DEADLINE, budget=budget, period=period, cores=tuple(cores))
                    is_one = random.random() < 0.95
                    add(random.choice(ONE_THREAD) if is_one else HostExecutorKind.MULTI_THREADED, reserved, 1 if is_one else 2)
                if random.random() < 0.3:
                    add(random.choice(ONE_THREAD), fifo(core))
                core = cores[-1]
            case "shared":
                add(HostExecutorKind.MULTI_THREADED, fifo(core), random.randint(1, 4))
                if random.random() < 0.5:
                    add(random.choice(ONE_THREAD), fifo(core))
            case "own":
                cores = range(core, core + random.randint(2, 3))
                add(HostExecutorKind.MULTI_THREADED, fifo(*cores), random.randint(1, 4))
                core = cores[-1]
            case "other":
                isolated.append(core)
                add(random.choice(ONE_THREAD), HostThread(cores=(core,)))
                if random.random() < 0.5:
                    add(random.choice(ONE_THREAD), fifo(core))
        core += 1
    return executors, core, isolated


def random_computer(random, release):
    """A system with a host, and the paths of its chains, of which each has the name of its last callback."""
    computers, executors = [], []
    for name in random.choice([("pc",), ("pc",), ("pc", "robot")]):
        threads, cores, isolated = random_executors(random, name)
        computers.append(HostComputer(name=name, cores=cores, isolated=tuple(isolated)))
        executors += threads
    # Executors that need more than their core have bounds, too, if nothing but their timers makes them work.
    is_overloaded = random.random() < 0.2
    load = random.uniform(1, 3) if is_overloaded else random.uniform(0.2, 0.6)
    chains = Chains(random, load * sum(each.cores for each in computers), is_closed=is_overloaded)
    placed = {each["name"]: [] for each in executors}
    for callback in chains.callbacks.values():
        executor = executors[0] if is_overloaded else random.choice(executors)
        is_reentrant = executor["kind"] is HostExecutorKind.MULTI_THREADED and random.random() < 0.3
        group = f"{executor['name']}/{'reentrant' if is_reentrant else random.choice('aab')}"
        lists = {key: tuple(callback[key]) for key in ("publishes", "reads", "writes")}
        placed[executor["name"]].append(HostCallback(**callback | lists, group=group, is_reentrant=is_reentrant))
    host = Host(
        release=release,
        computers=tuple(computers),
        executors=tuple(HostExecutor(**each, callbacks=tuple(placed[each["name"]])) for each in executors),
        topics=tuple(chains.topics),
    )
    built = [chain_of(path) for path in chains.paths]
    events = {event.name: event for found, _ in built for event in found}
    return System(
        host=host, events=Events(events=tuple(events.values()), chains=tuple(chain for _, chain in built))
    ), chains.paths
