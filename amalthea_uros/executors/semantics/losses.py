"""The losses of wires, and whether what they lead to has a bound."""

from __future__ import annotations

from amalthea_uros._internal.plural import counted
from amalthea_uros.executors.semantics.readiness import thread_of
from amalthea_uros.perf.executors import Publication
from amalthea_uros.perf.network import Direction, Losses, Purpose, Transmission, Wire, WireKind
from amalthea_uros.perf.software import Task
from amalthea_uros.perf.system import System
from amalthea_uros.units import time_text

_PERCENT = 10**7


def losses_text(wire: Wire, losses: Losses) -> str:
    """The assumption about the messages that a wire loses."""
    which = "" if len(losses.directions) == len(Direction) else f" {losses.directions[0]}"
    if losses.window:
        return f"{wire.name!r} loses at most {counted(losses.count, 'message')}{which} in any {time_text(losses.window)}"
    percent = f"{losses.per_billion / _PERCENT:.7f}".rstrip("0").rstrip(".")
    return f"{wire.name!r} loses each message{which} with a probability of {percent} %"


def publications(system: System) -> list[Publication]:
    """All publications of callbacks of executors."""
    return [each for executor in system.executors for handle in executor.handles for each in handle.publications]


def is_question(message: Transmission, system: System) -> bool:
    """Whether a message asks for something: its sender waits for an answer, which nobody sends again."""
    return any(each.transmission == message.name and each.waits and not each.reliable for each in publications(system))


def reliable_messages(wire: str, direction: Direction, system: System) -> list[Transmission]:
    """The messages in a direction of a wire that are sent again until they are acknowledged."""
    return [
        each for each in _data(wire, direction, system) if answer_to(each, system) is not None and not is_question(each, system)
    ]


def can_be_sent_again(message: Transmission, system: System) -> bool:
    """Whether a message is reliable, on a wire that loses messages."""
    lossy = {wire.name for wire in system.network.wires if wire.loses_messages}
    return message.wire in lossy and message in reliable_messages(message.wire, message.direction, system)


def recovers(publication: Publication, system: System) -> bool:
    """Whether a publication waits on a wire that loses messages, and what losses lead to has a bound."""
    message = system.transmissions.get(publication.transmission or "")
    wires = (each for each in system.network.wires if message is not None and each.name == message.wire)
    return publication.waits and publication.reliable and any(wire.losses and not why_unbounded(wire, system) for wire in wires)


def why_unbounded(wire: Wire, system: System) -> str:
    """Why what is sent again on a wire with losses has no bound; "" if it has one.

    The bound is for a client with one thread, all of whose reliable messages are publications that wait, in one part, on a wire that
    keeps their order. Of reliable messages to the controller, `bounds.missing` has further conditions.
    """
    sent, received = (reliable_messages(wire.name, each, system) for each in (Direction.TO_AGENT, Direction.TO_CONTROLLER))
    published = {each.transmission: each for each in publications(system)}
    if not wire.losses:
        return "how many are lost is not stated; state it, e.g. 'losses: 1 per 10 s'"
    if any(not losses.window for losses in wire.losses):
        return "with a probability, any number of messages can be lost; state how many are in some time, e.g. '1 per 10 s'"
    recovery = wire.recovery
    # The reliable streams of the agent have the same depth in both directions.
    if (
        recovery is None
        or recovery.sent_parts is None
        or recovery.sent_parts > (recovery.agent_sent_parts or recovery.sent_parts)
    ):
        return "it is not known how many messages are sent again at once"
    if wire.kind in (WireKind.CAN, WireKind.CAN_FD):
        return "messages with other identifiers overtake those that are sent again"
    executors = system.executors
    if not executors or len(thread_of(executors[0], executors)) < len(executors) or _has_threads(wire, system):
        return "several threads use the session"
    if any(each.name not in published for each in _data(wire.name, Direction.TO_AGENT, system)):
        return "more than one thread sends messages, or not each of them is a publication of an executor"
    if any(not published[each.name].waits for each in sent):
        return "not each reliable message is a publication that waits"
    if any(publication.timeout is None for publication in published.values() if publication.waits):
        return "a publication waits without a timeout"
    if any(parts(reply, system) > 1 for each in (*sent, *received) if (reply := answer_to(each, system)) is not None):
        return "a message is sent in several parts"
    return ""


def _data(wire: str, direction: Direction, system: System) -> list[Transmission]:
    wanted = wire, direction, Purpose.DATA
    return [each for each in system.network.transmissions if (each.wire, each.direction, each.purpose) == wanted]


def answer_to(message: Transmission, system: System) -> Transmission | None:
    """The message that acknowledges or answers another one; None if nothing does."""
    return next((each for each in system.network.transmissions if each.acknowledges == message.name), None)


def _has_threads(wire: Wire, system: System) -> bool:
    """Whether tasks of the middleware handle messages of a wire."""
    passed = {name for each in system.network.transmissions if each.wire == wire.name for name in each.processes}
    return any(isinstance(system.processes.get(name), Task) for name in passed)


def parts(acknowledgement: Transmission, system: System) -> int:
    """How many parts of a message are acknowledged one by one."""
    stimuli = set(system.processes[acknowledgement.name].stimuli)
    return max([1, *(sum(each in stimuli for each in triggered) for triggered in system.triggered)])
