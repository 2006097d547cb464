"""The systems of the vectors as hosts."""

import json
from itertools import pairwise

from support import SHARED

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

FOLDER = SHARED / "vectors" / "ros2"
TYPES = {
    "single": HostExecutorKind.SINGLE_THREADED,
    "static": HostExecutorKind.STATIC,
    "multi": HostExecutorKind.MULTI_THREADED,
    "events": HostExecutorKind.EVENTS,
}


def every_entry():
    """All entries."""
    files = sorted(FOLDER.glob("*.json")) if FOLDER.exists() else []
    return [entry for path in files for entry in json.loads(path.read_text())["systems"]]


def entries():
    """The entries with a distribution that can be described."""
    return [entry for entry in every_entry() if all(each["distro"] != "dashing" for each in entry["system"]["executors"])]


def _thread(executor):
    if reserved := executor.get("reservation"):
        return HostThread(policy=HostPolicy.DEADLINE, budget=reserved["budget"], period=reserved["period"])
    cores = tuple(executor.get("cores", [executor.get("core", 0)]))
    return HostThread(policy=HostPolicy.FIFO, priority=executor.get("priority", 1), cores=cores)


def registers(system):
    """The pairs of callbacks of which the second one reads what the first one has left; each is a variable."""
    by_name = {each["name"]: each for each in system["callbacks"]}
    pairs = {pair for chain in system.get("chains", ()) for pair in pairwise(chain["path"])}
    return sorted(pair for pair in pairs if by_name[pair[1]].get("topic") not in by_name[pair[0]].get("publishes", ()))


def _callback(each, pairs):
    group = each.get("group", "default")
    return HostCallback(
        name=each["name"],
        kind=HandleKind(each["kind"]),
        execution=Span(least=each.get("bcet", each["wcet"]), most=each["wcet"]),
        period=each.get("period"),
        topic=each.get("topic"),
        depth=each.get("depth", 10),
        publishes=tuple(each.get("publishes", ())),
        reads=tuple(" to ".join(pair) for pair in pairs if pair[1] == each["name"]),
        writes=tuple(" to ".join(pair) for pair in pairs if pair[0] == each["name"]),
        group=group,
        is_reentrant=group == "reentrant",
    )


def host_of(system):
    """The host of a system; the vectors have two kinds of distributions, foxy to iron, and jazzy."""
    latencies = {each["name"]: each["latency"] for each in system.get("topics", ())}
    sources = {each["topic"]: each for each in system.get("sources", ())}
    names = {topic for each in system["callbacks"] for topic in (*each.get("publishes", ()), each.get("topic")) if topic}
    pairs = registers(system)
    is_late = any(executor["distro"] == "jazzy" for executor in system["executors"])
    return Host(
        release=RosRelease.JAZZY if is_late else RosRelease.FOXY,
        computers=(HostComputer(name="pc", cores=8),),
        executors=tuple(
            HostExecutor(
                name=executor["name"],
                computer="pc",
                kind=TYPES[executor["type"]],
                thread=_thread(executor),
                threads=executor.get("threads", 1),
                callbacks=tuple(_callback(each, pairs) for each in system["callbacks"] if each["executor"] == executor["name"]),
            )
            for executor in system["executors"]
        ),
        topics=tuple(
            HostTopic(
                name=name,
                latency=Span(least=latencies.get(name, [0, 0])[0], most=latencies.get(name, [0, 0])[1]),
                interval=sources[name]["period"] if name in sources else None,
                jitter=sources[name].get("jitter", 0) if name in sources else 0,
            )
            for name in sorted(names)
        ),
    )


def paths(system):
    """The chains of a system by name."""
    return {chain["name"]: chain["path"] for chain in system.get("chains", ())}


def chain_of(name, path):
    """A chain through callbacks of the host, with its events."""
    events = [f"{path[0]}_start", *(f"{each}_finish" for each in path)]
    segments = tuple(Segment(stimulus=one, response=other) for one, other in pairwise(events))
    chain = EventChain(name=name, stimulus=events[0], response=events[-1], items=Sequence(segments))
    return {each: CustomEvent(name=each) for each in events}, chain


def with_chains(host, paths):
    """The system of a host with chains, by name."""
    found = [chain_of(*path) for path in paths]
    events = {name: event for events, _ in found for name, event in events.items()}
    return System(host=host, events=Events(events=tuple(events.values()), chains=tuple(chain for _, chain in found)))
