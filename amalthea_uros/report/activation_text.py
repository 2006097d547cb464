"""When stimuli activate, for people."""

from __future__ import annotations

from amalthea_uros.perf.stimuli import (
    ArrivalCurve,
    Burst,
    EventTriggered,
    InterProcess,
    Periodic,
    RelativePeriodic,
    Single,
    Stimulus,
    Synthetic,
    VariableRate,
)
from amalthea_uros.units import time_text

_WORDS: dict[type, str] = {
    RelativePeriodic: "sporadic",
    InterProcess: "triggered",
    EventTriggered: "by events",
    Synthetic: "at listed times",
    VariableRate: "at a variable rate",
    ArrivalCurve: "by an arrival curve",
}


def activation_text(stimulus: Stimulus) -> str:
    """When a stimulus activates, in a few words."""
    match stimulus:
        case Periodic(period=period, offset=offset):
            return f"every {time_text(period)}" + (f" from {time_text(offset)}" if offset else "")
        case Burst(period=period, count=count):
            return f"{count} times every {time_text(period)}"
        case Single(time=time):
            return f"once at {time_text(time)}"
    return _WORDS.get(type(stimulus), "by a custom stimulus")
