"""The executor: what an activation of its task costs and does.

In a task of its own (the way of the thesis, see `periods`) a callback is only notified: the executor takes its message and leaves it in
a buffer. A callback inside the executor runs as rclc does it: one after the other in the order in which they were added, each message
taken just before its callback, or (LET) all messages taken first. With a trigger condition nothing is taken or called before it holds.

The cost of an activation is a base, a part for each timer that is looked at, a part for each callback that is ready, and for each
message that is taken a fixed part and one for each of its bytes. What does not happen in every activation is a runnable that is called
every n-th time only.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from amalthea_uros.perf.software import AccessKind, Activity, Call, LabelAccess, Runnable
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.spec.execution_time import ExecutionTime
from amalthea_uros.spec.middleware import Executor, MessageCost, Middleware
from amalthea_uros.units import DataSize, Time
from amalthea_uros.uros.callbacks import Callback, Kind
from amalthea_uros.uros.demand import Profile

_BITS_PER_BYTE = 8


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """A runnable and how often it is called."""

    runnable: Runnable
    counter: Counter | None = None

    @property
    def call(self) -> Call:
        """The call of the runnable."""
        return Call(runnable=self.runnable.name, counter=self.counter)


@dataclass(frozen=True, slots=True, kw_only=True)
class Costs:
    """What the middleware costs on a core."""

    middleware: Middleware
    profile: Profile
    core: str

    def spin(self, timers: int) -> Runnable:
        """What every activation does."""
        executor = self.middleware.executor
        stated = executor.execution_time
        parts = (stated.base, *([stated.per_timer] * timers))
        activities = self.profile.execute(parts, self.core, executor.location("execution_time"))
        return Runnable(name=f"{executor.name}_Spin", activities=activities, origin=executor.location())

    def notice(self, callback: Callback) -> Runnable:
        """Noticing that a callback is ready, and taking its message if there is one."""
        stated = self.middleware.executor.execution_time
        message = callback.incoming
        parts = [stated.per_ready_callback, *message_cost(stated.per_message, message.size if message else None)]
        activities: list[Activity] = [*self.profile.execute(parts, self.core, callback.origin)]
        if callback.buffer is not None:
            activities.append(LabelAccess(label=callback.buffer, kind=AccessKind.WRITE))
        verb = "Take" if message else "Notify"
        return Runnable(name=f"{verb}_{callback.name}", activities=tuple(activities), origin=callback.origin)


def message_cost(stated: MessageCost, size: DataSize | None) -> list[ExecutionTime | Time | None]:
    """The parts that a message costs; none if there is no message."""
    if size is None:
        return []
    return [stated.fixed, stated.per_byte * -(-size // _BITS_PER_BYTE)]


def occurrences(interval: Time, period: Time) -> Counter | None:
    """How often something that happens every interval falls into an activation: every n-th one, rounded towards more often."""
    prescaler = max(1, interval // period)
    return Counter(prescaler=prescaler) if prescaler > 1 else None


def own_task_parts(callbacks: Iterable[Callback], costs: Costs, period: Time) -> Iterator[Part]:
    """What the executor does for callbacks that run in tasks of their own."""
    for callback in callbacks:
        notice = costs.notice(callback)
        if notice.activities:
            yield Part(runnable=notice, counter=occurrences(callback.interval, period))


def in_executor_parts(
    callbacks: Sequence[Callback], bodies: Mapping[str, Runnable], costs: Costs, period: Time
) -> Iterator[Part]:
    """What the executor does for callbacks that run inside it, in their order.

    Parameters
    ----------
    bodies : the runnable of each callback
    """
    executor = costs.middleware.executor
    counters = {callback.name: _counter(callback, callbacks, executor, period) for callback in callbacks}
    notices = [
        Part(runnable=notice, counter=counters[callback.name])
        for callback in callbacks
        if (notice := costs.notice(callback)).activities
    ]
    runs = [Part(runnable=bodies[callback.name], counter=counters[callback.name]) for callback in callbacks]
    if executor.semantics == "LET":
        yield from (*notices, *runs)
        return
    by_callback = {part.runnable.name.partition("_")[2]: part for part in notices}
    for callback, run in zip(callbacks, runs, strict=True):
        if callback.name in by_callback:
            yield by_callback[callback.name]
        yield run


def _counter(callback: Callback, callbacks: Sequence[Callback], executor: Executor, period: Time) -> Counter | None:
    """Every how many activations a callback runs, considering the trigger condition."""
    trigger = executor.trigger
    due = callback.interval
    if trigger.one is not None:
        due = max(due, next((other.interval for other in callbacks if other.name == trigger.one), due))
    elif trigger.when == "all":
        due = max(other.interval for other in callbacks)
    return occurrences(due, period)


def timers(callbacks: Iterable[Callback]) -> int:
    """How many timers the executor looks at."""
    return sum(callback.kind is Kind.TIMER for callback in callbacks)
