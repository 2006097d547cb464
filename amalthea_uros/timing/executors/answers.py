"""Acknowledgements that the client writes while it reads.

It answers each part of a reliable message and each heartbeat as soon as it has read it, before the wait goes on or ends
(eProsima/Micro-XRCE-DDS-Client, `session.c`), and writes as any other message: until its last byte is on the wire at most. A wait reads
the parts of one message, and the heartbeats that have come: those of a cycle, and one that was waiting behind a message.
"""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros.perf.activities import Trigger, walk
from amalthea_uros.perf.executors import Executor
from amalthea_uros.perf.network import Direction, Purpose, Span, Transmission
from amalthea_uros.perf.system import System
from amalthea_uros.timing.executors.sending import Suspension, together
from amalthea_uros.timing.executors.wait import messages

#: Heartbeats that one wait answers.
HEARTBEATS = 2


def answers(system: System) -> tuple[Transmission, ...]:
    """The acknowledgements that the client sends."""
    return tuple(
        each
        for each in system.transmissions.values()
        if each.purpose is Purpose.ACKNOWLEDGEMENT and each.direction is Direction.TO_AGENT
    )


def answering(executor: Executor, system: System, sending: Mapping[str, Span]) -> Suspension:
    """How long a wait is longer because it acknowledges what it reads.

    Parameters
    ----------
    sending : times from the call of write to its return, by the names of transmissions; unknown if it is absent
    """
    if not messages(executor):
        return Suspension()
    found = answers(system)
    of_messages = [_of(each, _parts(each, system), sending) for each in found if each.callback is not None]
    of_heartbeats = [_of(each, HEARTBEATS, sending) for each in found if each.callback is None]
    if of_messages and executor.waiting.messages_per_wait != 1:
        return Suspension(most=None, why="a wait acknowledges an unknown number of messages")
    return together([*of_heartbeats, *_longest(of_messages)])


def _of(answer: Transmission, times: int, sending: Mapping[str, Span]) -> Suspension:
    most = sending.get(answer.name, Span()).most
    if most is None:
        return Suspension(most=None, times=times, why=f"how long {answer.name!r} takes to be written has no bound")
    return Suspension(most=times * most, times=times, why="it acknowledges reliable messages and heartbeats as it reads them")


def _parts(answer: Transmission, system: System) -> int:
    """How many parts of a message are acknowledged one by one."""
    stimuli = set(system.processes[answer.name].stimuli)
    counts = (
        sum(isinstance(each, Trigger) and each.stimulus in stimuli for each in walk(runnable.activities))
        for runnable in system.software.runnables
    )
    return max(1, *counts)


def _longest(found: list[Suspension]) -> list[Suspension]:
    """That of the message that takes longest, as a wait reads one; the first one that has no bound."""
    unknown = [each for each in found if each.most is None]
    return unknown[:1] or sorted(found, key=lambda each: (each.most or 0, each.times))[-1:]
