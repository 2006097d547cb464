"""The figures of a profile, as the description changes them."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.perf.executors import Waiting
from amalthea_uros.spec.middleware import Middleware, PoolSizes
from amalthea_uros.spec.profiles import ProfileData
from amalthea_uros.units import DataSize
from amalthea_uros.uros.middleware.profile import MiddlewareThread


def size(data: ProfileData, name: str) -> int:
    """A size of the profile in bytes, rounded up."""
    return _bytes(data.sizes[name])


def stated(limits: PoolSizes, *names: str) -> int | None:
    """What the description states for the first of some build options that it states; None for none."""
    values = (getattr(limits, name) for name in names if limits.states(name))
    return next(values, None)


def stated_length(limits: PoolSizes, *names: str) -> int | None:
    """The same for options that are lengths, in bytes."""
    length = stated(limits, *names)
    return None if length is None else _bytes(length)


def _bytes(bits: DataSize) -> int:
    return -(-bits // 8)


def waiting(data: ProfileData, slots: int | None) -> Waiting:
    """How an executor waits, with a number of slots for messages."""
    figures = data.waiting
    return Waiting(
        messages_per_wait=figures.messages_per_wait,
        resolution=figures.resolution,
        stored_data_ends_wait=figures.stored_data_ends_wait,
        guard_conditions_end_wait=figures.guard_conditions_end_wait,
        polls_without_messages=figures.polls_without_messages,
        slots=slots,
        default_timeout=figures.default_timeout,
    )


def threads(data: ProfileData, middleware: Middleware) -> Iterable[MiddlewareThread]:
    """The threads of a profile with what the description says about them, then those that only the description knows."""
    tasks = {task.name: task for task in middleware.tasks}
    for thread in data.threads:
        task = tasks.pop(thread.name, None)
        priority = thread.priority if task is None or task.priority is None else task.priority
        stack = thread.stack if task is None or task.stack is None else task.stack
        yield MiddlewareThread(
            name=thread.name,
            priority=priority,
            period=thread.period,
            stack=None if stack is None else _bytes(stack),
            calls_subscribers=thread.calls_subscribers,
            does=thread.does,
        )
    for task in tasks.values():
        yield MiddlewareThread(
            name=task.name,
            priority=task.priority,
            period=None,
            stack=None if task.stack is None else _bytes(task.stack),
            calls_subscribers=False,
            does="receives messages",
        )
