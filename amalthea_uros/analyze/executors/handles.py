"""The response times of the callbacks of an executor, by the kind of handle.

Let L be the longest cycle without a wait, W the longest wait, and E the time from when it is fixed what is ready to the end of a
callback.

- A timer: once it is due, waits end at once. In the worst case what is ready was fixed just before, so that it is called after one
  cycle: L + E. That a wait can end up to 1 ms before the timer is due, without a call, is no longer than that.
- A guard condition: a trigger does not end the wait, so that it is seen after one cycle and the wait: L + W + E.
- A message: after n cycles, see `queue`: n L + E, or n (L + W) + E if messages can be stored before the round that takes them.
"""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros.analyze.executors.cycle import Cycle
from amalthea_uros.analyze.executors.losses import loss_of_timer, loss_of_triggers
from amalthea_uros.analyze.executors.queue import Delay, certain_overload, delay_of
from amalthea_uros.analyze.executors.results import HandleResult
from amalthea_uros.analyze.executors.terms import terms_of
from amalthea_uros.analyze.executors.window import METHOD
from amalthea_uros.analyze.results import Claim, Response
from amalthea_uros.perf.executors import Handle, HandleKind
from amalthea_uros.perf.network import Span
from amalthea_uros.timing.executors.readiness import starts_alone
from amalthea_uros.timing.executors.wait import is_message
from amalthea_uros.units import Time

SOURCE = "ros2/rclc executor.c; micro-ROS/rmw_microxrcedds rmw_wait.c"
STORED = "a wait does not end for a message that is stored already"
NOT_WOKEN = "a guard condition does not end the wait"


def handle_result(handle: Handle, cycle: Cycle, extra_jitter: Mapping[str, Time | None]) -> HandleResult:
    """The response time of a handle, and the lateness of a timer; losses of messages are found for all handles together."""
    wait, waited_for = _wait(handle, cycle)
    delay = _delay(handle, cycle, wait, extra_jitter)
    start, end = cycle.until_start(handle), cycle.until_end(handle)
    worst = None
    if delay.cycles is not None and cycle.longest is not None and end is not None:
        worst = delay.cycles * (cycle.longest + wait) - delay.earlier + end
    lateness = None
    if handle.kind is HandleKind.TIMER:
        is_bounded = delay.cycles is not None and cycle.longest is not None and start is not None
        lateness = Span(most=(cycle.longest or 0) + (start or 0) if is_bounded else None)
    lost = None
    if lateness is not None:
        lost = loss_of_timer(handle, cycle, lateness)
    elif handle.kind is HandleKind.GUARD_CONDITION:
        lost = loss_of_triggers(handle, cycle, None if cycle.longest is None else cycle.longest + wait)
    return HandleResult(
        name=handle.name,
        kind=handle.kind,
        runnable=handle.runnable,
        interval=handle.interval,
        response=Response(
            worst=worst,
            best=cycle.costs.of(handle).best // cycle.time_base + cycle.suspension(handle).least,
            method=METHOD,
            source=SOURCE,
            claim=Claim.BOUND,
            reason="" if worst is not None else delay.reason or _unbounded(handle, cycle),
            is_overload=delay.is_overload,
        ),
        lateness=lateness,
        lost=lost,
        terms=()
        if worst is None or delay.cycles is None
        else terms_of(
            handle,
            cycle,
            delay=delay,
            wait=wait,
            waited_for=waited_for,
            worst=worst,
        ),
    )


def _unbounded(handle: Handle, cycle: Cycle) -> str:
    """Why a response time is not bounded, although it is known after how many cycles the handle is served."""
    own = cycle.suspension(handle)
    return own.why if own.most is None and own.why else cycle.unbounded


def _wait(handle: Handle, cycle: Cycle) -> tuple[Time, str]:
    """How long each cycle before that which serves a handle can wait nevertheless, and why."""
    waiting = cycle.executor.waiting
    if handle.kind is HandleKind.GUARD_CONDITION:
        return (0, "") if waiting.guard_conditions_end_wait else (cycle.wait, NOT_WOKEN)
    can_be_stored = cycle.stores or waiting.messages_per_wait != 1
    if is_message(handle) and can_be_stored and not waiting.stored_data_ends_wait:
        return cycle.wait, STORED
    return 0, ""


def _delay(handle: Handle, cycle: Cycle, wait: Time, extra_jitter: Mapping[str, Time | None]) -> Delay:
    if not starts_alone(handle, cycle.executor):
        kind = cycle.executor.trigger.kind
        return Delay(cycles=None, reason=f"the trigger condition {kind.value!r} keeps it back until others are ready, too")
    if not is_message(handle):
        return Delay(cycles=1)
    if cycle.longest is None:
        return certain_overload(cycle) or Delay(cycles=None, reason=_unbounded(handle, cycle))
    return delay_of(handle, cycle, cycle.longest + wait, extra_jitter)
