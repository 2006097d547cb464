"""The programs of messages on wires, which can be lost, and sent again as a whole or in part."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.semantics.losses import can_be_sent_again
from amalthea_uros.perf.activities import Activity, Trigger
from amalthea_uros.perf.software import Process
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.kernel.message_records import MOST_PARTS
from amalthea_uros.simulate.program.image import JumpLabel

if TYPE_CHECKING:
    from amalthea_uros.simulate.program.body import Body


def add_start(body: Body, process: Process) -> None:
    """Append what chains do at the start of a job; a message that is sent again has their values."""
    messages = body.resources.executors.messages
    if process.name not in messages.sent_again:
        body.add_all(body.hooks.start)
        return
    restored = JumpLabel()
    body.code.add(layout.RESTORE_VALUES, messages.transmissions[process.name], restored)
    body.add_all(body.hooks.start)
    body.code.mark(restored)


def add_parts(body: Body, process: Process) -> None:
    """Append the parts of a message, of which some can be left out if it is sent again.

    Raises
    ------
    UnknownError : it is not known who sends it again, or it has too many parts.
    """
    messages = body.resources.executors.messages
    parts = list(_parts(process.activities, _acknowledging(process, body)))
    if process.name not in messages.sent_again:
        _check_recovery(process, body)
    elif len(parts) > MOST_PARTS:
        raise UnknownError(f"it has more than {MOST_PARTS} parts, which can be lost")
    elif len(parts) > 1:
        for number, activities in enumerate(parts):
            left_out = JumpLabel()
            body.code.add(layout.TEST_PART, number, left_out)
            body.activities(activities)
            body.code.mark(left_out)
        return
    body.activities(process.activities)


def _acknowledging(process: Process, body: Body) -> frozenset[str]:
    """The stimuli with which the agent acknowledges parts."""
    messages = body.resources.executors.messages
    return frozenset(name for name, each in messages.sent.items() if each.name in messages.acknowledging_lines)


def _parts(activities: Sequence[Activity], acknowledging: frozenset[str]) -> Iterator[Sequence[Activity]]:
    """The activities of each part: each ends when it is acknowledged."""
    begin = 0
    for index, activity in enumerate(activities, 1):
        if isinstance(activity, Trigger) and activity.stimulus in acknowledging:
            yield activities[begin:index]
            begin = index
    if begin < len(activities):
        yield activities[begin:]


def _check_recovery(process: Process, body: Body) -> None:
    """Refuse a reliable message that can be lost, and of which nobody who is simulated cares for its repetition."""
    system = body.context.system
    transmission = system.transmissions[process.name]
    has_losses = any(wire.losses for wire in system.network.wires if wire.name == transmission.wire)
    if has_losses and can_be_sent_again(transmission, system):
        raise UnknownError("it can be lost, and no executor with a loop that is simulated sends or receives it again")


def add_end(body: Body, process: Process) -> None:
    """Append what is done at the end of a job: nothing for chains if the message is lost."""
    messages, lost = body.resources.executors.messages, JumpLabel()
    record = messages.transmissions.get(process.name, 0)
    can_lose = record and body.resources.image.words[record + layout.LOSES]
    if can_lose and body.part < 0:
        body.code.add(layout.ARRIVE, record)
    if process.name in messages.sent_again:
        body.code.add(layout.KEEP_VALUES, record)
    if can_lose:
        body.code.add(layout.TEST_ARRIVED, 0, lost)
    body.add_all(messages.first_operations_of_end(process.name))
    body.add_all(body.hooks.end)
    body.code.mark(lost)
    body.add_all(messages.last_operations(process.name))
