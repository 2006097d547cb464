"""The hops of a message outside executors: the agent, the wire, the link, the driver, interrupts, tasks of the middleware.

A transmission is a task of its wire: its response time is the time from queueing to the end of its last frame, with all waiting for
the wire. Interrupts and tasks of the middleware are processes that it activates one after the other: each takes at most its response
time from its activation.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from amalthea_uros.executors.bounds.solved_system import SolvedSystem
from amalthea_uros.executors.results import Hop, HopKind
from amalthea_uros.executors.semantics.losses import can_be_sent_again
from amalthea_uros.executors.semantics.readiness import thread_of
from amalthea_uros.perf.network import Direction, Purpose, Span, Transmission
from amalthea_uros.perf.software import Isr, Task
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.time_base import max_time
from amalthea_uros.units import Time

#: Why an unknown latency of the agent does not make arrivals unknown, if the description states the jitter of messages.
_STATED_JITTER = "where the latency of the agent is not stated, the stated jitter is that of the messages that enter the wire"

#: Based on what a wait for missing messages is bounded.
WAIT_SOURCE = "as many attempts to send it again as messages can be lost"

#: The key of a latency of the agent, by what is sent where.
_AGENT_KEYS = {Direction.TO_CONTROLLER: "to_controller", Direction.TO_AGENT: "to_host"}


def received(transmission: Transmission, solved: SolvedSystem) -> Iterator[Hop]:
    """From the first byte of a message on the wire until the executor, or the process that takes it, can see it."""
    yield wire_hop(transmission, solved)
    yield from _link(transmission)
    yield from _driver(transmission, solved.context.system.in_driver(transmission))
    for name in transmission.processes:
        yield process_hop(name, solved)


def sent(transmission: Transmission, solved: SolvedSystem) -> Iterator[Hop]:
    """From the end of the callback that sends a message to its last byte at the agent."""
    yield from _driver(transmission, transmission.driver)
    yield wire_hop(transmission, solved)
    yield from _link(transmission)


def agent_hop(transmission: Transmission, solved: SolvedSystem) -> Hop:
    """From the host to the wire, from the wire to the host, or from a message to its acknowledgement."""
    is_answer = transmission.purpose is Purpose.ACKNOWLEDGEMENT
    key = "acknowledgement" if is_answer else _AGENT_KEYS[transmission.direction]
    agent = solved.context.system.network.agent
    return _of_span(
        HopKind.AGENT,
        agent,
        transmission.agent,
        f"{key!r} of the agent is not stated"
        if transmission.agent.mean is None
        else f"only the mean of {key!r} of the agent is known",
        f"Measure how long {agent!r} takes, and set 'middleware.agent.{key}'.",
    )


def wire_hop(transmission: Transmission, solved: SolvedSystem) -> Hop:
    """Waiting for the wire and the transmission of all frames of a message."""
    response = solved.responses.get(transmission.name)
    if response is None or response.worst is None:
        why = response.reason if response is not None else solved.reasons.get(transmission.name, "it was not analysed")
        reason = f"the time of {transmission.name!r} on {transmission.wire!r} has no bound: {why}"
        best = response.best if response is not None else solved.bcet(transmission.name)
        remedy = f"See the results of {transmission.name!r}."
        if response is not None and response.is_overload:
            remedy = f"Increase the rate of {transmission.wire!r}, send less often, or without acknowledgements."
        return Hop(kind=HopKind.WIRE, name=transmission.wire, best=best, reason=reason, remedy=remedy)
    worst, source = response.worst, f"response time of {transmission.name} by {response.method}"
    if (sender := _only_sender(transmission, solved)) is not None:
        solved.context.notes.assume(f"a write to {transmission.wire} returns when the message is on the wire, not before")
        # Its response time is known, so its demand is, too.
        demand = solved.context.demands[transmission.name].worst
        worst = min(worst, max_time(demand, solved.context.time_base(transmission.name)))
        source = f"only {sender} sends there, and a write returns when the message is on the wire, so that no message waits"
    return Hop(kind=HopKind.WIRE, name=transmission.wire, best=response.best, worst=worst, source=source)


def _only_sender(transmission: Transmission, solved: SolvedSystem) -> str | None:
    """The executor whose thread alone sends in the direction of a message, if the driver keeps it until each message is on the wire.

    One of its messages never waits for another one, however close to each other the task model has to assume them.
    """
    system = solved.context.system.client_at(transmission.wire)
    wire = next((each for each in system.network.wires if each.name == transmission.wire), None)
    if wire is None or not wire.keeps_sender or len(wire.cores) < len(Direction):
        return None
    sent = {
        each.name: each.purpose
        for each in system.network.transmissions
        if (each.wire, each.direction) == (transmission.wire, transmission.direction)
    }
    has_threads = any(
        isinstance(system.processes.get(name), Task) for each in system.network.transmissions for name in each.processes
    )
    for executor in system.executors:
        thread = thread_of(executor, system.executors)
        own = {each.transmission for member in thread for handle in member.handles for each in handle.publications}
        if len(thread) == len(system.executors) and not has_threads:
            # Without other threads, acknowledgements and heartbeats are sent by the executors while they wait.
            own |= {name for name, purpose in sent.items() if purpose in (Purpose.ACKNOWLEDGEMENT, Purpose.HEARTBEAT)}
        if sent.keys() <= own:
            return executor.name
    return None


def process_hop(name: str, solved: SolvedSystem) -> Hop:
    """From the activation of a process that a message passes to its end."""
    kind = HopKind.INTERRUPT if isinstance(solved.context.system.processes.get(name), Isr) else HopKind.MIDDLEWARE
    response = solved.responses.get(name)
    best = response.best if response is not None else solved.bcet(name)
    if response is None or response.worst is None or solved.depends_on_losses(name):
        why = response.reason if response is not None else solved.reasons.get(name, "it was not analysed")
        reason = f"the response time of {name!r} has no bound: {why or 'it can lose activations'}"
        return Hop(kind=kind, name=name, best=best, reason=reason, remedy=f"See the results of {name!r}.")
    return Hop(kind=kind, name=name, best=best, worst=response.worst, source=f"response time by {response.method}")


def wait_for_missing(transmission: Transmission, system: System, waits: Mapping[str, Time | None]) -> Hop | None:
    """The time for which a reliable message waits for one that was lost before it; None if none can be lost.

    Parameters
    ----------
    waits : the bounds that are known, by the names of transmissions
    """
    if not can_be_sent_again(transmission, system):
        return None
    if (longest := waits.get(transmission.name)) is not None:
        return Hop(kind=HopKind.LINK, name=transmission.wire, best=0, worst=longest, source=WAIT_SOURCE)
    reason = (
        f"messages can be lost on {transmission.wire!r}, and a reliable one waits until those before it have been sent again"
    )
    remedy = "Use best effort where losses are harmless: what is lost is then gone, and nothing waits for it."
    return Hop(kind=HopKind.LINK, name=transmission.wire, best=0, reason=reason, remedy=remedy)


def variation(hops: Sequence[Hop]) -> Time | None:
    """How much the time of hops varies; None if that is unknown."""
    times = [hop.worst - hop.best for hop in hops if hop.worst is not None]
    return sum(times) if len(times) == len(hops) else None


def arrival_jitter(solved: SolvedSystem, waits: Mapping[str, Time | None]) -> Mapping[str, Time | None]:
    """How far the arrivals at handles vary, besides the jitter that is stated, by the names of handles; None if a hop has no bound.

    Each hop before can take its best or its worst time (K. Richter 2005).

    Parameters
    ----------
    waits : for messages that are missing before a reliable one, by the names of transmissions; None if they have no bound
    """
    found: dict[str, Time | None] = {}
    for executor in solved.context.system.executors:
        for handle in executor.handles:
            transmission = solved.context.system.transmissions.get(handle.transmission or "")
            if transmission is None:
                continue
            agent = agent_hop(transmission, solved)
            # Otherwise, nothing activates what stands for the message on the wire, which has no bound then.
            stated = [] if agent.worst is None else [agent]
            jitter, wait = variation([*stated, *received(transmission, solved)]), waits.get(transmission.name, Time(0))
            found[handle.name] = jitter = None if jitter is None or wait is None else jitter + wait
            if agent.worst is None and jitter is not None:
                solved.context.notes.assume(_STATED_JITTER)
    return found


def _link(transmission: Transmission) -> Iterator[Hop]:
    if transmission.link != Span(most=0):
        yield _of_span(
            HopKind.LINK,
            transmission.wire,
            transmission.link,
            f"'latency' of {transmission.wire!r} is not stated",
            "Measure how long a message takes besides its transmission, and set 'latency' of the transport.",
        )


def _driver(transmission: Transmission, time: Span) -> Iterator[Hop]:
    if time != Span(most=0):
        yield _of_span(
            HopKind.DRIVER,
            f"driver of {transmission.wire}",
            time,
            f"the time in the driver of {transmission.wire!r} is unknown",
            "Set 'tick' of its driver, or of the operating system.",
        )


def _of_span(kind: HopKind, name: str, span: Span, reason: str, remedy: str) -> Hop:
    if span.most is None:
        return Hop(kind=kind, name=name, best=span.least, reason=reason, remedy=remedy)
    return Hop(kind=kind, name=name, best=span.least, worst=span.most, source="stated")
