"""How long a message can be stored before an iteration takes it, if a publication read it while it waited for its acknowledgement.

A stored message does not end the wait of the next iteration: that ends with the next message from the wire, or at its timeout. So
each iteration takes one message of a handle, but iterations can be as rare as messages, and messages stay behind by as many as were
stored once.

Let Lb be the time from a check of what is ready to the beginning of the next wait, B that from the arrival which ends a wait to the
check after it, and L2 = Lb + B. The receive buffer is empty while a wait blocks, so that the messages of a handle that arrive from
the end of one blocking wait to the beginning of the next one, m iterations later, are at most eta(m L2), that end included. Each of
the m iterations takes one while any is stored. So if

    eta(m L2) <= m    for all m >= 1,

never more are stored when a wait blocks than when the one before did. In the iteration in which the first one is stored again, those
that arrived during the greatest age H of the receive backlog can be in it, so that at most

    n = max over j >= 0 of eta(H + (j + 1) L2) - j

are stored when a wait blocks. If the condition does not hold, n is what the handle and all handles together can store; more are lost.

A message is read at most Q after its arrival. If it ends a wait, the check follows B later, and takes another one if n are stored
already. Of the checks after that, the n-th at the latest takes it, each of which follows Lb, the wait and B after the one before: at
most L2 + G with the greatest distance G of two messages that come for certain, or the longest cycle with the whole timeout. If its
handle is the only one of the executor, and waits last longer than B, they read until a message comes, and no message is in the backlog
when nothing is taken: H = 0, so that n = 1, and the next message of the handle arrives after the wait has begun, and ends it.

If it is the only one, called for messages only, and delta(2) > I + L2 with the longest cycle I without a callback, nothing is ever
stored: a message that arrives in such a cycle is taken I later, and the next one arrives after the wait that follows has begun. Then it
is taken after L2 at most, as any message of an executor that stores none. A handle that is called in each iteration publishes in those,
too, and then reads the message that arrives in it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.bounds.cycle import Cycle
from amalthea_uros.executors.semantics.loops import longest_wait
from amalthea_uros.executors.semantics.readiness import arrivals, can_defer, messages, sharing
from amalthea_uros.perf.executors import Handle
from amalthea_uros.timing.activation.relays import arrives_regularly
from amalthea_uros.timing.event_models.models import EventModel
from amalthea_uros.units import Time

#: Iterations between two blocking waits; with more, iterations are hardly faster than messages.
_MAX_ITERATIONS = 10_000

ASSUMPTION = "executors: periodic messages keep coming, as a message that is stored waits for the next one"


@dataclass(frozen=True, slots=True, kw_only=True)
class Storage:
    """The longest time from the arrival of a message to the check of the iteration that takes it.

    Attributes
    ----------
    why : what it waits for
    is_stored : whether a publication can have read it
    """

    most: Time
    why: str
    is_stored: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class StorageConditions:
    """What bounds how long the messages of a handle can be stored.

    Attributes
    ----------
    events : arrivals of its messages
    until_wait : longest time from a check of what is ready to the next wait
    until_check : longest time from the arrival that ends a wait to the check after it
    until_timeout : longest time from a check to the next one, with the whole timeout between them; None if it is not bounded
    age : greatest age of the receive backlog
    gaps : greatest distances of messages that come for certain, of some handles of the executor
    is_alone : whether the executor has no other handle, and its waits cannot time out while they answer what comes before a message
    idle : longest cycle without a callback; None if each cycle can have one
    room : most messages that can be stored for the handle; None if nothing limits them
    """

    events: EventModel
    until_wait: Time
    until_check: Time
    until_timeout: Time | None
    age: Time
    gaps: Sequence[Time] = ()
    is_alone: bool = False
    idle: Time | None = None
    room: int | None = None

    @property
    def longest(self) -> Storage | None:
        """The longest storage; None if it has no bound."""
        length = self.until_wait + self.until_check
        until_next = [] if self.until_timeout is None else [self.until_timeout]
        # Distances of periodic events grow by the same, so that the condition holds for all m if it does for one.
        is_drained = self.events.delta_min(2) > length
        if self.is_alone and self.idle is not None and self.events.delta_min(2) > self.idle + length:
            why = "what is ready was fixed just before; publications store no message for it, as each arrives after the wait has begun"
            return Storage(most=length, why=why, is_stored=False)
        if is_drained and self.is_alone:
            until_next += self.gaps
            why = "a message that is stored is taken when the next one arrives, or the wait times out"
            return Storage(most=max(length, min(until_next) + self.until_check), why=why) if until_next else None
        until_next += [length + gap for gap in self.gaps]
        count = _stored(self.events, self.age, length) if is_drained else self.room
        if count is None or not until_next:
            return None
        why = f"up to {count} are stored for it, each of which is taken when another message arrives, or a wait times out"
        return Storage(most=self.age + self.until_check + count * min(until_next), why=why)


def storage_of(handle: Handle, cycle: Cycle, extra_jitter: Mapping[str, Time | None]) -> Storage | None:
    """How long a message of a handle can be stored; None if that has no bound, or depends on other executors or a trigger condition."""
    executor, until_wait, until_check, age = cycle.executor, cycle.until_wait, cycle.until_check, cycle.greatest_age
    if until_wait is None or until_check is None or age is None or not _is_taken_in_each_iteration(handle, cycle):
        return None
    try:
        events = arrivals(handle, extra_jitter)
    except UnknownError:
        return None
    gaps = tuple(_gaps(cycle, extra_jitter))
    if gaps:
        cycle.solved.context.notes.assume(ASSUMPTION)
    return StorageConditions(
        events=events,
        until_wait=until_wait,
        until_check=until_check,
        until_timeout=cycle.longest_with(longest_wait(executor)),
        age=age,
        gaps=gaps,
        is_alone=executor.handles == (handle,) and until_check < longest_wait(executor),
        idle=None if handle.always else cycle.longest_without_call,
        room=min((limit for limit in (handle.depth, executor.waiting.slots) if limit is not None), default=None),
    ).longest


def _is_taken_in_each_iteration(handle: Handle, cycle: Cycle) -> bool:
    """Whether each iteration takes a message of a handle while any is stored, and only waits for messages on wires."""
    executor, executors = cycle.executor, cycle.solved.context.system.executors
    return (
        len(sharing(executor, executors)) == 1
        and not can_defer(executor)
        and executor.waiting.messages_per_wait == 1
        and handle.sources == 1
        and all(each.transmission is not None for each in messages(executor))
    )


def _stored(events: EventModel, age: Time, length: Time) -> int | None:
    """The most messages that are stored when a wait blocks."""
    most = 1
    for count in range(_MAX_ITERATIONS):
        arrived = events.eta_plus(age + (count + 1) * length + 1)
        most = max(most, arrived - count)
        if arrived <= count + 1:
            return most
    return None


def _gaps(cycle: Cycle, extra_jitter: Mapping[str, Time | None]) -> Iterator[Time]:
    """The greatest distances of messages that come for certain, by handles."""
    for handle in messages(cycle.executor):
        if arrives_regularly(handle, cycle.solved.context.system):
            with suppress(UnknownError):
                events = arrivals(handle, extra_jitter)
                yield max(events.period, handle.phase or 0) + events.jitter
