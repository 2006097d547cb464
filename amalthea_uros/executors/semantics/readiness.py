"""Which callbacks an iteration calls, and how many messages are stored meanwhile.

What is ready is fixed once, after the wait; then the trigger decides whether anything is called (ros2/rclc, rclc/src/rclc/executor.c).
A handle takes one message in an iteration, whatever is stored for it.

All subscriptions, services and clients of a process share one pool of slots, whatever their executor. A message for a handle that has
`depth` messages overwrites the oldest of them, or is dropped itself if all are to be kept. Below that depth, a message for which the
pool has no slot is dropped (micro-ROS/rmw_microxrcedds, src/callbacks.c, src/types.c).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction

from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.executors import Executor, Handle, HandleKind, TriggerKind
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.relays import arrives_regularly
from amalthea_uros.timing.event_models.models import PeriodicEvents, SporadicEvents
from amalthea_uros.units import SECOND, Time

#: A stored message is removed when it is older than the lifespan of its QoS, by default 30 s.
LIFESPAN = 30 * SECOND


def is_message(handle: Handle) -> bool:
    """Whether a handle receives messages: all do but timers, guard conditions and items of loops."""
    return handle.kind not in (HandleKind.TIMER, HandleKind.GUARD_CONDITION, HandleKind.LOOP_ITEM)


def timers(executor: Executor) -> tuple[Handle, ...]:
    """The timers of an executor."""
    return tuple(handle for handle in executor.handles if handle.kind is HandleKind.TIMER)


def messages(executor: Executor) -> tuple[Handle, ...]:
    """The handles of an executor that receive messages."""
    return tuple(handle for handle in executor.handles if is_message(handle))


def takes_one_message(executor: Executor, system: System) -> bool:
    """Whether at most one of the handles that receive messages is ready in an iteration.

    A wait takes one message, and it is called in the same iteration. Nothing is stored for later if no publication waits for an
    acknowledgement, the trigger defers nothing, no other executor receives from the same buffer, and no message waits for a missing
    one before it.
    """
    return executor.waiting.messages_per_wait == 1 and not has_backlog(executor, system)


def reads_in_waits(executor: Executor) -> bool:
    """Whether the waits of an executor read from the receive buffer; with timers only, they may return at once instead."""
    return bool(messages(executor)) or not (executor.waiting.polls_without_messages or only_sends(executor))


def only_sends(executor: Executor) -> bool:
    """Whether an executor stands for what a loop sends itself, which waits for nothing."""
    return bool(executor.handles) and all(handle.kind is HandleKind.LOOP_ITEM for handle in executor.handles)


def has_backlog(executor: Executor, system: System) -> bool:
    """Whether messages can be stored before an iteration that takes them: see `takes_one_message`."""
    others = [each for each in sharing(executor, system.executors) if each.name != executor.name]
    can_store = map(waits_for_acknowledgements, (executor, *others))
    return can_defer(executor) or any(can_store) or any(map(reads_in_waits, others)) or _waits_for_missing(executor, system)


def _waits_for_missing(executor: Executor, system: System) -> bool:
    """Whether a message of an executor can wait for a missing one before it, and then be handed over together with others."""
    lossy = {wire.name for wire in system.network.wires if wire.loses_messages}
    reliable = {handle.transmission for handle in executor.handles if handle.reliable}
    return any(each.name in reliable and each.wire in lossy for each in system.network.transmissions)


def waits_for_acknowledgements(executor: Executor) -> bool:
    """Whether a callback of an executor waits until a message is acknowledged."""
    return any(publication.waits for handle in executor.handles for publication in handle.publications)


def can_defer(executor: Executor) -> bool:
    """Whether the trigger condition can prevent that what is ready is called."""
    return executor.trigger.kind not in (TriggerKind.ANY, TriggerKind.ALWAYS)


def starts_alone(handle: Handle, executor: Executor) -> bool:
    """Whether a handle is called in the next iteration once it is ready, whatever the others are."""
    return not can_defer(executor) or frozenset((handle.name,)) in executor.trigger.sets


def shares_session(executor: Executor, executors: Iterable[Executor]) -> bool:
    """Whether another executor uses the same session, so that they exclude each other."""
    return executor.session is not None and bool(other_threads(executor, executors))


def other_threads(executor: Executor, executors: Iterable[Executor]) -> list[Executor]:
    """The executors of other threads that use the same session; within a thread, one follows the other."""
    own = executor.place
    return [
        each
        for each in sharing(executor, executors)
        if each.name != executor.name and (own is None or each.place is None or each.place.thread != own.thread)
    ]


def sharing(executor: Executor, executors: Iterable[Executor]) -> list[Executor]:
    """The executors that use the same buffers and slots for messages, itself included; without a session, all that have none."""
    return [each for each in executors if each.session == executor.session]


def thread_of(executor: Executor, executors: Sequence[Executor]) -> list[Executor]:
    """The executors that spin one after the other in the same thread, in their order, itself included."""
    if executor.place is None:
        return [executor]
    return [each for each in executors if each.place is not None and each.place.thread == executor.place.thread]


def others_of_thread(executor: Executor, executors: Sequence[Executor]) -> list[Executor]:
    """The other executors that spin in the same thread."""
    return [each for each in thread_of(executor, executors) if each.name != executor.name]


def is_independent(handle: Handle) -> bool:
    """Whether a handle can be ready besides a message that excludes others; an action server also has a timer."""
    return handle.always or not is_message(handle) or handle.kind is HandleKind.ACTION_SERVER


def can_exceed_depth(handle: Handle, stored: int) -> bool:
    """Whether so many messages are more than a handle keeps."""
    return handle.depth is not None and stored > handle.depth


def slots_needed(handles: Iterable[Handle], stored: Mapping[str, int | None]) -> int | None:
    """The slots for the messages of all handles, by their names; None if a number of messages is not known, and nothing limits it."""
    kept = [_kept(handle, stored[handle.name]) for handle in handles]
    return None if None in kept else sum(filter(None, kept))


def _kept(handle: Handle, stored: int | None) -> int | None:
    """How many messages of a handle can occupy slots."""
    # Each entity behind an action keeps as many; of a server's, one is a timer.
    entities = handle.sources - (handle.kind is HandleKind.ACTION_SERVER and handle.sources > 1)
    depth = None if handle.depth is None else handle.depth * entities
    known = [number for number in (depth, stored) if number is not None]
    return min(known) if known else None


def arrivals(handle: Handle, extra_jitter: Mapping[str, Time | None]) -> PeriodicEvents:
    """The event model of the messages of a handle, or of the expirations of a timer.

    Parameters
    ----------
    extra_jitter : by which messages of a handle are late besides what is stated for it, from the wire and the agent

    Raises
    ------
    UnknownError : the interval or a jitter is not known.
    """
    if not handle.interval:
        raise UnknownError(f"the minimum time between two messages for {handle.name!r} is not stated")
    extra = extra_jitter.get(handle.name, None if handle.transmission is not None else 0)
    if extra is None:
        way = "" if handle.transmission is None else f", see {handle.transmission!r}"
        raise UnknownError(f"the jitter of the messages for {handle.name!r} on their way is not known{way}")
    kind = PeriodicEvents if handle.is_periodic else SporadicEvents
    return kind(handle.interval, handle.jitter + extra)


def certain_rate(executor: Executor, system: System) -> Fraction:
    """How many messages per time arrive at an executor for certain: those that come regularly."""
    periods = (handle.interval for handle in messages(executor) if arrives_regularly(handle, system))
    return sum((Fraction(1, period) for period in periods if period), Fraction(0))
