"""The ages of the values that are read from labels."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.judge.evidence import ObservedValues
from amalthea_uros.judge.limits import limits_of
from amalthea_uros.perf.constraints import DataAgeConstraint
from amalthea_uros.simulate.limited_values import LimitedQuantity
from amalthea_uros.simulate.metrics.distributions import Distributions
from amalthea_uros.simulate.metrics.extremes import Extremes
from amalthea_uros.simulate.metrics.label_values import LabelValues, Reading
from amalthea_uros.simulate.results import LabelObservation

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Numbers = NDArray[np.int64]


@dataclass(slots=True)
class DataAges:
    """The ages of what a runnable has written to a label, at each read of another process.

    The age in cycles is the number of activations of the writing process since it wrote.

    Attributes
    ----------
    base : time units in a picosecond
    """

    constraint: DataAgeConstraint
    base: int
    times: dict[str, Extremes] = field(default_factory=dict)
    cycles: dict[str, Extremes] = field(default_factory=dict)

    def add(self, readings: Sequence[Reading]) -> None:
        """Take reads of the label in."""
        found: dict[str, list[tuple[int, int, int]]] = {}
        for reading in readings:
            value, process = reading.value, reading.source.process
            if value is not None and process is not None and self._is_limited(reading):
                age = reading.time - value.time, reading.activations - value.activations, reading.time
                found.setdefault(process, []).append(age)
        for process, ages in found.items():
            time, cycles, at = np.array(ages, np.int64).T
            self.times.setdefault(process, Extremes(self.base)).add(time, at)
            self.cycles.setdefault(process, Extremes(self.base)).add(cycles * self.base, at)

    def _is_limited(self, reading: Reading) -> bool:
        writer = reading.value.writer if reading.value is not None else None
        return writer is not None and writer.runnable == self.constraint.runnable and writer.process != reading.source.process

    def quantities(self, _end: int) -> Iterator[LimitedQuantity]:
        """What was observed."""
        missing = ObservedValues(reason=f"no other process read what {self.constraint.runnable!r} writes")
        for limit in limits_of(self.constraint):
            ages = self.times if limit.is_time else self.cycles
            for process in sorted(ages):
                here = replace(limit, object=f"{limit.object} in {process}")
                yield LimitedQuantity(here, ages[process].limited(""))
            if not ages:
                yield LimitedQuantity(limit, missing)


@dataclass(slots=True)
class LabelAges:
    """The ages of the values of a label at each read.

    Attributes
    ----------
    base : time units in a picosecond
    unwritten : number of reads of a label to which nobody had written
    """

    label: str
    base: int
    unwritten: int = 0
    _ages: Distributions = field(init=False)

    def __post_init__(self) -> None:
        self._ages = Distributions(size=1, base=self.base, with_histograms=(0,))

    def add(self, readings: Sequence[Reading]) -> None:
        """Take reads of the label in."""
        ages = [(each.time - each.value.time, each.time) for each in readings if each.value is not None]
        self.unwritten += len(readings) - len(ages)
        found = np.array(ages, np.int64).reshape(-1, 2)
        self._ages.add(found[:, :1].T, np.arange(len(found)) + self._ages.count, found[:, 1])

    def observation(self, values: LabelValues) -> LabelObservation:
        """What was observed."""
        return LabelObservation(
            name=self.label,
            reads=values.reads[self.label],
            writes=values.writes[self.label],
            unwritten_reads=self.unwritten,
            overwritten=values.overwritten[self.label],
            age=self._ages.observation(0),
        )
