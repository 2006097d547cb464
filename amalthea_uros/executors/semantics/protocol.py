"""What the client writes while it reads: acknowledgements and heartbeats.

It answers each part of a reliable message and each heartbeat as soon as it has read it, before the wait goes on or ends
(`read_stream`, `read_submessage_heartbeat`), and while something that it has sent is not acknowledged, it writes heartbeats of its own
(`listen_message_reliably`; all in src/c/core/session/session.c of eProsima/Micro-XRCE-DDS-Client). It writes these as any other
message: until the last byte is on the wire at most.

How much longer a wait of an iteration becomes:

- If data are unread when it begins, it reads what lies before them, and the first of them (`uxr_run_session_until_data`): at most all
  heartbeats that are unread then, and the parts of one message.
- If not, it answers the heartbeats that are unread, and ends at its timeout, which includes all that it writes meanwhile, besides the
  answer to what it read last.

So it answers those unread, one more heartbeat, and one message.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from amalthea_uros.executors.semantics.loops import longest_wait
from amalthea_uros.executors.semantics.readiness import messages
from amalthea_uros.executors.semantics.suspension import NONE, Suspension, in_sequence, suspension_of
from amalthea_uros.perf.activities import Trigger, walk
from amalthea_uros.perf.executors import Executor
from amalthea_uros.perf.network import Direction, Purpose, Span, Transmission
from amalthea_uros.perf.system import System
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True, kw_only=True)
class ProtocolWrites:
    """How often a wait writes messages that acknowledge no data.

    Attributes
    ----------
    acknowledgements : of heartbeats of the agent; None if that is not known
    heartbeats : of the client; None if that is not known
    """

    acknowledgements: int | None = 1
    heartbeats: int | None = 0


def acknowledgements(system: System) -> tuple[Transmission, ...]:
    """The acknowledgements that the client sends."""
    return _sent(system, Purpose.ACKNOWLEDGEMENT)


def heartbeats(system: System) -> tuple[Transmission, ...]:
    """The heartbeats that the client sends."""
    return _sent(system, Purpose.HEARTBEAT)


def _sent(system: System, purpose: Purpose) -> tuple[Transmission, ...]:
    return tuple(
        each for each in system.transmissions.values() if each.purpose is purpose and each.direction is Direction.TO_AGENT
    )


def writing_in_wait(executor: Executor, system: System, sending: Mapping[str, Span], writes: ProtocolWrites) -> Suspension:
    """How long a wait is extended by what it writes.

    Parameters
    ----------
    sending : times from the call of write to its return, by the names of transmissions; unknown if it is absent
    """
    if not messages(executor):
        return NONE
    sent = acknowledgements(system)
    of_messages = [_of(each, parts(each, system), sending) for each in sent if each.callback is not None]
    of_heartbeats = [_of(each, writes.acknowledgements, sending) for each in sent if each.callback is None]
    own = [_of(each, writes.heartbeats, sending) for each in heartbeats(system)]
    if of_messages and executor.waiting.messages_per_wait != 1:
        return Suspension(most=None, why="a wait acknowledges an unknown number of messages")
    return in_sequence([*of_heartbeats, *own, *_longest(of_messages)])


def parts(acknowledgement: Transmission, system: System) -> int:
    """How many parts of a message are acknowledged one by one."""
    stimuli = set(system.processes[acknowledgement.name].stimuli)
    counts = (
        sum(isinstance(each, Trigger) and each.stimulus in stimuli for each in walk(runnable.activities))
        for runnable in system.software.runnables
    )
    return max(1, *counts)


def _of(message: Transmission, times: int | None, sending: Mapping[str, Span]) -> Suspension:
    if not times and times is not None:
        return NONE
    most = sending.get(message.name, Span()).most
    if most is None:
        return Suspension(most=None, times=times or 1, why=f"the time to write {message.name!r} has no bound")
    if times is None:
        return Suspension(most=None, times=1, why=f"the number of times that a wait writes {message.name!r} has no bound")
    return Suspension(most=times * most, times=times, why="it acknowledges reliable messages and heartbeats as it reads them")


def _longest(suspensions: list[Suspension]) -> list[Suspension]:
    """That of the message that takes longest, as a wait reads one; the first one that has no bound."""
    unbounded = [each for each in suspensions if each.most is None]
    return unbounded[:1] or sorted(suspensions, key=lambda each: (each.most or 0, each.times))[-1:]


def session_wait(executor: Executor, system: System, sending: Mapping[str, Span], writes: ProtocolWrites) -> Time | None:
    """How long the other executors of its session can keep it from an executor that asks for it; None if that is not known."""
    total: Time = 0
    for other in system.executors:
        if executor.session is None or other.session != executor.session or other.name == executor.name:
            continue
        reading = writing_in_wait(other, system, sending, writes).most
        publishing = [suspension_of(handle, system, sending, 0).most for handle in other.handles]
        if reading is None or None in publishing:
            return None
        total += max(longest_wait(other) + reading, *filter(None, publishing), 0)
    return total
