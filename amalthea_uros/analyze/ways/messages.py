"""The hops of a message outside executors: the agent, the wire, the link, the driver, interrupts, tasks of the middleware.

A transmission is a task of its wire: its response time is the time from queueing to the end of its last frame, with all waiting for
the wire. Interrupts and tasks of the middleware are processes that it activates one after the other: each takes at most its response
time from its activation.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from amalthea_uros.analyze.solution import Solution
from amalthea_uros.analyze.ways.results import Hop, HopKind
from amalthea_uros.perf.network import Direction, Purpose, Span, Transmission
from amalthea_uros.perf.software import Isr, Task
from amalthea_uros.units import Time

_STATED = "stated"

#: The key of a latency of the agent, by what is sent where.
_AGENT_KEYS = {Direction.TO_CONTROLLER: "to_controller", Direction.TO_AGENT: "to_host"}


def received(transmission: Transmission, solution: Solution) -> Iterator[Hop]:
    """From the first byte of a message on the wire until the executor, or the process that takes it, can see it."""
    yield wire_hop(transmission, solution)
    yield from _link(transmission)
    yield from _driver(transmission)
    for name in transmission.processes:
        yield process_hop(name, solution)


def sent(transmission: Transmission, solution: Solution) -> Iterator[Hop]:
    """From the end of the callback that sends a message to its last byte at the agent."""
    yield from _driver(transmission)
    yield wire_hop(transmission, solution)
    yield from _link(transmission)


def agent_hop(transmission: Transmission, solution: Solution) -> Hop:
    """From the host to the wire, from the wire to the host, or from a message to its acknowledgement."""
    is_answer = transmission.purpose is Purpose.ACKNOWLEDGEMENT
    key = "acknowledgement" if is_answer else _AGENT_KEYS[transmission.direction]
    agent = solution.context.system.network.agent
    return _of_span(
        HopKind.AGENT,
        agent,
        transmission.agent,
        f"{key!r} of the agent is not stated",
        f"Measure how long {agent!r} takes, and set 'middleware.agent.{key}'.",
    )


def wire_hop(transmission: Transmission, solution: Solution) -> Hop:
    """Waiting for the wire and the transmission of all frames of a message."""
    response = solution.responses.get(transmission.name)
    if response is None or response.worst is None:
        why = response.reason if response is not None else solution.reasons.get(transmission.name, "it was not analysed")
        reason = f"the time of {transmission.name!r} on {transmission.wire!r} has no bound: {why}"
        best = response.best if response is not None else solution.bcet(transmission.name)
        remedy = f"See the results of {transmission.name!r}."
        if response is not None and response.is_overload:
            remedy = f"Increase the rate of {transmission.wire!r}, send less often, or without acknowledgements."
        return Hop(kind=HopKind.WIRE, name=transmission.wire, best=best, worst=None, source="", reason=reason, remedy=remedy)
    if (sender := _only_sender(transmission, solution)) is not None:
        solution.context.notes.assume(f"a write to {transmission.wire} returns when the message is on the wire, not before")
        return Hop(
            kind=HopKind.WIRE,
            name=transmission.wire,
            best=response.best,
            worst=min(response.worst, _longest(transmission, solution)),
            source=f"only {sender} sends there, and a write returns when the message is on the wire, so that no message waits",
        )
    return Hop(
        kind=HopKind.WIRE,
        name=transmission.wire,
        best=response.best,
        worst=response.worst,
        source=f"response time of {transmission.name} by {response.method}",
    )


def _only_sender(transmission: Transmission, solution: Solution) -> str | None:
    """The executor that alone sends in the direction of a message, where the driver keeps it until each message is on the wire.

    One of its messages never waits for another one, however close to each other the task model has to assume them.
    """
    system = solution.context.system
    wire = next((each for each in system.network.wires if each.name == transmission.wire), None)
    if wire is None or not wire.keeps_sender or wire.loses_messages or len(wire.cores) < len(Direction):
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
        own = {each.transmission for handle in executor.handles for each in handle.publications}
        if len(system.executors) == 1 and not has_threads:
            # Without other threads, acknowledgements and heartbeats are sent by the executor while it waits.
            own |= {name for name, purpose in sent.items() if purpose in (Purpose.ACKNOWLEDGEMENT, Purpose.HEARTBEAT)}
        if sent.keys() <= own:
            return executor.name
    return None


def _longest(transmission: Transmission, solution: Solution) -> Time:
    """The longest time of a message on its wire, without waiting for it; its response time is known, so its demand is, too."""
    name = transmission.name
    return -(-solution.context.demands[name].worst // solution.context.time_base(name))


def process_hop(name: str, solution: Solution) -> Hop:
    """From the activation of a process that a message passes to its end."""
    kind = HopKind.INTERRUPT if isinstance(solution.context.system.processes.get(name), Isr) else HopKind.MIDDLEWARE
    response = solution.responses.get(name)
    best = response.best if response is not None else solution.bcet(name)
    if response is None or response.worst is None or solution.depends_on_losses(name):
        why = response.reason if response is not None else solution.reasons.get(name, "it was not analysed")
        reason = f"the response time of {name!r} has no bound: {why or 'it can lose activations'}"
        return Hop(
            kind=kind, name=name, best=best, worst=None, source="", reason=reason, remedy=f"See the results of {name!r}."
        )
    return Hop(kind=kind, name=name, best=best, worst=response.worst, source=f"response time by {response.method}")


def variation(hops: Sequence[Hop]) -> Time | None:
    """How much the time of hops varies; None if that is unknown."""
    times = [hop.worst - hop.best for hop in hops if hop.worst is not None]
    return sum(times) if len(times) == len(hops) else None


def _link(transmission: Transmission) -> Iterator[Hop]:
    if transmission.link != Span(most=0):
        yield _of_span(
            HopKind.LINK,
            transmission.wire,
            transmission.link,
            f"'latency' of {transmission.wire!r} is not stated",
            "Measure how long a message takes besides its transmission, and set 'latency' of the transport.",
        )


def _driver(transmission: Transmission) -> Iterator[Hop]:
    if transmission.driver != Span(most=0):
        yield _of_span(
            HopKind.DRIVER,
            f"driver of {transmission.wire}",
            transmission.driver,
            f"the time in the driver of {transmission.wire!r} is unknown",
            "Set 'tick' of its driver, or of the operating system.",
        )


def _of_span(kind: HopKind, name: str, span: Span, reason: str, remedy: str) -> Hop:
    if span.most is None:
        return Hop(kind=kind, name=name, best=span.least, worst=None, source="", reason=reason, remedy=remedy)
    return Hop(kind=kind, name=name, best=span.least, worst=span.most, source=_STATED)
