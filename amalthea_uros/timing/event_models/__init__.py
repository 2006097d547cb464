"""Event models: how many events can occur in a window, and how close together they can be."""

from amalthea_uros.timing.event_models.base import NEVER, EventModel
from amalthea_uros.timing.event_models.derived import (
    AggregatedEventModel,
    Delayed,
    Downsampled,
    Multiplied,
    OutputEventModel,
    Rescaled,
    Thinned,
    aggregated,
    rescaled,
    thinned,
)
from amalthea_uros.timing.event_models.periodic import (
    ConditionalEvents,
    EventPattern,
    MinimumDistances,
    PeriodicEvents,
    SingleEvent,
    SporadicEvents,
    can_be_dense,
    is_strictly_periodic,
)

__all__ = [
    "NEVER",
    "AggregatedEventModel",
    "ConditionalEvents",
    "Delayed",
    "Downsampled",
    "EventModel",
    "EventPattern",
    "MinimumDistances",
    "Multiplied",
    "OutputEventModel",
    "PeriodicEvents",
    "Rescaled",
    "SingleEvent",
    "SporadicEvents",
    "Thinned",
    "aggregated",
    "can_be_dense",
    "is_strictly_periodic",
    "rescaled",
    "thinned",
]
