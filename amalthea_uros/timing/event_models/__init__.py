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
    Conditional,
    Curve,
    Pattern,
    Periodic,
    Single,
    Sporadic,
    can_be_dense,
    is_strictly_periodic,
)

__all__ = [
    "NEVER",
    "AggregatedEventModel",
    "Conditional",
    "Curve",
    "Delayed",
    "Downsampled",
    "EventModel",
    "Multiplied",
    "OutputEventModel",
    "Pattern",
    "Periodic",
    "Rescaled",
    "Single",
    "Sporadic",
    "Thinned",
    "aggregated",
    "can_be_dense",
    "is_strictly_periodic",
    "rescaled",
    "thinned",
]
