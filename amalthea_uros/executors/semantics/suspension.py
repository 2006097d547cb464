"""How long a thread is suspended: by what its callbacks publish, by the session that it shares, and by what it writes while it reads.

A publication that waits for its acknowledgement runs the session until the message is acknowledged, or until its timeout has passed
(micro-ROS/rmw_microxrcedds, src/rmw_publish.c): by default after 1 s. The timeout begins when the driver has the message.

With several threads, the one that waits for input holds the mutex of the session and of the transport for the rest of its timeout;
others can neither receive nor publish meanwhile (eProsima/Micro-XRCE-DDS-Client#311).

While it reads, the client answers each part of a reliable message and each heartbeat as soon as it has read it, before the wait goes on
or ends (`read_stream`, `read_submessage_heartbeat`), and while something that it has sent is not acknowledged, it writes heartbeats of
its own (`listen_message_reliably`; all in src/c/core/session/session.c of eProsima/Micro-XRCE-DDS-Client). It writes these as any other
message: until the last byte is on the wire at most. How much longer a wait of an iteration becomes:

- If data are unread when it begins, it reads what lies before them, and the first of them (`uxr_run_session_until_data`): at most all
  heartbeats that are unread then, and the parts of one message.
- If not, it answers the heartbeats that are unread, and ends at its timeout, which includes all that it writes meanwhile, besides the
  answer to what it read last.

So it answers those unread, one more heartbeat, and one message.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros.executors.semantics.loops import longest_wait
from amalthea_uros.executors.semantics.losses import parts
from amalthea_uros.executors.semantics.readiness import messages, other_threads
from amalthea_uros.perf.executors import Executor, Handle, Publication
from amalthea_uros.perf.network import Direction, Purpose, Span, Transmission
from amalthea_uros.perf.system import System
from amalthea_uros.units import Time, time_text

SESSION_ASSUMPTION = (
    "threads get the mutex of a session in the order in which they ask for it, and execute at once while they hold it"
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Suspension:
    """How long a thread does not execute, although it is not finished.

    Attributes
    ----------
    most : None if it is not known
    times : how often it can be suspended
    why : what it waits for
    """

    least: Time = 0
    most: Time | None = 0
    times: int = 0
    why: str = ""


#: No suspension.
NONE = Suspension()


def in_sequence(suspensions: Sequence[Suspension]) -> Suspension:
    """Several suspensions, one after the other."""
    most = [each.most for each in suspensions]
    return Suspension(
        least=sum(each.least for each in suspensions),
        most=None if None in most else sum(filter(None, most)),
        times=sum(each.times for each in suspensions),
        why=_reasons(suspensions),
    )


def longest_of(suspensions: Sequence[Suspension]) -> Suspension:
    """A suspension that bounds each of several ones that exclude each other."""
    most = [each.most for each in suspensions]
    return Suspension(
        most=None if None in most else max(filter(None, most), default=0),
        times=max((each.times for each in suspensions), default=0),
        why=_reasons(suspensions),
    )


def _reasons(suspensions: Sequence[Suspension]) -> str:
    return "; ".join(dict.fromkeys(each.why for each in suspensions if each.why))


def suspension_of(handle: Handle, system: System, sending: Mapping[str, Span], session_wait: Time | None) -> Suspension:
    """The suspension of a callback by its publications.

    Parameters
    ----------
    sending : times from the call of publish to its return, besides its execution, by the names of transmissions
    session_wait : how long other threads can keep the session; 0 if nobody does, None if it has no bound
    """
    return in_sequence([_of(publication, system, sending, session_wait) for publication in handle.publications])


def _of(publication: Publication, system: System, sending: Mapping[str, Span], session_wait: Time | None) -> Suspension:
    stated = sending.get(publication.transmission or "")
    span = stated or _unstated(publication, system)
    if publication.waits and not publication.reliable:
        # The answer to an earlier question, which came too late for it, is one to this question, too.
        span = Span(most=span.most)
    if stated is not None and stated.most is None:
        why = _unbounded(publication)
    elif span.most is None and publication.waits:
        span, why = _until_timeout(publication, span, system)
    else:
        why = f"publish of {publication.topic} waits until it is acknowledged" if publication.waits else ""
    if span.most is None or session_wait is None:
        return Suspension(least=span.least, most=None, times=1, why=why or f"sending {publication.topic} takes an unknown time")
    if session_wait:
        why = why or f"publish of {publication.topic} waits for the session"
    most = span.most + session_wait
    return Suspension(least=span.least, most=most, times=1 if most else 0, why=why)


def _unstated(publication: Publication, system: System) -> Span:
    """The time of a publication of which nothing is given: of one that does not wait, what its driver takes."""
    if publication.waits:
        return Span()
    transmission = system.transmissions.get(publication.transmission or "")
    return Span(most=0) if transmission is None else transmission.driver


def _unbounded(publication: Publication) -> str:
    """Why a publication has no bound, if not even the time until its timeout is known, which begins when it is written."""
    if publication.waits and publication.timeout is None:
        return f"publish of {publication.topic} waits for its acknowledgement without a timeout"
    also = ", or what it writes while it waits," if publication.waits else ""
    return f"how long {publication.transmission!r}{also} takes to be written has no bound"


def _until_timeout(publication: Publication, span: Span, system: System) -> tuple[Span, str]:
    """The time until a publication times out."""
    if publication.timeout is None:
        return span, f"publish of {publication.topic} waits for its acknowledgement without a timeout"
    transmission = system.transmissions.get(publication.transmission or "")
    driver = 0 if transmission is None else transmission.driver.most
    most = None if driver is None else driver + publication.timeout
    why = f"publish of {publication.topic} waits for its acknowledgement, and times out after {time_text(publication.timeout)}"
    return Span(least=span.least, most=most), why


@dataclass(frozen=True, slots=True, kw_only=True)
class ProtocolWrites:
    """How often a wait writes messages that acknowledge no data.

    Attributes
    ----------
    acknowledgements : of heartbeats of the agent; None if that is not known
    heartbeats : of the client; None if that is not known
    again : messages that are sent again; None if that is not known
    """

    acknowledgements: int | None = 1
    heartbeats: int | None = 0
    again: int | None = 0


def acknowledgements(system: System) -> tuple[Transmission, ...]:
    """The acknowledgements that the client sends."""
    return _sent(system, Purpose.ACKNOWLEDGEMENT)


def heartbeats(system: System) -> tuple[Transmission, ...]:
    """The heartbeats that the client sends."""
    return _sent(system, Purpose.HEARTBEAT)


def _sent(system: System, purpose: Purpose) -> tuple[Transmission, ...]:
    return tuple(
        each for each in system.transmissions.values() if each.purpose is purpose and each.direction is Direction.TO_AGENT
    )


def writing_in_wait(executor: Executor, system: System, sending: Mapping[str, Span], writes: ProtocolWrites) -> Suspension:
    """How long a wait is extended by what it writes.

    Parameters
    ----------
    sending : times from the call of write to its return, by the names of transmissions; unknown if it is absent
    """
    if not messages(executor):
        return NONE
    sent = acknowledgements(system)
    of_messages = [_written(each, parts(each, system), sending) for each in sent if each.callback is not None]
    of_heartbeats = [_written(each, writes.acknowledgements, sending) for each in sent if each.callback is None]
    own = [_written(each, writes.heartbeats, sending) for each in heartbeats(system)]
    if of_messages and executor.waiting.messages_per_wait != 1:
        return Suspension(most=None, why="a wait acknowledges an unknown number of messages")
    return in_sequence([*of_heartbeats, *own, *_longest(of_messages)])


def _written(message: Transmission, times: int | None, sending: Mapping[str, Span]) -> Suspension:
    if not times and times is not None:
        return NONE
    most = sending.get(message.name, Span()).most
    if most is None:
        return Suspension(most=None, times=times or 1, why=f"the time to write {message.name!r} has no bound")
    if times is None:
        return Suspension(most=None, times=1, why=f"the number of times that a wait writes {message.name!r} has no bound")
    return Suspension(most=times * most, times=times, why="it acknowledges reliable messages and heartbeats as it reads them")


def _longest(suspensions: list[Suspension]) -> list[Suspension]:
    """That of the message that takes longest, as a wait reads one; the first one that has no bound."""
    unbounded = [each for each in suspensions if each.most is None]
    return unbounded[:1] or sorted(suspensions, key=lambda each: (each.most or 0, each.times))[-1:]


def session_wait(executor: Executor, system: System, sending: Mapping[str, Span], writes: ProtocolWrites) -> Time | None:
    """How long the other executors of its session can keep it from an executor that asks for it; None if that is not known.

    Operating systems give a mutex to the waiting thread of the highest priority. One other thread that precedes has to ask again after
    it has had it, and comes later; two of them can hand it to each other without end.
    """
    others = other_threads(executor, system.executors) if executor.session is not None else ()
    if len(_preceding_threads(executor, others, system)) > 1:
        return None
    total: Time = 0
    for other in others:
        reading = writing_in_wait(other, system, sending, writes).most
        publishing = [suspension_of(handle, system, sending, 0).most for handle in other.handles]
        if reading is None or None in publishing:
            return None
        total += max(longest_wait(other) + reading, *filter(None, publishing), 0)
    return total


def _preceding_threads(executor: Executor, others: Sequence[Executor], system: System) -> set[str]:
    """The threads of other executors that may get a mutex for which that of an executor waits, too; of unknown priority, all may."""
    priorities = {each.task: each.priority for each in system.mapping.tasks}
    own, found = priorities.get(executor.task), set[str]()
    for other in others:
        priority = priorities.get(other.task)
        if own is None or priority is None or priority >= own:
            found.add(other.name if other.place is None else other.place.thread)
    return found
