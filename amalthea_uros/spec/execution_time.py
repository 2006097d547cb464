"""Execution times: a time, bounds, a distribution or a measured histogram; optionally per platform."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from amalthea_uros.spec.fields import Limits, entry, examines
from amalthea_uros.spec.section import DescriptionSection, Shorthand
from amalthea_uros.spec.values import Count, Duration, Name, Number, described, problem


class BucketSection(DescriptionSection):
    """Number of measured execution times between two values."""

    min: Duration
    """Minimum execution time of the bucket."""
    max: Duration
    """Maximum execution time of the bucket."""
    count: Count
    """Number of execution times measured in the bucket."""


_DISTRIBUTIONS = described(
    uniform="All values between `min` and `max` are equally likely.",
    gauss="Normal distribution with the mean `avg` and the standard deviation `deviation`, cut at `min` and `max`.",
    beta="Beta distribution between `min` and `max` with the shape parameters `alpha` and `beta`.",
    weibull="Weibull distribution that starts at `min`, with the mean `avg`; `exceeding` values of a thousand are above `max`.",
)


class ExecutionTimeSection(Shorthand):
    """An execution time: `12 us`, or with `min` and `max`, or per platform with `on`."""

    shorthand = (
        "min",
        "max",
    )
    plain_value = "The same execution time in every job."

    min: Duration | None = None
    """Best-case execution time."""
    avg: Duration | None = None
    """Mean execution time."""
    max: Duration | None = None
    """Worst-case execution time."""
    distribution: Annotated[Literal["uniform", "gauss", "beta", "weibull"], _DISTRIBUTIONS] | None = None
    """Distribution of execution times between `min` and `max`; if omitted, it is unknown."""
    deviation: Duration | None = None
    """Standard deviation of the Gauss distribution, whose mean is `avg`."""
    alpha: Number | None = None
    """First shape parameter of the beta distribution."""
    beta: Number | None = None
    """Second shape parameter of the beta distribution."""
    exceeding: Annotated[Number, Limits(lt=1000)] | None = None
    """Per mille of the execution times of a Weibull distribution that exceed `max`."""
    histogram: list[BucketSection] | None = entry(None, min_length=1)
    """Measured execution times."""
    on: dict[Name, ExecutionTimeSection] | None = entry(None, min_length=1)
    """Execution times by platform or core type; `default` for all others."""

    @examines
    def _is_complete(self) -> Self:
        if self.on is not None:
            self._only("on")
        elif self.histogram is not None:
            self._only("histogram")
            if any(bucket.min > bucket.max for bucket in self.histogram):
                raise problem("'min' of a bucket is greater than its 'max'")
        else:
            self._check_bounds()
            self._check_shape()
        return self

    def _only(self, key: str) -> None:
        others = sorted(self.model_fields_set - {key})
        if others:
            raise problem(f"{key!r} cannot be combined with {', '.join(map(repr, others))}")

    def _check_bounds(self) -> None:
        if self.min is None or self.max is None:
            raise problem("an execution time needs both 'min' and 'max', or is a single time such as '12 us'")
        if self.min > self.max:
            raise problem("'min' is greater than 'max'")
        if self.avg is not None and not self.min <= self.avg <= self.max:
            raise problem("'avg' is not between 'min' and 'max'")

    def _check_shape(self) -> None:
        needed = {
            None: (),
            "uniform": (),
            "gauss": ("avg", "deviation"),
            "beta": ("alpha", "beta"),
            "weibull": ("avg",),
        }[self.distribution]
        for key in needed:
            if getattr(self, key) is None:
                raise problem(f"a {self.distribution} distribution needs {key!r}")
        optional = {"exceeding"} if self.distribution == "weibull" else set()
        allowed = {"min", "avg", "max", "distribution", *needed, *optional} - (
            {"avg"} if self.distribution == "uniform" else set()
        )
        for key in sorted(self.model_fields_set - allowed):
            kind = f"a {self.distribution} distribution" if self.distribution else "an execution time without 'distribution'"
            raise problem(f"{kind} has no {key!r}")
        if self.distribution == "weibull" and not self.min < self.avg < self.max:  # type: ignore[operator]
            raise problem("a weibull distribution needs 'avg' strictly between 'min' and 'max'")
