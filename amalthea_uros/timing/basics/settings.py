"""Settings of an analysis that replace or add to the values of the system."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from fractions import Fraction
from typing import TYPE_CHECKING

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.activities import Communication
from amalthea_uros.timing.basics.stated_times import TimeLike, kept_time
from amalthea_uros.units import Frequency, Time, parse_frequency


class MemoryModel(StrEnum):
    """Demand of label accesses: none, the latency of each access, or a copy of each label at the start and end of a job."""

    NONE = "none"
    EXPLICIT = "explicit"
    IMPLICIT = "implicit"


@dataclass(frozen=True, slots=True)
class Settings:
    """Settings of an analysis.

    Attributes
    ----------
    frequencies : of cores, instead of those of the system; each a text such as "300 MHz", or a `Fraction` in hertz
    scale : factor on all execution times, like slower clocks
    growth : factor on all worst-case execution times; best cases only decrease, so that the analysis covers all smaller factors
    factors : the same for single processes
    modes : values of mode labels that do not change
    communication : of all label accesses; None: as modelled, implicit by default
    quantile : probability beyond which values of execution times without bounds are taken as impossible, on each side; None: they
        remain unbounded
    phases : times at which what comes from outside, such as messages, is first taken, such as "2 ms"; other phases are as modelled
    """

    frequencies: Mapping[str, Frequency] = field(default_factory=dict)
    scale: Fraction = Fraction(1)
    growth: Fraction = Fraction(1)
    factors: Mapping[str, Fraction] = field(default_factory=dict)
    modes: Mapping[str, str] = field(default_factory=dict)
    memory: MemoryModel = MemoryModel.NONE
    communication: Communication | None = None
    phases: Mapping[str, Time] = field(default_factory=dict)
    quantile: Fraction | None = None

    if TYPE_CHECKING:  # quantities may be stated in other ways than they are kept

        def __init__(
            self,
            frequencies: Mapping[str, Frequency | str] = ...,
            scale: Fraction = ...,
            growth: Fraction = ...,
            factors: Mapping[str, Fraction] = ...,
            modes: Mapping[str, str] = ...,
            memory: MemoryModel = ...,
            communication: Communication | None = ...,
            phases: Mapping[str, TimeLike] = ...,
            quantile: Fraction | None = ...,
        ) -> None: ...

    def __post_init__(self) -> None:
        if not all(isinstance(each, Fraction) for each in self.frequencies.values()):
            object.__setattr__(self, "frequencies", {core: _frequency(core, each) for core, each in self.frequencies.items()})
        if self.phases:
            object.__setattr__(self, "phases", {name: kept_time(name, time) for name, time in self.phases.items()})
        for name, kind in (("memory", MemoryModel), ("communication", Communication)):
            given = getattr(self, name)
            if given is not None and not isinstance(given, kind):
                members = ", ".join(f"{kind.__name__}.{member.name}" for member in kind)
                raise TypeError(f"unknown {name} {given!r}; expected one of {members}")
        for what, number in [("scale", self.scale), *self.frequencies.items()]:
            if number <= 0:
                raise ValueError(f"{what}: {number} is not positive")
        if self.quantile is not None and not 0 < self.quantile < Fraction(1, 2):
            raise ValueError(f"quantile: {self.quantile} is not between 0 and 0.5")
        at_least_0: list[tuple[str, Fraction | int]] = [("growth", self.growth), *self.factors.items(), *self.phases.items()]
        for what, value in at_least_0:
            if value < 0:
                raise ValueError(f"{what}: {value} is negative")


def _frequency(core: str, value: Frequency | str) -> Frequency:
    if isinstance(value, Fraction):
        return value
    if not isinstance(value, str):
        raise InvalidArgumentError(f"{core}: the number {value} has no unit; write a text such as '{value} MHz'")
    try:
        return parse_frequency(value)
    except ValueError as error:
        raise InvalidArgumentError(f"{core}: {error}") from None
