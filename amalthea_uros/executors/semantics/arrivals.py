"""When the messages of a handle arrive at the controller."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.semantics.readiness import messages
from amalthea_uros.perf.executors import Executor, Handle
from amalthea_uros.timing.event_models import EventModel, PeriodicEvents, SporadicEvents
from amalthea_uros.units import Time


def arrivals(handle: Handle, extra_jitter: Mapping[str, Time | None]) -> EventModel:
    """The event model of the messages of a handle.

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


def certain_rate(executor: Executor) -> Fraction:
    """How many messages per time arrive at an executor for certain: those that are periodic."""
    periods = (handle.interval for handle in messages(executor) if handle.is_periodic)
    return sum((Fraction(1, period) for period in periods if period), Fraction(0))
