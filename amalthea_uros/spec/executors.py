"""Executors: the tasks or threads that serve the middleware, and how they wait for messages and timers."""

from __future__ import annotations

from typing import Annotated, Literal

from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.spec.fields import Limits, entry
from amalthea_uros.spec.loops import LoopSection
from amalthea_uros.spec.os import OverheadSection
from amalthea_uros.spec.section import DescriptionSection, Shorthand
from amalthea_uros.spec.values import Count, Duration, Name, Offset, Priority, Size, described


class MessageCost(Shorthand):
    """Execution time per message: a time, or a fixed part and a part per byte."""

    shorthand = ("fixed",)
    plain_value = "The same execution time for every message."
    nested = ExecutionTimeSection

    fixed: ExecutionTimeSection | None = None
    """Execution time per message, independent of its size."""
    per_byte: Offset = 0
    """Additional execution time per byte of the message."""


class ExecutorCost(Shorthand):
    """Execution time of an activation of the executor: a time, or parts that depend on the callbacks and messages to serve."""

    shorthand = ("base",)
    plain_value = "The same execution time in every activation of the executor."
    nested = ExecutionTimeSection

    base: ExecutionTimeSection | None = None
    """Execution time of every activation."""
    per_ready_callback: ExecutionTimeSection | None = None
    """Additional execution time per ready callback."""
    per_message: MessageCost = entry(default_factory=MessageCost.model_construct)
    """Additional execution time per message taken."""
    per_timer: ExecutionTimeSection | None = None
    """Additional execution time per timer, in every activation."""
    per_handle: ExecutionTimeSection | None = None
    """Additional execution time per handle, in every activation: the wait set is filled anew each time."""


_TRIGGERS = described(
    any="As soon as any callback is ready.",
    all="When all callbacks are ready.",
    always="In every iteration, ready or not.",
)


class TriggerSection(Shorthand):
    """When the executor runs its callbacks: `any`, `all`, `always`, `{one: NAME}`, or `{custom: [[NAME, ...], ...]}`."""

    shorthand = ("when",)
    plain_value = "`any`: as soon as any callback is ready; `all`: when all callbacks are ready; `always`: in every iteration."

    when: Annotated[Literal["any", "all", "always"], _TRIGGERS] = "any"
    """`any`: as soon as any callback is ready; `all`: when all callbacks are ready; `always`: in every iteration."""
    one: Name | None = None
    """As soon as this callback is ready."""
    custom: Annotated[list[Annotated[list[Name], Limits(min_length=1)]], Limits(min_length=1)] | None = None
    """As soon as all callbacks of one of these sets are ready: what a trigger function of the application returns."""


_PLACES = described(
    own_task="Each callback in a separate task.",
    in_executor="One after the other in the task of the executor.",
)
_SEMANTICS = described(
    ROS="Each message is taken just before its callback runs.",
    LET="All messages are taken before the first callback runs (logical execution time).",
)


class ExecutorSection(DescriptionSection):
    """The task or thread that serves the middleware and notifies or runs callbacks."""

    name: Name = "Executor_Task"
    """Name of the task."""
    period: Duration | None = None
    """Period of its activation; default: the longest available period that is not longer than the interval of any callback."""
    offset: Offset = 0
    """Time of the first activation."""
    priority: Priority | None = None
    """Priority of its task; default: rate monotonic, above all other tasks with the same period."""
    core: Name | None = None
    """Core of its task; default: the first core."""
    deadline: Duration | None = None
    """Deadline relative to the activation."""
    overhead: OverheadSection | None = None
    """Overhead of the operating system per job; default: that of `os`."""
    loop: LoopSection | None = None
    """How its thread spins; without it, its task is activated with `period`, if it does not spin in the loop of another executor."""
    max_handles: Count | None = None
    """Number of handles that `rclc_executor_init` gets; default: as many as it has."""
    stack: Size | None = None
    """Stack of its thread or task."""
    execution_time: ExecutorCost = entry(default_factory=ExecutorCost.model_construct)
    """Execution time of an activation."""
    callbacks: Annotated[Literal["own-task", "in-executor"], _PLACES] = "own-task"
    """Where callbacks without `runs_in` run: each in a separate task, or one after the other in the executor; default: `in-executor`
    for an executor with a `loop`, else what the platform says, `own-task` if it says nothing."""
    order: list[Name] = entry(default_factory=list)
    """Order in which callbacks were added to the executor; callbacks not listed follow in the order of the file. An executor
    without callbacks needs an empty list."""
    semantics: Annotated[Literal["ROS", "LET"], _SEMANTICS] = "ROS"
    """`ROS`: each message is taken just before its callback runs; `LET`: all messages are taken before the first callback runs."""
    trigger: TriggerSection = entry(default_factory=TriggerSection.model_construct)
    """Condition under which callbacks in the executor run."""


def with_shared_loops(executors: tuple[ExecutorSection, ...]) -> tuple[ExecutorSection, ...]:
    """Executors, of which those that spin in the loop of another one have a loop, too: with the timeout that is given there."""
    if not any(each.loop is not None and each.loop.items is not None for each in executors):
        return executors
    shared = {
        item.executor: (each, item)
        for each in executors
        if each.loop is not None
        for item in each.loop.items or ()
        if item.executor is not None and item.executor != each.name
    }
    executors_with_loops = []
    for each in executors:
        if each.loop is not None and each.loop.items is not None and not each.inherits("loop"):
            own = next((item for item in each.loop.items if item.is_own_spin), None)
            loop = each.loop.model_copy(update={"spin_some": None if own is None else own.spin_some})
            executors_with_loops.append(each.model_copy(update={"loop": loop}))
        elif each.name in shared:
            owner, item = shared[each.name]
            loop = (owner.loop or LoopSection(spin_some=0)).model_copy(update={"spin_some": item.spin_some, "items": None})
            # Its thread is that of the owner.
            thread = {key: getattr(owner, key) for key in ("priority", "core", "overhead") if not each.states(key)}
            executors_with_loops.append(each.model_copy(update={"loop": loop, **thread}))
        else:
            executors_with_loops.append(each)
    return tuple(executors_with_loops)
