"""Random hosts with everything that a description has: policies, kinds of executors, groups, services, variables, shared topics."""

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
    """Callbacks in chains: each hop is a topic, a service, a variable, or a topic of an earlier chain; `callbacks` are keywords."""

    def __init__(self, random, load):
        self.random, self.callbacks, self.topics, self.paths = random, {}, [], []
        for number in range(random.randint(1, 4)):
            share = load * random.uniform(0.1, 0.5)
            load -= share
            self.add_chain(number, share)

    def add_chain(self, number, share):
        period, hops = self.random.choice([20, 30, 40, 60, 100]), self.random.randint(1, 3)
        cost = max(1, int(period * share / hops))
        name = f"c{number}_0"
        if self.random.random() < 0.35:
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
            self.add(name, cost, period=self.random.choice([20, 30, 50]), reads=[f"v{label}"])
            return [name]
        self.callbacks[before]["publishes"].append(self.topic(f"m{label}"))
        self.add(name, cost, topic=f"m{label}")
        if self.random.random() < 0.2:
            self.add(f"{name}_too", cost, topic=f"m{label}")
        return [name]

    def topic(self, name):
        least, most = self.random.choice([(0, 0), (0, 0), (0, 3), (2, 2), (1, 9)])
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


def random_executors(random):
    """Executors without callbacks, their number of cores, and which of them are isolated."""
    executors, isolated, core = [], [], 0

    def add(kind, thread, threads=1):
        name = f"E{len(executors)}"
        executors.append({"name": name, "computer": "pc", "kind": kind, "thread": thread, "threads": threads})

    def fifo(*cores):
        return HostThread(policy=HostPolicy.FIFO, priority=random.randint(1, 4), cores=cores)

    for _ in range(random.randint(1, 3)):
        match random.choice(["fifo", "fifo", "reserved", "shared", "own", "other"]):
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
    executors, cores, isolated = random_executors(random)
    chains = Chains(random, cores * random.uniform(0.2, 0.6))
    placed = {each["name"]: [] for each in executors}
    for callback in chains.callbacks.values():
        executor = random.choice(executors)
        is_reentrant = executor["kind"] is HostExecutorKind.MULTI_THREADED and random.random() < 0.3
        group = f"{executor['name']}/{'reentrant' if is_reentrant else random.choice('aab')}"
        lists = {key: tuple(callback[key]) for key in ("publishes", "reads", "writes")}
        placed[executor["name"]].append(HostCallback(**callback | lists, group=group, is_reentrant=is_reentrant))
    host = Host(
        release=release,
        computers=(HostComputer(name="pc", cores=cores, isolated=tuple(isolated)),),
        executors=tuple(HostExecutor(**each, callbacks=tuple(placed[each["name"]])) for each in executors),
        topics=tuple(chains.topics),
    )
    built = [chain_of(path) for path in chains.paths]
    events = {event.name: event for found, _ in built for event in found}
    return System(
        host=host, events=Events(events=tuple(events.values()), chains=tuple(chain for _, chain in built))
    ), chains.paths
