"""Calls that let a thread sleep: by the operating system and the port they sleep, wait busily, or return at once."""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from amalthea_uros._internal.records import replace
from amalthea_uros.source.facts import CodeFacts
from amalthea_uros.source.ports import MICROSECOND, MILLISECOND, SECOND
from amalthea_uros.source.scope import Expression
from amalthea_uros.source.syntax import called
from amalthea_uros.source.walk import BUSY_LOOP, FunctionCall
from amalthea_uros.units import Time, time_text

#: Functions that wait without sleeping: `HAL_Delay` of the HAL of STM32 reads its tick until it is over.
_BUSY_MILLISECONDS = ("HAL_Delay",)
#: The unit of Renesas' delay is its second argument: renesas/fsp bsp_delay.h.
_RENESAS = "R_BSP_SoftwareDelay"
_RENESAS_UNITS = {
    "BSP_DELAY_UNITS_SECONDS": SECOND,
    "BSP_DELAY_UNITS_MILLISECONDS": MILLISECOND,
    "BSP_DELAY_UNITS_MICROSECONDS": MICROSECOND,
}
_BUSY_MICROSECONDS = ("delayMicroseconds", "esp_rom_delay_us", "ets_delay_us", "busy_wait_us", "k_busy_wait")
#: Function -> unit of its only argument.
_UNITS = {
    **dict.fromkeys(("usleep", "sleep_us", "k_usleep", *_BUSY_MICROSECONDS), MICROSECOND),
    **dict.fromkeys(("delay", "sleep_ms", "k_msleep", "rclc_sleep_ms", *_BUSY_MILLISECONDS), MILLISECOND),
    "sleep": SECOND,
}
#: Those whose argument is a number of ticks, or is made of a time by a macro.
_TICKS = ("vTaskDelay", "osDelay", "tx_thread_sleep")
#: Functions that wait for others -> the position of their timeout.
_BLOCKING = {
    **dict.fromkeys(("xQueueReceive", "xQueuePeek", "k_msgq_get", "k_poll", "osThreadFlagsWait", "tx_queue_receive"), 2),
    **dict.fromkeys(
        ("rcl_wait", "xSemaphoreTake", "ulTaskNotifyTake", "osSemaphoreAcquire", "k_sem_take", "tx_semaphore_get"), 1
    ),
    **dict.fromkeys(("xTaskNotifyWait", "osMessageQueueGet", "osEventFlagsWait", "xStreamBufferReceive"), 3),
    **dict.fromkeys(("xEventGroupWaitBits", "xMessageBufferReceive"), 4),
}
_NO_WAIT = ("K_NO_WAIT", "TX_NO_WAIT")
#: Those whose duration depends on when they are called.
_UNTIL = (
    "vTaskDelayUntil",
    "xTaskDelayUntil",
    "osDelayUntil",
    "k_sleep",
    "sleep_for",
    "this_thread::sleep_for",
    "nanosleep",
    "sleep_until",
)

SLEEPS = frozenset({*_UNITS, *_TICKS, *_UNTIL, *_BLOCKING, _RENESAS, BUSY_LOOP})

#: Macros and constructors of durations -> unit of their argument.
_DURATIONS = {
    **dict.fromkeys(("K_MSEC", "pdMS_TO_TICKS", "milliseconds", "K_TIMEOUT_MS"), MILLISECOND),
    **dict.fromkeys(("K_USEC", "microseconds"), MICROSECOND),
    **dict.fromkeys(("K_SECONDS", "seconds"), SECOND),
}
_RATE = "configTICK_RATE_HZ"
#: What milliseconds are divided by to make ticks of them.
_TICK_LENGTHS = ("portTICK_PERIOD_MS", "portTICK_RATE_MS")


def _sleep_time(call: FunctionCall, tick_rate: Fraction | None) -> Time | None:
    """How long a call sleeps, None if it is not constant.

    Parameters
    ----------
    tick_rate : ticks per second; None if unknown: then a number of ticks is not a time
    """
    given = call.argument(0)
    if given is None:
        return None
    if call.name == _RENESAS:
        number, unit = given.number, call.argument(1)
        factor = _RENESAS_UNITS.get(unit.name) if unit is not None else None
        return None if number is None or number < 0 or factor is None else Time(number * factor)
    if call.name in _UNITS:
        number = given.number
        return None if number is None or number < 0 else Time(number * _UNITS[call.name])
    if call.name in _TICKS:
        return _whole_ticks(given, tick_rate)
    return _duration(given)


