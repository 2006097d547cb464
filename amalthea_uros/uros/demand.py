"""Execution times of a description as execution demand in ticks of the core that executes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from amalthea_uros.diagnostics import Location
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
from amalthea_uros.perf.software import Demand, Execute
from amalthea_uros.spec.execution_time import ExecutionTime
from amalthea_uros.units import Frequency, Time, down, ticks_of_time, time_text, up
from amalthea_uros.uros.hardware import Controller
from amalthea_uros.uros.notes import Notes


def times_of(stated: ExecutionTime) -> Distribution[int]:
    """The distribution of an execution time that is not given per platform, in picoseconds."""
    if stated.histogram is not None:
        return Histogram(tuple(Bucket(lower=b.min, upper=b.max, occurrences=b.count) for b in stated.histogram))
    lower, upper, average = stated.min, stated.max, stated.avg
    assert lower is not None
    assert upper is not None
    match stated.distribution:
        case "uniform":
            return Uniform(lower=lower, upper=upper)
        case "gauss":
            assert average is not None
            assert stated.deviation is not None
            return Gauss(mean=average, deviation=stated.deviation, lower=lower, upper=upper)
        case "beta":
            assert stated.alpha is not None
            assert stated.beta is not None
            return Beta(alpha=stated.alpha, beta=stated.beta, lower=lower, upper=upper)
        case "weibull":
            assert average is not None
            return Weibull(lower=lower, average=average, upper=upper, exceeding=stated.exceeding or 1.0)
    if average is not None:
        return Statistics(lower=lower, average=average, upper=upper)
    return Constant(lower) if lower == upper else Boundaries(lower=lower, upper=upper, sampling=Sampling.UNIFORM)


def in_ticks(times: Distribution[int], frequency: Frequency) -> Distribution[int]:
    """A distribution of times as one of ticks: least values are rounded down, greatest values and constants up."""

    def exact(time: float) -> Fraction:
        return ticks_of_time(1, frequency) * Fraction(time)

    def least(time: Time) -> int:
        return down(exact(time))

    def most(time: Time) -> int:
        return up(exact(time))

    def mean(time: float) -> float:
        return float(exact(time))

    match times:
        case Constant(value):
            return Constant(most(value))
        case Histogram(buckets):
            return Histogram(
                tuple(Bucket(lower=least(b.lower), upper=most(b.upper), occurrences=b.occurrences) for b in buckets)
            )
        case Uniform(lower=lower, upper=upper):
            return Uniform(lower=least(lower), upper=most(upper))
        case Boundaries(lower=lower, upper=upper, sampling=sampling):
            return Boundaries(lower=least(lower), upper=most(upper), sampling=sampling)
        case Statistics(lower=lower, average=average, upper=upper):
            return Statistics(lower=least(lower), average=mean(average), upper=most(upper))
        case Weibull(lower=lower, average=average, upper=upper, exceeding=exceeding):
            return Weibull(lower=least(lower), average=mean(average), upper=most(upper), exceeding=exceeding)
        case Beta(alpha=alpha, beta=beta, lower=lower, upper=upper):
            return Beta(alpha=alpha, beta=beta, lower=least(lower), upper=most(upper))
        case Gauss(mean=average, deviation=deviation, lower=low, upper=high):
            return Gauss(
                mean=mean(average),
                deviation=mean(deviation),
                lower=None if low is None else least(low),
                upper=None if high is None else most(high),
            )


@dataclass(frozen=True, slots=True)
class Profile:
    """Execution times as they apply on a controller."""

    controller: Controller
    notes: Notes

    def on_platform(self, stated: ExecutionTime) -> ExecutionTime | None:
        """What applies to the platform; None, with a note, if nothing does. Core types are left to `demand`."""
        if stated.on is None:
            return stated
        named = self.controller.platform
        if named is not None and named in stated.on:
            return self.on_platform(stated.on[named])
        if "default" in stated.on:
            return self.on_platform(stated.on["default"])
        here = f"platform {named!r}" if named else "this hardware, which names no platform"
        message = f"there is no execution time for {here}"
        self.notes.error(
            "APP006", message, stated.location(), f"Add {named or 'default'!r} below 'on', or 'default' for all others."
        )
        return None

    def _types(self, stated: ExecutionTime) -> dict[str, ExecutionTime]:
        types = self.controller.core_types.values()
        return {name: time for name, time in (stated.on or {}).items() if name in types}

    def longest(self, stated: ExecutionTime) -> Time:
        """The worst-case execution time on any core; 0 where it is not known."""
        types = self._types(stated)
        times = list(types.values()) if types else filter(None, [self.on_platform(stated)])
        return max((highest(times_of(time)) or 0 for time in times), default=0)

    def demand(self, stated: ExecutionTime, core: str) -> Demand | None:
        """The demand on a core, or on any core of the types that are named; None if nothing applies."""
        types = self._types(stated)
        if not types:
            times = self.on_platform(stated)
            return None if times is None else Demand(self._ticks(times, core))
        cores = {kind: name for name, kind in self.controller.core_types.items()}
        by_type = tuple((kind, self._ticks(time, cores[kind])) for kind, time in types.items())
        default = (stated.on or {}).get("default")
        return Demand(None if default is None else self._ticks(default, core), by_type)

    def _ticks(self, stated: ExecutionTime, core: str) -> Distribution[int]:
        times, frequency = times_of(stated), self.controller.frequencies[core]
        if isinstance(times, Constant):
            self._note_rounding(times.value, core, stated.location())
        return in_ticks(times, frequency)

    def _note_rounding(self, time: Time, core: str, location: Location | None) -> None:
        ticks = ticks_of_time(time, self.controller.frequencies[core])
        if ticks.denominator != 1:
            message = f"{time_text(time)} is {float(ticks):.6g} ticks on {core}, {up(ticks)} are taken"
            self.notes.info("APP007", message, location)

    def execute(
        self, parts: Iterable[ExecutionTime | Time | None], core: str, location: Location | None
    ) -> tuple[Execute, ...]:
        """Computation that consists of parts: what is constant in one, the rest one by one.

        Parameters
        ----------
        location : what a note about the sum points to
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
        self._note_rounding(constant, core, location)
        fixed = [Demand(in_ticks(Constant(constant), self.controller.frequencies[core]))] if constant else []
        return tuple(Execute(demand=demand) for demand in (*fixed, *varying))
