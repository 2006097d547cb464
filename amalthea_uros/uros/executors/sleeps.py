"""How long a thread sleeps, on an operating system that counts in ticks."""

from __future__ import annotations

from typing import NamedTuple

from amalthea_uros.spec.description import Description
from amalthea_uros.spec.os import OsSection, SleepTicks
from amalthea_uros.units import Time, time_text
from amalthea_uros.uros.application.notes import Notes

#: Of an operating system whose tick is known, and nothing else: a sleep can end a tick before or after.
_INEXACT = SleepTicks.model_construct(early=1, late=1)


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


def check_sleeps(description: Description, notes: Notes) -> None:
    """Report sleeps that are no whole number of ticks, and so last longer or shorter than they say."""
    os = description.os
    for executor in description.middleware.stated_executors:
        loop = executor.loop
        sleeps = [] if loop is None else [(loop.sleep, loop), *((item.sleep or 0, item) for item in loop.items or ())]
        for sleep, section in sleeps:
            if os.tick is None or sleep % os.tick == 0:
                continue
            least, most, _ = slept(sleep, os)
            message = (
                f"{executor.name!r} sleeps {time_text(least)} to {time_text(most)} instead of {time_text(sleep)}: "
                f"{os.title} counts in ticks of {time_text(os.tick)}"
            )
            advice = (
                "Sleep for a whole number of ticks, or shorten the tick of the operating system, and set 'tick' under 'os'."
            )
            notes.warning("UR161", message, section.location("sleep"), advice)
