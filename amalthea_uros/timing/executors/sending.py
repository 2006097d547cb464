"""How long a callback is suspended while it publishes.

A publication that waits for its acknowledgement runs the session until the message is acknowledged, or until its timeout has passed,
after which it gives up (micro-ROS/rmw_microxrcedds, src/rmw_publish.c): by default after 1 s. The timeout begins when the driver has
the message.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from amalthea_uros.perf.executors import Handle, Publication
from amalthea_uros.perf.network import Span
from amalthea_uros.perf.system import System
from amalthea_uros.units import Time, time_text


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


def suspension_of(handle: Handle, system: System, sending: Mapping[str, Span], held: Time | None) -> Suspension:
    """The suspension of a callback by its publications.

    Parameters
    ----------
    sending : times from the call of publish to its return, besides its execution, by the names of transmissions
    held : how long others can keep the session; 0 if nobody does
    """
    return together([_of(publication, system, sending, held) for publication in handle.publications])


def together(parts: list[Suspension]) -> Suspension:
    """Several suspensions, one after the other."""
    most = [part.most for part in parts]
    return Suspension(
        least=sum(part.least for part in parts),
        most=None if None in most else sum(each for each in most if each is not None),
        times=sum(part.times for part in parts),
        why="; ".join(dict.fromkeys(part.why for part in parts if part.why)),
    )


def _of(publication: Publication, system: System, sending: Mapping[str, Span], held: Time | None) -> Suspension:
    stated = sending.get(publication.transmission or "")
    span = stated or _unstated(publication, system)
    if stated is not None and stated.most is None:
        why = _unbounded(publication)
    elif span.most is None and publication.waits:
        span, why = _gives_up(publication, span, system)
    else:
        why = f"publish of {publication.topic} waits until it is acknowledged" if publication.waits else ""
    if span.most is None or held is None:
        return Suspension(least=span.least, most=None, times=1, why=why or f"sending {publication.topic} takes an unknown time")
    if held:
        why = why or f"publish of {publication.topic} waits for the session"
    return Suspension(least=span.least, most=span.most + held, times=1 if span.most + held else 0, why=why)


def _unstated(publication: Publication, system: System) -> Span:
    """The time of a publication of which nothing is given: of one that does not wait, what its driver takes."""
    if publication.waits:
        return Span()
    transmission = system.transmissions.get(publication.transmission or "")
    return Span(most=0) if transmission is None else transmission.driver


def _unbounded(publication: Publication) -> str:
    """Why a publication has no bound, if not even the time until it gives up is known, which begins when it is written."""
    if publication.waits and publication.timeout is None:
        return f"publish of {publication.topic} waits for its acknowledgement without a timeout"
    also = ", or what it writes while it waits," if publication.waits else ""
    return f"how long {publication.transmission!r}{also} takes to be written has no bound"


def _gives_up(publication: Publication, span: Span, system: System) -> tuple[Span, str]:
    """The time until a publication gives up."""
    if publication.timeout is None:
        return span, f"publish of {publication.topic} waits for its acknowledgement without a timeout"
    transmission = system.transmissions.get(publication.transmission or "")
    driver = 0 if transmission is None else transmission.driver.most
    most = None if driver is None else driver + publication.timeout
    why = f"publish of {publication.topic} waits for its acknowledgement, and gives up after {time_text(publication.timeout)}"
    return Span(least=span.least, most=most), why
