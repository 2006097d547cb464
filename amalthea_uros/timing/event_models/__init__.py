"""Event models: how many events can occur in a window, and how close together they can be."""

from amalthea_uros.timing.event_models.aggregated import (
    AggregatedEventModel,
    Downsampled,
    Multiplied,
    Rescaled,
    Thinned,
    aggregated,
    rescaled,
    thinned,
)
from amalthea_uros.timing.event_models.base import NEVER, EventModel
from amalthea_uros.timing.event_models.burst import Pattern
from amalthea_uros.timing.event_models.curve import Curve
from amalthea_uros.timing.event_models.output import Delayed, OutputEventModel
from amalthea_uros.timing.event_models.periodic import (
    Conditional,
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
