"""What can be lost: periods of timers, triggers of guard conditions, and messages for which there is no room.

Each loss comes with a sequence that leads to it. If the response time of a message is at most R, at most eta+(R) messages of its handle
wait at the same time, stored or not. If they do not exceed the depth, and those of all handles not the slots, no message is lost in the
middleware. What waits before it, in buffers of the driver and of the agent, is assumed to have room.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from amalthea_uros._internal.plural import counted
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.bounds.cycle import Cycle
from amalthea_uros.executors.results import HandleResult, Loss
from amalthea_uros.executors.semantics.loops import lost_periods, next_expiration
from amalthea_uros.executors.semantics.readiness import (
    LIFESPAN,
    arrivals,
    can_defer,
    can_exceed_depth,
    is_message,
    messages,
    sharing,
    slots_needed,
    takes_one_message,
)
from amalthea_uros.perf.executors import Executor, Handle
from amalthea_uros.perf.network import Span
from amalthea_uros.perf.system import System
from amalthea_uros.units import Rounding, Time, rounded_time_text, time_text


def loss_of_timer(handle: Handle, cycle: Cycle, lateness: Span) -> Loss | None:
    """The periods of a timer that can be lost: those that pass before the call for an earlier one begins."""
    period = handle.interval
    if not period:
        return None
    if lateness.most is None:
        return Loss(what="periods", is_certain=False, most=None, sequence=f"the lateness of {handle.name} has no bound")
    if lateness.most < period:
        return None
    count = lost_periods(lateness.most, period)
    following = next_expiration(0, lateness.most, period)
    multiples = ", ".join([*(time_text(number * period) for number in range(1, min(count, 3) + 1)), *["..."] * (count > 3)])
    sequence = (
        f"{handle.name} is due at 0 s, just after an iteration has checked its timers; the rest of the iteration"
        f"{f' and the sleep of {time_text(cycle.sleep)}' if cycle.sleep else ''}"
        f"{' and the other executors of the loop with their waits' if cycle.others else ''}, "
        "then the next iteration up to the callback, end at "
        f"{_text(lateness.most)}; what was due until then at {multiples} is lost, "
        f"the next call is due at {time_text(following)}"
    )
    return Loss(what="periods", is_certain=cycle.least_average > period, most=count, sequence=sequence)


def loss_of_triggers(
    handle: Handle, cycle: Cycle, seen_after: Time | None, extra_jitter: Mapping[str, Time | None]
) -> Loss | None:
    """The triggers of a guard condition that can be lost: it is a flag that is cleared when it is seen."""
    if can_defer(cycle.executor):
        sequence = f"{handle.name} is triggered; the next iteration sees and clears it, but the trigger condition is false"
        return Loss(what="triggers", is_certain=False, most=None, sequence=sequence)
    lost: int | None = None
    if seen_after is None:
        sequence = f"{handle.name} is triggered twice before the executor sees it, which has no bound; it calls it once"
    else:
        try:
            events = arrivals(handle, extra_jitter)
        except UnknownError:
            sequence = (
                f"{handle.name} is triggered twice within {_text(seen_after)}, until the executor sees it, and it calls it once; "
                "its rate is not specified"
            )
        else:
            # The first one sets the flag; the others come until it is seen, at the last moment, too.
            lost = events.eta_plus(seen_after + 1) - 1
            if not lost:
                return None
            sequence = (
                f"{handle.name} is triggered at 0 s and {time_text(events.delta_min(2))}; the executor sees it only after "
                f"{_text(seen_after)}, and calls it once"
            )
    return Loss(what="triggers", is_certain=False, most=lost, is_replaced=True, sequence=sequence)


def with_lost_messages(
    results: Sequence[HandleResult], cycle: Cycle, stored: Mapping[str, int | None], needed: int | None
) -> list[HandleResult]:
    """The results with the messages that can be lost because there is no room for them.

    Parameters
    ----------
    stored : the messages of each handle that can wait at the same time
    needed : the slots for those of all executors that share them
    """
    executor, system = cycle.executor, cycle.solved.context.system
    sharing_slots = sharing(executor, system.executors)
    if executor.waiting.slots != 0 and all(takes_one_message(each, system) for each in sharing_slots):
        return list(results)
    return [
        replace(result, lost=_lost(handle, result, cycle, stored[handle.name], needed)) if is_message(handle) else result
        for handle, result in zip(executor.handles, results, strict=True)
    ]


def stored_messages(
    results: Mapping[Executor, Sequence[HandleResult]], extra_jitter: Mapping[str, Time | None]
) -> dict[str, int | None]:
    """How many messages of each handle can wait at the same time; None if that is not known."""
    return {
        handle.name: _stored(handle, result, extra_jitter)
        for executor, found in results.items()
        for handle, result in zip(executor.handles, found, strict=True)
        if is_message(handle)
    }


def slots_of_pool(executors: Sequence[Executor], system: System, stored: Mapping[str, int | None]) -> int | None:
    """The slots that executors need that share them; None if a number of messages is not known, and nothing limits it."""
    handles = [handle for each in executors for handle in messages(each)]
    if all(takes_one_message(each, system) for each in executors):
        return min(len(handles), 1)
    return slots_needed(handles, stored)


def _stored(handle: Handle, result: HandleResult, extra_jitter: Mapping[str, Time | None]) -> int | None:
    """How many messages of a handle can wait at the same time; None if that is not known."""
    if result.response.worst is None:
        return None
    try:
        return arrivals(handle, extra_jitter).eta_plus(result.response.worst)
    except UnknownError:
        return None


def _lost(handle: Handle, result: HandleResult, cycle: Cycle, stored: int | None, needed: int | None) -> Loss | None:
    """How messages of a handle can be lost, of which and for all of which so many wait at the same time."""
    executor, slots = cycle.executor, cycle.executor.waiting.slots
    is_pool_enough = slots is None or (needed is not None and needed <= slots)
    if is_pool_enough and handle.depth is not None and (stored is None or can_exceed_depth(handle, stored)):
        count = f"{stored} messages" if stored is not None else "an unknown number of messages"
        what = "overwrites the oldest one" if handle.overwrites else "is dropped"
        limit = f"it keeps {handle.depth}, and a further one {what}"
        sequence = f"{_while_nothing_is_taken(cycle)}{count} for {handle.name} can wait; {limit}"
        return Loss(
            what="messages",
            is_certain=False,
            most=None if stored is None else stored - handle.depth,
            sequence=sequence,
            is_replaced=handle.overwrites and not handle.reliable,
        )
    if result.response.worst is not None and result.response.worst > LIFESPAN:
        wait = _text(result.response.worst)
        sequence = f"a message for {handle.name} can wait for {wait}; stored for {time_text(LIFESPAN)}, it is removed"
        return Loss(what="messages", is_certain=False, most=None, sequence=sequence)
    if slots is None or is_pool_enough:
        return None
    waiting = "messages" if needed is None else f"up to {counted(needed, 'message')}"
    sequence = (
        f"{_while_nothing_is_taken(cycle)}{waiting} for all handles of {executor.name} together use its {counted(slots, 'slot')}; "
        f"a new one for {handle.name} is dropped then"
    )
    return Loss(what="messages", is_certain=False, most=None, sequence=sequence, is_of_pool=True)


def _while_nothing_is_taken(cycle: Cycle) -> str:
    """What happens while messages are stored and none is taken."""
    if can_defer(cycle.executor):
        return "while the trigger condition is false, "
    if cycle.whole.suspension.why and cycle.whole.suspension.most is not None:
        return f"while {cycle.whole.suspension.why}, "
    return "while an iteration executes, "


def _text(value: Time) -> str:
    return rounded_time_text(value, Rounding.UP)
