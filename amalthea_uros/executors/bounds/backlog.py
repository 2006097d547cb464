"""How long a message can wait unread in the buffer of the transport, and so how many can.

The buffer is first in, first out, and each wait reads at least one message if any is there: data, a part of them, a heartbeat or an
acknowledgement (`listen_message` in src/c/core/session/session.c of eProsima/Micro-XRCE-DDS-Client; with a timeout of less than 1 ms
it looks only once). Let u be the last time at which nothing was unread. While something is, waits end at once, so that the k-th of
them since u is at most k cycles L after it, and

    unread just before it  <=  eta(k L) - (k - 1)

with the most arrivals eta in such a window; nothing is unread after it if eta(k L) <= k, and it begins anew.

Publications that wait read all messages up to their acknowledgement. It is read by them, and does not add to the others, unless they
can time out before it comes. If they cannot, nothing is unread that arrived before it, and u begins anew: so the cycles after the
first one contain no such publication, and take at most M instead of L. So at most N = max over k of eta(L + (k - 1) M) - (k - 1) are
unread, unless such a publication of the running cycle is still to read them, at most L later. What arrives is read at most
L + (N - 1) M later, or in a cycle before that, by its publication: Q = 2 L + (N - 2) M, or L if N = 1. At any time, the unread
messages of a kind are those that came in the last Q, at most its eta(Q).

L contains the times of publications and of acknowledgements, which contain the unread messages. That the least solution of these
equations holds is shown by induction over time: until some time was longer than in it, no cycle was longer than L, so that no more
messages were unread than counted, and this time was not longer either. Nothing is unread when the first iteration begins.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros.executors.bounds.sequences import CycleSequence
from amalthea_uros.executors.bounds.solved_system import SolvedSystem
from amalthea_uros.executors.bounds.transmissions import received, variation
from amalthea_uros.executors.semantics.losses import parts, publications, recovers
from amalthea_uros.executors.semantics.suspension import acknowledgements, heartbeats
from amalthea_uros.perf.executors import Publication
from amalthea_uros.perf.network import Direction, Purpose, Span, Transmission
from amalthea_uros.perf.system import System
from amalthea_uros.timing.event_models.derived import Delayed, Multiplied
from amalthea_uros.timing.event_models.models import EventModel
from amalthea_uros.units import Time

#: More unread messages are considered unbounded: iterations are then hardly faster than messages.
MAX_BACKLOG = 10_000
#: Heartbeats that can be due besides those at intervals: when a timeout begins, and when its last reading does.
DUE = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class Arriving:
    """Messages of a kind as they become visible to the client.

    Attributes
    ----------
    jitter : by which they vary after they were queued on their wire
    parts : of each of them, read one by one
    """

    events: EventModel
    jitter: Time
    parts: int = 1

    @property
    def as_events(self) -> EventModel:
        """Each of its parts as an event."""
        found = Delayed(self.events, self.jitter + 1)
        return found if self.parts == 1 else Multiplied(found, self.parts)

    def most(self, window: Time) -> int:
        """The most that arrive in a time, its ends included."""
        return self.parts * self.events.eta_plus(window + self.jitter + 1)


def arriving(message: Transmission, solved: SolvedSystem, parts: int = 1) -> Arriving | None:
    """The arrivals of a message; None if they are unknown."""
    events, jitter = solved.event_models.get(message.name), variation(list(received(message, solved)))
    return None if events is None or jitter is None else Arriving(events=events, jitter=jitter, parts=parts)


def acknowledged(solved: SolvedSystem) -> Mapping[str, Arriving | None]:
    """What the client acknowledges, by the names of the acknowledgements; None if its arrivals are unknown."""
    system = solved.context.system
    found: dict[str, Arriving | None] = {}
    for each in acknowledgements(system):
        message = system.transmissions.get(each.acknowledges or "")
        found[each.name] = None if message is None else arriving(message, solved, parts(each, system))
    return found


def backlog_age(
    cycle: Time | None,
    further: CycleSequence | None,
    sending: Mapping[str, Span],
    solved: SolvedSystem,
    *,
    reads_on: bool = False,
) -> Time | None:
    """The greatest age of an unread message; None if there is no bound.

    Parameters
    ----------
    cycle : longest cycle without a wait; None if it has no bound
    further : those after it, in which no publication reads until its acknowledgement
    reads_on : whether each wait reads on until it has data, or the backlog is empty: then only data take waits of their own
    """
    if cycle is None or further is None:
        return None
    read = _read_in_iterations(sending, solved)
    kinds = [found for message, found in read if not reads_on or message.purpose is Purpose.DATA]
    known = [each for each in kinds if each is not None]
    if len(known) < len(kinds):
        return None
    most = max_backlog(known, cycle, further)
    if most is not None and reads_on:
        # What comes after the last of them is read in one more wait.
        most += 1
    if most is None or most == 1:
        return most and cycle
    return 2 * cycle + further.time(most - 2)


def max_backlog(kinds: Sequence[Arriving], cycle: Time, further: CycleSequence) -> int | None:
    """The most messages that can be unread; None if there is no bound.

    Parameters
    ----------
    cycle, further : see `backlog_age`
    """
    if sum(each.parts * each.events.rate for each in kinds) * further.average >= 1:
        return None
    most = 1
    for count in range(1, MAX_BACKLOG):
        arrived = sum(each.most(cycle + further.time(count - 1)) for each in kinds)
        most = max(most, arrived - count + 1)
        if arrived <= count:
            return most
    return None


def reads_all(publication: Publication, sending: Mapping[str, Span], system: System) -> bool:
    """Whether nothing is unread at some time of a publication, or when its acknowledgement has come; see `recovery`."""
    return (publication.waits and not times_out(publication, sending)) or recovers(publication, system)


def times_out(publication: Publication, sending: Mapping[str, Span]) -> bool:
    """Whether a publication can end before it is acknowledged; its timeout begins after it is written."""
    most = sending.get(publication.transmission or "", Span()).most
    return not publication.waits or most is None or publication.timeout is None or most > publication.timeout


def asks_again(publication: Publication, sending: Mapping[str, Span]) -> bool:
    """Whether what a question waits for can come later than its first attempt ends."""
    most, once = sending.get(publication.transmission or "", Span()).most, (publication.timeout or 0) // publication.attempts
    return most is None or most > once


def has_unacknowledged(sending: Mapping[str, Span], solved: SolvedSystem) -> bool:
    """Whether something can be sent and not be acknowledged when an iteration or a publication begins."""
    return any(each.reliable and times_out(each, sending) for each in publications(solved.context.system))


def max_heartbeats(timeout: Time, solved: SolvedSystem) -> int | None:
    """The most heartbeats that the client writes before a timeout ends; None if that is unknown.

    They follow at intervals: of the clock until the last reading, and of its own timeout in that.
    """
    intervals = _intervals(solved)
    return sum(DUE + timeout // each for each in intervals if each) if all(intervals) else None


def _intervals(solved: SolvedSystem) -> list[Time | None]:
    """The intervals of the heartbeats of the client."""
    events = [solved.event_models.get(each.name) for each in heartbeats(solved.context.system)]
    return [None if each is None else each.delta_min(2) for each in events]


def protocol_overhead(sending: Mapping[str, Span], solved: SolvedSystem) -> list[Arriving | None]:
    """The acknowledgements and heartbeats that waits of iterations can read; None for one whose arrivals are unknown."""
    return [found for each, found in _read_in_iterations(sending, solved) if each.purpose is not Purpose.DATA]


def _read_in_iterations(sending: Mapping[str, Span], solved: SolvedSystem) -> Iterator[tuple[Transmission, Arriving | None]]:
    system = solved.context.system
    read_before = {each.acknowledgement for each in publications(system) if not times_out(each, sending)}
    by_message = {system.transmissions[name].acknowledges: each for name, each in acknowledged(solved).items()}
    own_heartbeats = {each.name for each in heartbeats(system)}
    # Each publication ends before the first heartbeat, which follows an interval after its message.
    times = [sending.get(each.transmission or "", Span()).most for each in publications(system) if each.reliable]
    longest = None if None in times else max(filter(None, times), default=0)
    is_silent = not has_unacknowledged(sending, solved) and all(
        each and longest is not None and each > longest for each in _intervals(solved)
    )
    for each in system.transmissions.values():
        if each.direction is Direction.TO_AGENT or each.purpose is Purpose.FOREIGN or each.name in read_before:
            continue
        if not is_silent or each.acknowledges not in own_heartbeats:
            yield each, by_message[each.name] if each.name in by_message else arriving(each, solved)
