"""What a thread does between two waits of its loop.

- `spin_some` and a sleep: the sleep follows every round.
- `spin`: the next wait follows at once.
- `spin_period`: it sleeps until its invocation time plus the period, cut to whole milliseconds, and then the invocation time advances
  by the period. After an overrun it does not sleep until it has caught up (ros2/rclc, rclc/src/rclc/executor.c,
  `rclc_executor_spin_one_period`). Its wait uses the timeout of the executor, not the period.
"""

from __future__ import annotations

from amalthea_uros.perf.executors import Executor, Handle, LoopKind
from amalthea_uros.timing.executors.readiness import keeps_back, starts_alone
from amalthea_uros.timing.executors.wait import messages, timeout_of, timers
from amalthea_uros.units import MILLISECOND, Time

#: `rclc_sleep_ms` sleeps whole milliseconds.
SLEEP_RESOLUTION = MILLISECOND


def longest_sleep(executor: Executor) -> Time:
    """The longest sleep between two rounds."""
    return executor.loop.sleep if executor.loop.kind is LoopKind.SPIN_SOME else 0


def least_sleep(executor: Executor) -> Time:
    """The shortest sleep between two rounds."""
    return longest_sleep(executor) - executor.loop.sleep_early


def least_pace(executor: Executor) -> Time:
    """The time per round that a loop with sleeps takes at least in the long run; 0 for a loop without sleeps."""
    return max(least_sleep(executor), executor.loop.pace)


def never_rests(executor: Executor) -> str:
    """Why the thread of an executor can occupy its core without end, although nothing is to be done; "" if it cannot."""
    if least_pace(executor) or executor.loop.kind is LoopKind.SPIN_PERIOD:
        return ""
    reason = waits_return_at_once(executor)
    return reason and f"its loop has no sleep, and {reason}"


def waits_return_at_once(executor: Executor) -> str:
    """Why waits of an executor can return at once again and again, although nothing new has happened; "" if they cannot.

    A timer that is due makes the timeout 0, also if the trigger condition keeps it back (ros2/rcl, rcl/src/rcl/wait.c).
    """
    if not timeout_of(executor):
        what = "it has only timers" if not messages(executor) else "its timeout is below the resolution of the middleware"
        return f"its waits return at once, because {what}"
    if any(not handle.interval for handle in timers(executor)):
        return "a timer without a period is always due"
    if any(_is_kept_back(handle, executor) for handle in timers(executor)):
        return "a timer that is due, and kept back by the trigger condition, ends each wait at once"
    if keeps_back(executor) and executor.waiting.stored_data_ends_wait:
        return "a message that is kept back by the trigger condition ends each wait at once"
    return ""


def _is_kept_back(timer: Handle, executor: Executor) -> bool:
    return len(executor.handles) > 1 and not starts_alone(timer, executor)
