"""How many cycles pass until a message is served.

Messages wait first in first out in the buffer of the transport, and a wait takes one of them, so that an iteration serves one. Let a
busy period begin when a message arrives and no other one waits. The running cycle ends at most one cycle L later, and each following
one takes one message as long as any waits. So the n-th message of the busy period is ready at most n L after its beginning; it arrives
no earlier than delta-(n) of all messages of the executor, and the busy period goes on as long as the next one arrives before.

If messages can be stored before the iteration that takes them, they do not end the wait: each cycle can wait for W before it looks at
them. The count remains the same, because each cycle serves one message that came before, or the one in question: one of the handle of
the message that the wait took, or, if it took none, the oldest of its handle. If a wait takes all messages that are there, only those
of the same handle delay each other.

A wait that cannot wait any longer reads only what comes first: when a timer is due or nearly due, the timeout is cut to 0, and answers
that are written while it reads use it up. That can also be an acknowledgement, a heartbeat, or a part of a message (`backlog`), so that
these count like messages.

Executors of one session read from the same buffer: the messages of the others are also before it, and what the others read only makes
it earlier.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.bounds.backlog import protocol_overhead
from amalthea_uros.executors.bounds.cycle import Cycle
from amalthea_uros.executors.bounds.sent_again import repeated
from amalthea_uros.executors.bounds.sequences import CycleSequence
from amalthea_uros.executors.bounds.transmissions import received, variation
from amalthea_uros.executors.semantics.losses import parts
from amalthea_uros.executors.semantics.readiness import arrivals, certain_rate, messages, sharing
from amalthea_uros.executors.semantics.suspension import acknowledgements
from amalthea_uros.perf.executors import Handle
from amalthea_uros.perf.network import Direction
from amalthea_uros.timing.event_models.derived import Delayed, Multiplied, aggregated
from amalthea_uros.timing.event_models.models import EventModel
from amalthea_uros.units import SECOND, Time

#: A busy period with more messages is considered unbounded: iterations are then hardly faster than messages.
MAX_MESSAGES = 10_000


@dataclass(frozen=True, slots=True, kw_only=True)
class Delay:
    """The longest delay until a message is ready.

    Attributes
    ----------
    cycles : None if there is no bound, for the `reason`
    time : of these cycles
    earlier : by how much it arrives after the first message of the busy period
    is_overload : whether messages arrive faster than iterations can serve them, for certain
    """

    cycles: int | None
    time: Time = 0
    earlier: Time = 0
    reason: str = ""
    is_overload: bool = False


def competing(handle: Handle, cycle: Cycle, extra_jitter: Mapping[str, Time | None]) -> EventModel:
    """The messages that can be served before one of a handle, with those of the handle.

    Raises
    ------
    UnknownError : it is unknown how many there are.
    """
    if cycle.executor.waiting.messages_per_wait is None:
        return arrivals(handle, extra_jitter)
    # All executors of a session read from the same buffer.
    executors = sharing(cycle.executor, cycle.solved.context.system.executors)
    handles = [each for executor in executors for each in messages(executor)]
    data = [_parts(each, arrivals(each, extra_jitter), cycle) for each in handles]
    overhead = protocol_overhead(cycle.sending, cycle.solved)
    known = [each.as_events for each in overhead if each is not None]
    if len(known) < len(overhead):
        raise UnknownError("how many acknowledgements and heartbeats arrive is not known")
    return aggregated((*data, *known, *_without_message(cycle)))


def _without_message(cycle: Cycle) -> list[EventModel]:
    """Items that a wait can read without getting a message: those that are sent again, or wait for a missing one."""
    again = repeated(Direction.TO_CONTROLLER, cycle.solved)
    jitters = [variation(list(received(each, cycle.solved))) for each in again]
    if None in jitters:
        raise UnknownError("how late a message is that is sent again is not known")
    return [Delayed(each, max(filter(None, jitters), default=Time(0)) + 1) for each in list(again.values())[:1]]


def _parts(handle: Handle, events: EventModel, cycle: Cycle) -> EventModel:
    """The messages of a handle, with all parts of each."""
    system = cycle.solved.context.system
    count = next((parts(each, system) for each in acknowledgements(system) if each.callback == handle.name), 1)
    return events if count == 1 else Multiplied(events, count)


def delay_of(handle: Handle, cycle: Cycle, cycles: CycleSequence, extra_jitter: Mapping[str, Time | None]) -> Delay:
    """The longest delay of a message until it is ready.

    Parameters
    ----------
    cycles : with the wait if it does not end for messages that are stored
    """
    overload = certain_overload(cycle)
    if overload is not None:
        return overload
    try:
        events = competing(handle, cycle, extra_jitter)
    except UnknownError as error:
        return Delay(cycles=None, reason=str(error))
    if events.rate * cycles.average >= 1:
        rate, served = _per_second(events.rate), _per_second(1 / cycles.average)
        return Delay(cycles=None, reason=f"{rate} messages/s arrive, and iterations may serve only {served} per second")
    worst, found, count = Time(-1), Delay(cycles=1), 0
    while count < MAX_MESSAGES:
        count += 1
        arrival, time = events.delta_min(count), cycles.time(count)
        if time - arrival > worst:
            worst, found = time - arrival, Delay(cycles=count, time=time, earlier=arrival)
        if events.delta_min(count + 1) > time:
            return found
    return Delay(
        cycles=None, reason=f"more than {MAX_MESSAGES:,} messages can wait: iterations are hardly faster than messages"
    )


def certain_overload(cycle: Cycle) -> Delay | None:
    """The overload by messages of which it is certain that they arrive faster than iterations serve them; None if there is none.

    It depends on no jitter: that of periodic messages does not change their rate.
    """
    rate, most = certain_rate(cycle.executor, cycle.solved.context.system), cycle.most_served
    if most is None or rate * cycle.shortest_with_message <= most:
        return None
    served = _per_second(Fraction(most, cycle.shortest_with_message))
    reason = (
        f"overload: {_per_second(rate)} messages/s arrive, and iterations serve at most {served} per second, "
        "so that messages wait longer and longer"
    )
    return Delay(cycles=None, reason=reason, is_overload=True)


def _per_second(rate: Fraction) -> str:
    return f"{float(rate * SECOND):.4g}"
