"""The executor: what an activation of its task does, and what that costs.

A callback with its own task (the mapping of the thesis, see `periods`) is only notified: the executor takes its message and leaves it
in a buffer. Callbacks inside the executor run as in rclc: one after the other in the order in which they were added, each message
taken just before its callback, or (LET) all messages taken first. With a trigger condition nothing is taken or called until it holds.

The cost of an activation is a base, a part for each handle and one for each timer that is checked, a part for each callback that is
ready, and for each message that is taken a fixed part and a part per byte. What does not happen in every activation is a runnable
that is called only every n-th time.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.activities import (
    AccessKind,
    Activity,
    Call,
    Demand,
    Execute,
    LabelAccess,
    Receive,
    ReceiveOperation,
    Trigger,
)
from amalthea_uros.perf.distributions import Constant
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.perf.network import Direction
from amalthea_uros.perf.software import Runnable
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.spec.executors import ExecutorSection, MessageCost
from amalthea_uros.units import DataSize, Time
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.application.phases import ExecutorPhases
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.assembly.planned import trigger_name
from amalthea_uros.uros.transports.messages import driver_costs

_BITS_PER_BYTE = 8
#: A message that a loop sends itself takes no time besides the cost of publishing, which is stated, not unknown.
AT_ONCE = (Execute(demand=Demand(ticks=Constant(0))),)


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedCall:
    """A runnable and the counter of its call."""

    runnable: Runnable
    counter: Counter | None = None

    @property
    def call(self) -> Call:
        """The call of the runnable."""
        return Call(runnable=self.runnable.name, counter=self.counter)


@dataclass(frozen=True, slots=True, kw_only=True)
class ExecutorRunnables:
    """Creates the runnables of the executor, with their cost on its core."""

    executor: ExecutorSection
    context: AssemblyContext
    core: str

    def spin(self, callbacks: Collection[Callback]) -> Runnable:
        """What every activation does for the callbacks that the executor has handles of."""
        executor, cost = self.executor, self.executor.execution_time
        handles = sum(each.handles for each in callbacks)
        parts = (cost.base, *([cost.per_timer] * timer_count(callbacks)), *([cost.per_handle] * handles))
        activities = self.context.converter.execute(parts, self.core, executor.location("execution_time"))
        if not activities and callbacks and all(each.kind is HandleKind.LOOP_ITEM for each in callbacks):
            activities = AT_ONCE
        return Runnable(name=spin_name(executor.name), activities=activities, origin=executor.location())

    def take_or_notify(self, callback: Callback, triggers: Iterable[str] = ()) -> Runnable:
        """What a ready callback adds: its notification, and the transfer of its message to the buffer if it has one.

        Parameters
        ----------
        triggers : tasks that it activates
        """
        cost = self.executor.execution_time
        message = callback.incoming
        parts = [cost.per_ready_callback, *message_cost(cost.per_message, message.size if message else None)]
        parts += driver_costs(self.context.line, callback, Direction.TO_CONTROLLER, self.context.profile)
        activities: list[Activity] = []
        if message is not None and message.channel in self.context.channels:
            activities.append(Receive(channel=message.channel, operation=ReceiveOperation.FIFO_TAKE))
        activities += self.context.converter.execute(parts, self.core, callback.origin)
        if callback.buffer is not None:
            activities.append(LabelAccess(label=callback.buffer, kind=AccessKind.WRITE))
        activities += [Trigger(stimulus=trigger_name(task)) for task in triggers]
        return Runnable(name=notification_name(callback), activities=tuple(activities), origin=callback.origin)


def spin_name(executor: str) -> str:
    """The name of the runnable that every activation of an executor begins with."""
    return f"{executor}_Spin"


def notification_name(callback: Callback) -> str:
    """The name of the runnable of the executor that makes a callback ready."""
    return f"{'Take' if callback.incoming else 'Notify'}_{callback.name}"


def message_cost(cost: MessageCost, size: DataSize | None) -> list[ExecutionTimeSection | Time | None]:
    """The parts of the cost of a message; none without a message."""
    if size is None:
        return []
    return [cost.fixed, cost.per_byte * -(-size // _BITS_PER_BYTE)]


def own_task_calls(
    callbacks: Iterable[Callback], runnables: ExecutorRunnables, phases: ExecutorPhases
) -> Iterator[PlannedCall]:
    """The calls of the executor for callbacks with their own tasks."""
    for callback in callbacks:
        runnable = runnables.take_or_notify(callback)
        if runnable.activities:
            yield PlannedCall(runnable=runnable, counter=phases.counter(callback, callback.nominal_interval))


def in_executor_calls(
    callbacks: Sequence[Callback], bodies: Mapping[str, Runnable], runnables: ExecutorRunnables, phases: ExecutorPhases
) -> Iterator[PlannedCall]:
    """The calls of the executor for callbacks that run in it, in their order.

    Parameters
    ----------
    bodies : the runnable of each callback
    """
    executor = runnables.executor
    counters = {callback.name: _triggered_counter(callback, callbacks, executor, phases) for callback in callbacks}
    takes = {
        callback.name: PlannedCall(runnable=runnable, counter=counters[callback.name])
        for callback in callbacks
        if (runnable := runnables.take_or_notify(callback)).activities
    }
    runs = {
        callback.name: PlannedCall(runnable=bodies[callback.name], counter=counters[callback.name]) for callback in callbacks
    }
    if executor.semantics == "LET":
        yield from (*takes.values(), *runs.values())
        return
    for name, run in runs.items():
        if name in takes:
            yield takes[name]
        yield run


def _triggered_counter(
    callback: Callback, callbacks: Sequence[Callback], executor: ExecutorSection, phases: ExecutorPhases
) -> Counter | None:
    """The counter of the call of a callback under the trigger condition; callbacks that wait for the same event are due together."""
    trigger = executor.trigger
    one = next((other for other in callbacks if other.name == trigger.one), None)
    if one is not None and one.nominal_interval >= callback.nominal_interval:
        return phases.counter(callback, one.nominal_interval, waits_for=one.name)
    if trigger.one is None and trigger.when == "all" and len(callbacks) > 1:
        return phases.counter(callback, max(other.nominal_interval for other in callbacks), waits_for=executor.name)
    return phases.counter(callback, callback.nominal_interval)


def timer_count(callbacks: Iterable[Callback]) -> int:
    """The number of timers that the executor checks."""
    return sum(callback.kind is HandleKind.TIMER for callback in callbacks)
