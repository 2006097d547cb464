"""Execution times of a description as demands in ticks of the core that executes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from typing import Any

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.activities import Demand, Execute
from amalthea_uros.perf.distributions import (
    Beta,
    Boundaries,
    Bucket,
    Constant,
    Distribution,
    Gauss,
    Histogram,
    Sampling,
    Statistics,
    Uniform,
    Weibull,
    highest,
)
from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.units import Frequency, Time, down, ticks_of_time, time_text, up
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.assembly.hardware import Controller


def times_of(execution_time: ExecutionTimeSection) -> Distribution[int]:
    """The distribution of an execution time that is not given per platform, in picoseconds."""
    if execution_time.histogram is not None:
        return Histogram(tuple(Bucket(lower=b.min, upper=b.max, occurrences=b.count) for b in execution_time.histogram))
    lower, upper, average = execution_time.min, execution_time.max, execution_time.avg
    assert lower is not None
    assert upper is not None
    match execution_time.distribution:
        case "uniform":
            return Uniform(lower=lower, upper=upper)
        case "gauss":
            assert average is not None
            assert execution_time.deviation is not None
            return Gauss(mean=average, deviation=execution_time.deviation, lower=lower, upper=upper)
        case "beta":
            assert execution_time.alpha is not None
            assert execution_time.beta is not None
            return Beta(alpha=execution_time.alpha, beta=execution_time.beta, lower=lower, upper=upper)
        case "weibull":
            assert average is not None
            return Weibull(lower=lower, average=average, upper=upper, exceeding=execution_time.exceeding or 1.0)
    if average is not None:
        return Statistics(lower=lower, average=average, upper=upper)
    return Constant(lower) if lower == upper else Boundaries(lower=lower, upper=upper, sampling=Sampling.UNIFORM)


#: Values of distributions that are times, with how they are rounded.
_ROUNDED: Mapping[str, Callable[[Fraction], float]] = {
    "value": up,
    "lower": down,
    "upper": up,
    "average": float,
    "mean": float,
    "deviation": float,
}


def in_ticks(times: Distribution[int], frequency: Frequency) -> Distribution[int]:
    """A distribution of times as one of ticks: lower bounds are rounded down, upper bounds and constants up."""
    if isinstance(times, Histogram):
        return Histogram(tuple(replace(bucket, **_ticks_of(bucket, frequency)) for bucket in times.buckets))
    return replace(times, **_ticks_of(times, frequency))


def _ticks_of(times: Distribution[int] | Bucket[int], frequency: Frequency) -> dict[str, Any]:
    stated = {name: value for name in _ROUNDED if (value := getattr(times, name, None)) is not None}
    return {name: _ROUNDED[name](ticks_of_time(1, frequency) * Fraction(value)) for name, value in stated.items()}


@dataclass(frozen=True, slots=True)
class DemandConverter:
    """Converts execution times of a description to demands on the cores of a controller."""

    controller: Controller
    notes: Notes

    def on_platform(self, execution_time: ExecutionTimeSection) -> ExecutionTimeSection | None:
        """The execution time on the platform; None, with a finding, if there is none. Core types are left to `demand`."""
        if execution_time.on is None:
            return execution_time
        named = self.controller.platform
        if named is not None and named in execution_time.on:
            return self.on_platform(execution_time.on[named])
        if "default" in execution_time.on:
            return self.on_platform(execution_time.on["default"])
        target = f"platform {named!r}" if named else "hardware without a platform name"
        choices = f"{named!r} or 'default'" if named else "'default'"
        self.notes.error("APP006", f"no execution time for {target}", execution_time.location(), f"Add {choices} under 'on'.")
        return None

    def _types(self, execution_time: ExecutionTimeSection) -> dict[str, ExecutionTimeSection]:
        types = self.controller.core_types.values()
        return {name: time for name, time in (execution_time.on or {}).items() if name in types}

    def wcet(self, execution_time: ExecutionTimeSection) -> Time:
        """The worst-case execution time on any core; 0 if it is unknown."""
        types = self._types(execution_time)
        times = list(types.values()) if types else filter(None, [self.on_platform(execution_time)])
        return max((highest(times_of(time)) or 0 for time in times), default=0)

    def demand(self, execution_time: ExecutionTimeSection, core: str) -> Demand | None:
        """The demand on a core, by core type if the execution time depends on it; None if it has no value for the core."""
        types = self._types(execution_time)
        if not types:
            times = self.on_platform(execution_time)
            return None if times is None else Demand(self._ticks(times, core))
        cores = {kind: name for name, kind in self.controller.core_types.items()}
        by_type = tuple((kind, self._ticks(time, cores[kind])) for kind, time in types.items())
        default = (execution_time.on or {}).get("default")
        return Demand(None if default is None else self._ticks(default, core), by_type)

    def _ticks(self, execution_time: ExecutionTimeSection, core: str) -> Distribution[int]:
        times, frequency = times_of(execution_time), self.controller.frequencies[core]
        if isinstance(times, Constant):
            self._check_rounding(times.value, core, execution_time.location())
        return in_ticks(times, frequency)

    def _check_rounding(self, time: Time, core: str, location: Location | None) -> None:
        ticks = ticks_of_time(time, self.controller.frequencies[core])
        if ticks.denominator != 1:
            message = f"{time_text(time)} is {float(ticks):.6g} ticks on {core!r}, rounded up to {up(ticks)}"
            self.notes.info("APP007", message, location)

    def execute(
        self, parts: Iterable[ExecutionTimeSection | Time | None], core: str, location: Location | None
    ) -> tuple[Execute, ...]:
        """Computation that consists of parts: the sum of all constant ones first, then the others one by one.

        Parameters
        ----------
        location : of findings about the sum
        """
        constant: Time = 0
        varying: list[Demand] = []
        for part in parts:
            if part is None:
                continue
            if isinstance(part, int):
                constant += part
                continue
            here = None if self._types(part) else self.on_platform(part)
            if here is not None and here.histogram is None and here.min == here.max and here.distribution is None:
                constant += here.min or 0
            elif here is not None or self._types(part):
                demand = self.demand(part, core)
                if demand is not None:
                    varying.append(demand)
        self._check_rounding(constant, core, location)
        fixed = [Demand(in_ticks(Constant(constant), self.controller.frequencies[core]))] if constant else []
        return tuple(Execute(demand=demand) for demand in (*fixed, *varying))
