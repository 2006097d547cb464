"""What a thread does between two waits of its loop, how long it waits, and how close together its iterations can be.

Between two waits (ros2/rclc, rclc/src/rclc/executor.c):

- `spin_some` and a sleep: the sleep follows every iteration.
- `spin`: the next wait follows at once.
- `spin_period`: it sleeps until its invocation time plus the period, cut to whole milliseconds, and then the invocation time advances
  by the period. After an overrun it does not sleep until it has caught up (`rclc_executor_spin_one_period`). Its wait uses the timeout
  of the executor, not the period.

The wait:

- `rcl_wait` shortens the timeout to the time until the next timer is due (ros2/rcl, rcl/src/rcl/wait.c).
- `rmw_wait` cuts it to whole milliseconds, so that it can end up to 1 ms before the timer is due, and that of less than 1 ms looks once
  whether there is a message (micro-ROS/rmw_microxrcedds, src/rmw_wait.c).
- It ends with the first message that arrives during the wait, or that waits in the buffer of the transport. A message that is stored
  already, because it came while a publication waited for its acknowledgement, does not end it.
- Without anything that receives messages it does not wait at all (rmw_microxrcedds#297).

A timer is due at its first expiration and whole periods later. Whether it is due is checked once in an iteration, after the wait. A
call sets the next expiration one period on, and if that has passed, to the next one on the grid (ros2/rcl, rcl/src/rcl/timer.c,
`rcl_timer_call`): there is no burst of calls afterwards.
"""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.executors.semantics.losses import reliable_messages, why_unbounded
from amalthea_uros.executors.semantics.readiness import (
    can_defer,
    is_message,
    messages,
    only_sends,
    shares_session,
    starts_alone,
    thread_of,
    timers,
)
from amalthea_uros.perf.executors import Executor, Handle, HandleKind, LoopKind
from amalthea_uros.perf.network import Direction
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.event_models.models import EventModel, SporadicEvents
from amalthea_uros.units import MILLISECOND, Interval, Time

#: `rclc_sleep_ms` sleeps whole milliseconds.
SLEEP_RESOLUTION = MILLISECOND


def sleep_of(executor: Executor) -> Interval[Time]:
    """The sleep between two iterations, without that of a loop with a period."""
    longest = executor.loop.sleep if executor.loop.kind is LoopKind.SLEEPING else 0
    return Interval(longest - executor.loop.sleep_early, longest)


def min_pace(executor: Executor) -> Time:
    """The time per iteration that a loop with sleeps takes at least in the long run; 0 for a loop without sleeps."""
    return max(sleep_of(executor).lower, executor.loop.pace)


def is_paced(executor: Executor) -> bool:
    """Whether iterations keep a distance from each other by themselves, by a sleep or a period that the wait cannot exceed."""
    loop = executor.loop
    return loop.sleep > 0 or (loop.period is not None and timeout_of(executor) <= loop.period)


def returns_at_once(executor: Executor) -> bool:
    """Whether the wait of an executor always returns at once, because nothing of it receives messages."""
    return not messages(executor) and (executor.waiting.polls_without_messages or only_sends(executor))


def cut(timeout: Time, executor: Executor) -> Time:
    """A timeout in whole units of the resolution of the middleware."""
    resolution = executor.waiting.resolution
    return timeout - timeout % resolution if resolution else timeout


def timeout_of(executor: Executor) -> Time:
    """The timeout of a wait when no timer is pending."""
    return 0 if returns_at_once(executor) else cut(executor.loop.timeout, executor)


def longest_wait(executor: Executor) -> Time:
    """The longest wait: a timer is due again after its period at most, because calls keep its grid."""
    pending = (until for handle in timers(executor) if (until := longest_until_due(handle)) is not None)
    return min([timeout_of(executor), *(cut(until, executor) for until in pending)])


def longest_until_due(handle: Handle) -> Time | None:
    """The longest time until a timer is due, or a message is sent: its period, or that until the first time; None if unknown."""
    return None if handle.interval is None else max(handle.interval, handle.phase or 0)


def busy_polls(executor: Executor) -> str:
    """Why the thread of an executor can occupy its core without end, although nothing is to be done; "" if it cannot."""
    if min_pace(executor) or executor.loop.kind is LoopKind.PERIODIC:
        return ""
    reason = waits_return_at_once(executor)
    return reason and f"its loop has no sleep, and {reason}"


def timing_context(system: System, settings: Settings | None = None, alike: TimingContext | None = None) -> TimingContext:
    """The timing context of a system; the execution demand is unknown of executors that busy-poll, and of what is sent again.

    Parameters
    ----------
    alike : as `TimingContext.of`
    """
    return TimingContext.of(system, settings, unknown_demands=busy_threads(system) | _sent_again(system), alike=alike)


def busy_threads(system: System) -> dict[str, str]:
    """The tasks of executors whose threads can use all time that is left to them, each with the reason."""
    return {executor.task: reason for executor in system.executors if (reason := _busy_thread(executor, system))}


def _busy_thread(executor: Executor, system: System) -> str:
    """Why the thread of an executor polls; "" if it does not, as another executor in its loop waits."""
    reasons = [busy_polls(each) for each in thread_of(executor, system.executors)]
    return busy_polls(executor) if all(reasons) else ""


