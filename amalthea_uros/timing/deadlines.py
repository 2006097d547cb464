"""Implicit deadlines: the period of a process for which no deadline is stated (C. L. Liu and J. W. Layland 1973)."""

from __future__ import annotations

from amalthea_uros.timing.event_models import EventModel, Periodic
from amalthea_uros.units import Time

ASSUMPTION = "the deadline of a process without a stated one is its period, or the minimum time between sporadic activations"


def implicit_deadline(events: EventModel) -> Time | None:
    """The period, or the minimum interarrival time of sporadic activations; None for other activations, e.g. triggered ones."""
    return events.period if isinstance(events, Periodic) else None
