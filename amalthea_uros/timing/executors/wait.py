"""How long an executor waits for messages and timers in a round.

- `rcl_wait` shortens the timeout to the time until the next timer is due (ros2/rcl, rcl/src/rcl/wait.c).
- `rmw_wait` cuts it to whole milliseconds, so that it can end up to 1 ms before the timer is due, and that of less than 1 ms looks once
  whether there is a message (micro-ROS/rmw_microxrcedds, src/rmw_wait.c).
- It ends with the first message that arrives during the wait, or that waits in the buffer of the transport. A message that is stored
  already, because it came while a publication waited for its acknowledgement, does not end it.
- Without anything that receives messages it does not wait at all (rmw_microxrcedds#297).
"""

from __future__ import annotations

from amalthea_uros.perf.executors import Executor, Handle, HandleKind
from amalthea_uros.units import Time


def is_message(handle: Handle) -> bool:
    """Whether a handle receives messages: all do but timers and guard conditions."""
    return handle.kind not in (HandleKind.TIMER, HandleKind.GUARD_CONDITION)


def timers(executor: Executor) -> tuple[Handle, ...]:
    """The timers of an executor."""
    return tuple(handle for handle in executor.handles if handle.kind is HandleKind.TIMER)


def messages(executor: Executor) -> tuple[Handle, ...]:
    """The handles of an executor that receive messages."""
    return tuple(handle for handle in executor.handles if is_message(handle))


def polls_without_messages(executor: Executor) -> bool:
    """Whether the wait of an executor always returns at once, because nothing of it receives messages."""
    return executor.waiting.polls_without_messages and not messages(executor)


def cut(timeout: Time, executor: Executor) -> Time:
    """A timeout in whole units of the resolution of the middleware."""
    resolution = executor.waiting.resolution
    return timeout - timeout % resolution if resolution else timeout


def timeout_of(executor: Executor) -> Time:
    """The timeout of a wait when no timer is pending."""
    return 0 if polls_without_messages(executor) else cut(executor.loop.timeout, executor)


def greatest_wait(executor: Executor) -> Time:
    """The longest wait: a timer is due again after its period at most, because calls keep its grid."""
    pending = (handle.interval for handle in timers(executor) if handle.interval is not None)
    return min([timeout_of(executor), *(cut(period, executor) for period in pending)])
