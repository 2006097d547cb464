"""What the client writes while it reads: acknowledgements and heartbeats.

It answers each part of a reliable message and each heartbeat as soon as it has read it, before the wait goes on or ends
(`read_stream`, `read_submessage_heartbeat`), and while something that it has sent is not acknowledged, it writes heartbeats of its own
(`listen_message_reliably`; all in src/c/core/session/session.c of eProsima/Micro-XRCE-DDS-Client). It writes these as any other
message: until the last byte is on the wire at most.

How much longer a wait of a round becomes:

- If data are unread when it begins, it reads what lies before them, and the first of them (`uxr_run_session_until_data`): at most all
  heartbeats that are unread then, and the parts of one message.
- If not, it answers the heartbeats that are unread, and ends at its timeout, which includes all that it writes meanwhile, besides the
  answer to what it read last.

So it answers those unread, one more heartbeat, and one message.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from amalthea_uros.perf.activities import Trigger, walk
from amalthea_uros.perf.executors import Executor
from amalthea_uros.perf.network import Direction, Purpose, Span, Transmission
from amalthea_uros.perf.system import System
from amalthea_uros.timing.executors.sending import Suspension, together
from amalthea_uros.timing.executors.wait import messages


@dataclass(frozen=True, slots=True, kw_only=True)
class Written:
    """How often a wait of a round writes what is no answer to data.

    Attributes
    ----------
    answers : to heartbeats of the agent; None if that is not known
    heartbeats : of the client; None if that is not known
    """

    answers: int | None = 1
    heartbeats: int | None = 0


def answers(system: System) -> tuple[Transmission, ...]:
    """The acknowledgements that the client sends."""
    return _sent(system, Purpose.ACKNOWLEDGEMENT)


def heartbeats(system: System) -> tuple[Transmission, ...]:
    """The heartbeats that the client sends."""
    return _sent(system, Purpose.HEARTBEAT)


def answering(executor: Executor, system: System, sending: Mapping[str, Span], written: Written) -> Suspension:
    """How long a wait is longer because of what it writes.

    Parameters
    ----------
    sending : times from the call of write to its return, by the names of transmissions; unknown if it is absent
    """
    if not messages(executor):
        return Suspension()
    found = answers(system)
    of_messages = [_of(each, parts(each, system), sending) for each in found if each.callback is not None]
    of_heartbeats = [_of(each, written.answers, sending) for each in found if each.callback is None]
    own = [_of(each, written.heartbeats, sending) for each in heartbeats(system)]
    if of_messages and executor.waiting.messages_per_wait != 1:
        return Suspension(most=None, why="a wait acknowledges an unknown number of messages")
    return together([*of_heartbeats, *own, *_longest(of_messages)])


def parts(answer: Transmission, system: System) -> int:
    """How many parts of a message are acknowledged one by one."""
    stimuli = set(system.processes[answer.name].stimuli)
    counts = (
        sum(isinstance(each, Trigger) and each.stimulus in stimuli for each in walk(runnable.activities))
        for runnable in system.software.runnables
    )
    return max(1, *counts)


def _sent(system: System, purpose: Purpose) -> tuple[Transmission, ...]:
    return tuple(
        each for each in system.transmissions.values() if each.purpose is purpose and each.direction is Direction.TO_AGENT
    )


def _of(message: Transmission, times: int | None, sending: Mapping[str, Span]) -> Suspension:
    if not times and times is not None:
        return Suspension()
    most = sending.get(message.name, Span()).most
    if most is None:
        return Suspension(most=None, times=times or 1, why=f"how long {message.name!r} takes to be written has no bound")
    if times is None:
        return Suspension(most=None, times=1, why=f"how often {message.name!r} is written in a wait has no bound")
    return Suspension(most=times * most, times=times, why="it acknowledges reliable messages and heartbeats as it reads them")


def _longest(found: list[Suspension]) -> list[Suspension]:
    """That of the message that takes longest, as a wait reads one; the first one that has no bound."""
    unknown = [each for each in found if each.most is None]
    return unknown[:1] or sorted(found, key=lambda each: (each.most or 0, each.times))[-1:]
