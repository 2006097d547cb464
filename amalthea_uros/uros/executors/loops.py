"""The loop of an executor, and when its rounds can follow each other without a pause.

See ros2/rclc `rclc/src/rclc/executor.c`: `rclc_executor_spin` is an endless `spin_some`; `rclc_executor_spin_period` calls `spin_some`
with the timeout of the executor, whatever the period, and then sleeps until the next multiple of the period.
"""

from __future__ import annotations

from amalthea_uros.perf.executors import Executor as LoopingExecutor
from amalthea_uros.perf.executors import Loop, LoopKind, Waiting
from amalthea_uros.spec import executors as spec
from amalthea_uros.spec.os import Os
from amalthea_uros.timing.executors.loops import waits_return_at_once
from amalthea_uros.uros.rtos import slept


def loop_of(section: spec.Loop, waiting: Waiting, os: Os) -> Loop:
    """The loop that a section describes, on an operating system that counts sleeps in ticks."""
    if section.spin_some is not None:
        least, most, pace = slept(section.sleep, os)
        return Loop(
            kind=LoopKind.SPIN_SOME,
            timeout=section.spin_some,
            sleep=most,
            sleep_early=most - least,
            pace=pace if pace > least else 0,
        )
    if section.spin_period is not None:
        timeout = section.timeout if section.timeout is not None else waiting.default_timeout
        return Loop(kind=LoopKind.SPIN_PERIOD, timeout=timeout, period=section.spin_period)
    assert section.spin is not None
    return Loop(kind=LoopKind.SPIN, timeout=section.spin)


def is_paced(loop: Loop) -> bool:
    """Whether its rounds keep a distance from each other by themselves, by a sleep or by a period that the wait cannot exceed."""
    return loop.sleep > 0 or (loop.period is not None and loop.timeout <= loop.period)


def polls(executor: LoopingExecutor) -> str:
    """Why rounds can follow each other at once even if nothing has happened; "" if they cannot."""
    return "" if is_paced(executor.loop) else waits_return_at_once(executor)
