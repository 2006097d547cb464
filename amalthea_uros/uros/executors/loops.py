"""The loop of an executor, and when its rounds can follow each other without a pause.

See ros2/rclc `rclc/src/rclc/executor.c`: `rclc_executor_spin` is an endless `spin_some`; `rclc_executor_spin_period` calls `spin_some`
with the timeout of the executor, whatever the period, and then sleeps until the next multiple of the period.
"""

from __future__ import annotations

from amalthea_uros.perf.executors import Executor as LoopingExecutor
from amalthea_uros.perf.executors import HandleKind, Loop, LoopKind, TriggerCondition, TriggerKind, Waiting
from amalthea_uros.spec import executors as spec


def loop_of(section: spec.Loop, waiting: Waiting) -> Loop:
    """The loop that a section describes."""
    if section.spin_some is not None:
        return Loop(kind=LoopKind.SPIN_SOME, timeout=section.spin_some, sleep=section.sleep)
    if section.spin_period is not None:
        timeout = section.timeout if section.timeout is not None else waiting.default_timeout
        return Loop(kind=LoopKind.SPIN_PERIOD, timeout=timeout, period=section.spin_period)
    assert section.spin is not None
    return Loop(kind=LoopKind.SPIN, timeout=section.spin)


def is_paced(loop: Loop) -> bool:
    """Whether its rounds keep a distance from each other by themselves, by a sleep or by a period that the wait cannot exceed."""
    return loop.sleep > 0 or (loop.period is not None and loop.timeout <= loop.period)


def polls(executor: LoopingExecutor) -> str | None:
    """Why rounds follow each other at once even if nothing has happened; None if they do not."""
    loop, waiting = executor.loop, executor.waiting
    if is_paced(loop):
        return None
    if loop.timeout < waiting.resolution or loop.timeout == 0:
        return "its timeout is cut to 0"
    if waiting.polls_without_messages and all(handle.kind in _WITHOUT_MESSAGES for handle in executor.handles):
        return "it waits for no message, and the middleware then returns at once"
    if keeps_back(executor.trigger):
        if any(handle.kind is HandleKind.TIMER and _is_kept_back(handle.name, executor) for handle in executor.handles):
            return "a timer that is due, and kept back by the trigger condition, ends each wait at once"
        if waiting.stored_data_ends_wait:
            return "a message that is kept back by the trigger condition ends each wait at once"
    return None


_WITHOUT_MESSAGES = (HandleKind.TIMER, HandleKind.GUARD_CONDITION)


def keeps_back(trigger: TriggerCondition) -> bool:
    """Whether a trigger condition can be false although something is ready."""
    return trigger.kind in (TriggerKind.ALL, TriggerKind.ONE, TriggerKind.CUSTOM)


def _is_kept_back(timer: str, executor: LoopingExecutor) -> bool:
    """Whether the trigger condition can be false although a timer is due."""
    if executor.trigger.kind is TriggerKind.ALL:
        return len(executor.handles) > 1
    return frozenset([timer]) not in executor.trigger.sets