def _sent_again(system: System) -> dict[str, str]:
    """The messages on wires that lose reliable ones, each with the reason why nobody knows how often it is sent."""
    acknowledging = {
        wire.name for wire in system.network.wires for each in Direction if reliable_messages(wire.name, each, system)
    }
    reasons = {
        wire.name: reason
        for wire in system.network.wires
        if wire.loses_messages and wire.name in acknowledging and (reason := why_unbounded(wire, system.client_at(wire.name)))
    }
    return {
        each.name: f"messages are lost on {each.wire!r}, and reliable ones are sent again: {reasons[each.wire]}"
        for each in system.network.transmissions
        if each.wire in reasons
    }


def iterations_follow_at_once(executor: Executor) -> str:
    """Why iterations can follow each other at once even if nothing has happened; "" if they cannot.

    Unlike `busy_polls`, a loop whose wait is longer than its period counts, as it does not sleep while it catches up.
    """
    return "" if is_paced(executor) else waits_return_at_once(executor)


def waits_return_at_once(executor: Executor) -> str:
    """Why waits of an executor can return at once again and again, although nothing new has happened; "" if they cannot.

    A timer that is due makes the timeout 0, also if the trigger condition defers it (ros2/rcl, rcl/src/rcl/wait.c).
    """
    if not timeout_of(executor):
        if only_sends(executor):
            return "nothing waits between two times that it sends"
        what = "it has only timers" if not messages(executor) else "its timeout is below the resolution of the middleware"
        return f"its waits return at once, because {what}"
    if any(not handle.interval for handle in timers(executor)):
        return "a timer without a period is always due"
    if any(_is_deferred(handle, executor) for handle in timers(executor)):
        return "a timer that is due, and kept back by the trigger condition, ends each wait at once"
    if can_defer(executor) and executor.waiting.stored_data_ends_wait:
        return "a message that is kept back by the trigger condition ends each wait at once"
    return ""


def _is_deferred(timer: Handle, executor: Executor) -> bool:
    return len(executor.handles) > 1 and not starts_alone(timer, executor)


def why_not_woken(handle: Handle, executor: Executor, has_backlog: bool) -> str:
    """Why waits do not end for what a handle is released by; "" if they do."""
    waiting = executor.waiting
    if handle.kind is HandleKind.GUARD_CONDITION:
        return "" if waiting.guard_conditions_end_wait else "a guard condition does not end the wait"
    can_be_stored = has_backlog or waiting.messages_per_wait != 1
    if is_message(handle) and can_be_stored and not waiting.stored_data_ends_wait:
        return "a wait does not end for a message that is stored already"
    return ""


def lost_periods(lateness: Time, period: Time) -> int:
    """How many expirations of a timer are lost when a call begins so long after the one that it is for."""
    return lateness // period if period else 0


def next_expiration(due: Time, called: Time, period: Time) -> Time:
    """The expiration of a timer after a call: on the grid, and after the call."""
    return due + (lost_periods(called - due, period) + 1) * period


def why_deferred(executor: Executor) -> str:
    """Why iterations of a loop without a sleep can follow what begins them later and closer together; "" if they cannot.

    The stimulus of such an executor occurs when something arrives that begins an iteration. While an iteration is suspended, because a
    publication waits, others become due, and follow it without a pause: to processes of lower priority they come later and closer
    together.
    """
    waiting = [publication.topic for handle in executor.handles for publication in handle.publications if publication.waits]
    if min_pace(executor) or not waiting:
        return ""
    return (
        f"its loop has no sleep, so that iterations follow each other after one in which a publication of {waiting[0]!r} waited"
    )


def why_dense(executor: Executor, executors: Iterable[Executor], *, can_overrun: bool) -> str:
    """Why it is unknown how close together the iterations of an executor can be; "" if its stimulus says it.

    A loop with a period catches up after an iteration that took longer, with iterations that follow each other as messages arrive.

    Parameters
    ----------
    can_overrun : whether a wait and an iteration can take longer than the period of the loop
    """
    if min_pace(executor):
        return ""
    if executor.place is not None:
        return "its loop has no sleep, so that iterations of its executors follow each other as messages for any of them arrive"
    if shares_session(executor, executors):
        return "its loop has no sleep, so that iterations follow each other after one that waited for others of its session"
    if executor.loop.kind is not LoopKind.PERIODIC:
        return ""
    if can_overrun:
        return (
            "a wait and an iteration can be longer than its period, so that iterations follow each other until it has caught up"
        )
    return why_deferred(executor)


def workload(executor: Executor, events: EventModel, longest: Time) -> EventModel:
    """The event model of iterations that demand the longest execution time C each; that of the stimulus if there is no sleep.

    An iteration begins D after the end of the one before, where D is the sleep. Of k iterations that begin in a window of length w, all
    but the last one, and the k - 1 sleeps between them, are inside it, so that they demand at most C + min((k - 1) C, w - (k - 1) D),
    whatever the single ones take. With w = q (C + D) + r that is at most (q + 1) C if r <= D, and (q + 2) C otherwise, which is what
    ceil((w + C) / (C + D)) iterations of C demand: a period of C + D with a jitter of C. Shorter ones can be more frequent; so this
    says nothing of what an iteration activates.

    Parameters
    ----------
    longest : longest execution time C of an iteration
    """
    sleep = sleep_of(executor).lower
    return SporadicEvents(sleep + longest, longest, sleep) if sleep else events