def _duration(given: Expression) -> Time | None:
    """The time that a macro or constructor such as `K_MSEC(10)` makes."""
    own = given.resolved
    if own.node.type != "call_expression":
        return None
    name, arguments = called(own.node)
    unit = _DURATIONS.get(name.rpartition("::")[2])
    if unit is None or len(arguments) != 1:
        return None
    number = own.at(arguments[0]).number
    return None if number is None or number < 0 else Time(number * unit)


def _whole_ticks(given: Expression, tick_rate: Fraction | None) -> Time | None:
    """A delay in ticks; a time is cut to whole ticks, so a short one does not sleep at all."""
    wanted = _duration(given) or _divided(given) or _by_rate(given)
    if wanted is not None:
        if tick_rate is None:
            return wanted
        return Time(int((wanted * tick_rate) // SECOND * SECOND / tick_rate))
    ticks = given.number
    return None if ticks is None or ticks < 0 or tick_rate is None else Time(int(ticks * SECOND / tick_rate))


def _divided(given: Expression) -> Time | None:
    node = given.resolved.node
    left, right = node.child_by_field_name("left"), node.child_by_field_name("right")
    if node.type != "binary_expression" or left is None or right is None:
        return None
    if given.at(right).text not in _TICK_LENGTHS:
        return None
    number = given.at(left).number
    return None if number is None or number < 0 else Time(number * MILLISECOND)


def _by_rate(given: Expression) -> Time | None:
    """The time of a number of ticks that is made with their rate; whatever it is, the time is the number at 1000 Hz in milliseconds."""
    if _RATE not in given.text or given.program.macros.get(_RATE):
        return None
    number = replace(given, bindings={**given.bindings, _RATE: 1000}).number
    return None if number is None or number < 0 else Time(number * MILLISECOND)


class WaitCall(NamedTuple):
    """The wait of a call.

    Attributes
    ----------
    time : how long it waits; 0 if it returns at once, None if that is not constant
    is_busy : whether it executes meanwhile, so that nothing of lower priority does
    note : why it does not do what it seems to
    waits_for : what ends it, if that is not time
    """

    time: Time | None
    is_busy: bool = False
    note: str = ""
    waits_for: str = ""


def wait_of(call: FunctionCall, facts: CodeFacts) -> WaitCall:
    """The wait of a call that seems to let a thread sleep."""
    if call.name == BUSY_LOOP:
        return WaitCall(None, is_busy=True, waits_for="a loop that waits for a time")
    if call.name in _BLOCKING:
        timeout = call.argument(_BLOCKING[call.name])
        is_poll = timeout is not None and (timeout.name in _NO_WAIT or timeout.number == 0 or _duration(timeout) == 0)
        return WaitCall(Time(0)) if is_poll else WaitCall(None, waits_for=f"waits in {call.name}")
    rate = facts.tick_rate
    time = _sleep_time(call, rate if facts.ticks_are_stated else None)
    if call.name in (*_BUSY_MILLISECONDS, *_BUSY_MICROSECONDS, _RENESAS):
        return WaitCall(time, is_busy=True)
    if call.name == "delay" and not facts.rtos:
        # Arduino without an operating system; where one is not seen, a busy wait is what delays others longest.
        return WaitCall(time, is_busy=True)
    if call.name == "usleep" and time is not None:
        if facts.rtos == "zephyr" and time >= SECOND:
            # zephyr lib/posix/sleep.c
            return WaitCall(Time(0), note=f"usleep of Zephyr refuses {time_text(time)}: it takes less than 1 s")
        if facts.port == "espidf" and rate is not None and time * rate < SECOND:
            # espressif/esp-idf components/newlib/src/time.c
            return WaitCall(time, is_busy=True, note="usleep of ESP-IDF waits without sleeping for less than a tick")
    if call.name in _TICKS and rate is not None and time is not None:
        tick = time_text(Time(int(SECOND / rate)))
        if time == 0:
            return WaitCall(time, note=f"it is less than a tick of {tick}")
        if time * rate < SECOND:
            return WaitCall(None, note=f"it is less than a tick of {tick}, which is the default, and then no sleep")
    return WaitCall(time)
