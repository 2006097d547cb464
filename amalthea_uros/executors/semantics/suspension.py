"""How long a callback is suspended while it publishes, and how long its executor waits for the session that it shares.

A publication that waits for its acknowledgement runs the session until the message is acknowledged, or until its timeout has passed
(micro-ROS/rmw_microxrcedds, src/rmw_publish.c): by default after 1 s. The timeout begins when the driver has the message.

With several threads, the one that waits for input holds the mutex of the session and of the transport for the rest of its timeout;
others can neither receive nor publish meanwhile (eProsima/Micro-XRCE-DDS-Client#311).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from amalthea_uros.perf.executors import Handle, Publication
from amalthea_uros.perf.network import Span
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
