"""What the operating system means for tasks: how long they sleep, and which of their priorities is the more urgent one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

from amalthea_uros.spec.description import Description
from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.spec.os import OsSection, SleepTicks
from amalthea_uros.units import Time, time_text
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.assembly.tasks import PlannedTask

#: Of an operating system whose tick is known, and nothing else: a sleep can end a tick before or after.
_INEXACT = SleepTicks(early=1, late=1)


class Sleep(NamedTuple):
    """How long a thread sleeps when it asks for some time.

    Attributes
    ----------
    pace : minimum time between the ends of two sleeps that follow each other
    """

    least: Time
    most: Time
    pace: Time


def slept(sleep: Time, os: OsSection) -> Sleep:
    """How long a thread sleeps when it asks for some time.

    Ticks come independently of when the thread starts to sleep. So `vTaskDelay(1)` of FreeRTOS, which ends at the next tick, sleeps
    for 0 to 1 ticks; sleeps that must not be too short, as in Zephyr, wait for one tick more. As sleeps end at ticks, and the next
    one is counted from the tick at which it begins or from a later one, the ends of two sleeps are whole ticks apart: at least 1 for
    `vTaskDelay(1)`, although the sleep between them can take no time.
    """
    if not sleep or os.tick is None:
        return Sleep(sleep, sleep, sleep)
    rule = os.sleep_ticks or _INEXACT
    ticks = -(-sleep // os.tick)
    least, pace = max(0, ticks - rule.early), max(0, ticks - max(0, rule.early - 1))
    return Sleep(least * os.tick, (ticks + rule.late) * os.tick, pace * os.tick)


@dataclass(frozen=True, slots=True)
class PriorityScale:
    """Converts the numbers of priorities in a description to those of a system, where a higher number is more urgent.

    Attributes
    ----------
    zero : the number that becomes 0, where lower numbers are more urgent; None if higher ones are
    """

    zero: int | None = None

    def rank(self, number: int) -> int:
        """A priority of the description as one of the system."""
        return number if self.zero is None else self.zero - number

    def number(self, rank: int) -> int:
        """A priority of the system as one of the description; the conversion is its own inverse."""
        return self.rank(rank)


#: What priorities mean if nothing else is stated.
HIGHER_IS_MORE_URGENT = PriorityScale()


def priority_scale(os: OsSection, tasks: Iterable[PlannedTask]) -> PriorityScale:
    """The scale of priorities: from the highest number of the operating system, or one that leaves room for all tasks."""
    if os.priorities != "lower-is-more-urgent":
        return HIGHER_IS_MORE_URGENT
    if os.priority_range is not None:
        return PriorityScale(os.priority_range.highest)
    planned = list(tasks)
    return PriorityScale(max((task.priority for task in planned if task.priority is not None), default=0) + len(planned))


def check_priority(task: PlannedTask, number: int, os: OsSection, notes: Notes) -> None:
    """Report a priority that the operating system does not have."""
    allowed = os.priority_range
    if allowed is None or allowed.lowest <= number <= allowed.highest:
        return
    limits = f"outside {allowed.lowest} to {allowed.highest}, the range of {_system(os)}"
    if task.priority is None:
        message = f"{task.name!r} gets priority {number}, which is {limits}"
        advice = "Set the priorities of the tasks, and give the same one to tasks that may wait for each other."
    else:
        message = f"the priority {number} of {task.name!r} is {limits}"
        advice = f"Set a priority from {allowed.lowest} to {allowed.highest}, or 'priority_range' under 'os'."
    notes.warning("UR160", message, task.origin, advice)


def check_sleeps(description: Description, notes: Notes) -> None:
    """Report sleeps that are no whole number of ticks, and so last longer or shorter than they say."""
    os = description.os
    for executor in _executors(description):
        if executor.loop is None or os.tick is None or executor.loop.sleep % os.tick == 0:
            continue
        least, most, _ = slept(executor.loop.sleep, os)
        message = (
            f"{executor.name!r} sleeps {time_text(least)} to {time_text(most)} instead of {time_text(executor.loop.sleep)}: "
            f"{_system(os)} counts in ticks of {time_text(os.tick)}"
        )
        advice = "Sleep for a whole number of ticks, or shorten the tick of the operating system, and set 'tick' under 'os'."
        notes.warning("UR161", message, executor.loop.location("sleep"), advice)


def _executors(description: Description) -> Iterator[ExecutorSection]:
    middleware = description.middleware
    yield from middleware.executors or [middleware.executor]


def _system(os: OsSection) -> str:
    return "the operating system" if os.rtos is None else repr(os.rtos)
