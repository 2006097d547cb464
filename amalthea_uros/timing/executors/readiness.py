"""Which callbacks a round calls.

What is ready is fixed once, after the wait; then the trigger decides whether anything is called (ros2/rclc, rclc/src/rclc/executor.c).
A handle takes one message in a round, whatever is stored for it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from amalthea_uros.perf.executors import Executor, Handle, HandleKind, TriggerKind
from amalthea_uros.timing.executors.wait import is_message


def is_exclusive(executor: Executor, others: Sequence[Executor]) -> bool:
    """Whether at most one of the handles that receive messages is ready in a round.

    A wait takes one message, and it is called in the same round. Nothing is stored for later if no publication waits for an
    acknowledgement, the trigger keeps nothing back, and no other executor receives from the same buffer.
    """
    return executor.waiting.messages_per_wait == 1 and not stores(executor, others)


def stores(executor: Executor, others: Sequence[Executor]) -> bool:
    """Whether messages can be stored before a round that takes them: see `is_exclusive`."""
    return (
        keeps_back(executor)
        or len(sharing(executor, others)) > 1
        or any(publication.waits for handle in executor.handles for publication in handle.publications)
    )


def keeps_back(executor: Executor) -> bool:
    """Whether the trigger can prevent that what is ready is called."""
    return executor.trigger.kind not in (TriggerKind.ANY, TriggerKind.ALWAYS)


def starts_alone(handle: Handle, executor: Executor) -> bool:
    """Whether a handle is called in the next round once it is ready, whatever the others are."""
    return not keeps_back(executor) or frozenset((handle.name,)) in executor.trigger.sets


def shares_session(executor: Executor, others: Iterable[Executor]) -> bool:
    """Whether another executor uses the same session, so that they exclude each other."""
    return executor.session is not None and len(sharing(executor, others)) > 1


def sharing(executor: Executor, executors: Iterable[Executor]) -> list[Executor]:
    """The executors that use the same buffers and slots for messages, itself included; without a session, all that have none."""
    return [each for each in executors if each.session == executor.session]


def at_once(executor: Executor) -> tuple[Handle, ...]:
    """The handles that can be ready besides a message that excludes others; an action server also has a timer."""
    return tuple(
        handle
        for handle in executor.handles
        if handle.always or not is_message(handle) or handle.kind is HandleKind.ACTION_SERVER
    )
