"""What a thread does between two waits of its loop.

- `spin_some` and a sleep: the sleep follows every round.
- `spin`: the next wait follows at once.
- `spin_period`: it sleeps until its invocation time plus the period, cut to whole milliseconds, and then the invocation time advances
  by the period. After an overrun it does not sleep until it has caught up (ros2/rclc, rclc/src/rclc/executor.c,
  `rclc_executor_spin_one_period`). Its wait uses the timeout of the executor, not the period.
"""

from __future__ import annotations

from amalthea_uros.perf.executors import Executor, LoopKind
from amalthea_uros.timing.executors.wait import messages, timeout_of, timers
from amalthea_uros.units import MILLISECOND, Time

#: `rclc_sleep_ms` sleeps whole milliseconds.
SLEEP_RESOLUTION = MILLISECOND


def least_sleep(executor: Executor) -> Time:
    """The shortest sleep between two rounds."""
    return executor.loop.sleep if executor.loop.kind is LoopKind.SPIN_SOME else 0


def never_rests(executor: Executor) -> str:
    """Why the thread of an executor can occupy its core without end, although nothing is to be done; "" if it cannot."""
    if least_sleep(executor) or executor.loop.kind is LoopKind.SPIN_PERIOD:
        return ""
    if not timeout_of(executor):
        what = "it has only timers" if not messages(executor) else "its timeout is below the resolution of the middleware"
        return f"its loop has no sleep, and its waits return at once, because {what}"
    if any(not handle.interval for handle in timers(executor)):
        return "its loop has no sleep, and a timer without a period is always due"
    return ""
