"""What a simulation run is asked for."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum
from typing import TYPE_CHECKING

from amalthea_uros._internal.one_or_several import one_or_several
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.timing.basics.stated_times import TimeLike, kept_time
from amalthea_uros.units import Time

#: Among `Options.labels`: all labels.
ALL_LABELS = "all"


class SimulationMode(StrEnum):
    """How values that vary are chosen.

    `SAMPLED` draws each from its distribution. The others always take the same one: `WORST` the longest demand and the shortest
    distance of sporadic activations, `BEST` the contrary, `AVERAGE` the means. None of them is a bound of what can occur.
    """

    SAMPLED = "sampled"
    WORST = "worst"
    BEST = "best"
    AVERAGE = "average"


#: The public name.
Mode = SimulationMode


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """What a simulation run is asked for.

    Attributes
    ----------
    duration : model time, from 0; at its end the run stops. A text such as "10 s" or a `Duration`, which a time of a result
        becomes by `Duration(time)`
    seed : of all random values; runs with the same seed are equal on every machine
    settings : as of an analysis
    traced : the part of the model time of which events are recorded; None: nothing is
    labels : whose accesses and ages of values are observed; ALL_LABELS: of all labels
    """

    duration: Time
    seed: int = 1
    mode: SimulationMode = SimulationMode.SAMPLED
    settings: Settings = field(default_factory=Settings)
    traced: tuple[Time, Time] | None = None
    labels: tuple[str, ...] = ()

    if TYPE_CHECKING:  # times may be stated in other ways than they are kept

        def __init__(
            self,
            *,
            duration: TimeLike,
            seed: int = 1,
            mode: SimulationMode = SimulationMode.SAMPLED,
            settings: Settings = ...,
            traced: tuple[TimeLike, TimeLike] | None = None,
            labels: Iterable[str] = (),
        ) -> None: ...

    def __post_init__(self) -> None:
        object.__setattr__(self, "duration", kept_time("the duration", self.duration))
        if self.traced is not None:
            ends = (kept_time(f"the {end} of the trace", time) for end, time in zip(("begin", "end"), self.traced, strict=True))
            object.__setattr__(self, "traced", tuple(ends))
        object.__setattr__(self, "labels", one_or_several(self.labels))
        if self.duration <= 0:
            raise InvalidArgumentError("the duration of a simulation must be greater than zero")
        if self.seed < 0:
            raise InvalidArgumentError("the seed of a simulation must not be negative")

    def watched_labels(self, system: System) -> tuple[str, ...]:
        """The names of the labels that are observed in a system."""
        return tuple(system.labels) if ALL_LABELS in self.labels else self.labels
