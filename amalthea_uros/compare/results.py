"""The results of a comparison of predictions with measurements."""

from __future__ import annotations

from enum import StrEnum
from fractions import Fraction

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros._internal.shown import Shown
from amalthea_uros.design.changes.apply import Difference
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.judge.verdict import ObservedLimit, ObservedVerdict
from amalthea_uros.measure.series import Distance, MeasuredKind, Measurement, Series
from amalthea_uros.units import Time


class Agreement(StrEnum):
    """Whether a prediction agrees with a measured value.

    `DIFFERS`: it deviates by more than the tolerance, but what the model states does not exclude it. `REFUTED`: a value was measured
    that the model excludes, whatever the tolerance.
    """

    WITHIN = "within"
    DIFFERS = "differs"
    OUTSIDE = "outside"
    REFUTED = "refuted"
    NOT_MEASURED = "not measured"
    NOT_PREDICTED = "not predicted"


class Statistic(StrEnum):
    """What is compared of all values of a quantity; jitter is the difference between maximum and minimum."""

    MIN = "min"
    MEAN = "mean"
    MAX = "max"
    P99 = "p99"
    JITTER = "jitter"


class PredictionClaim(StrEnum):
    """What a prediction claims: the value that occurs, a bound that no value exceeds, or what a simulation of like length has."""

    EXACT = "exact"
    BOUND = "bound"
    SIMULATED = "simulated"


def is_bound(claim: PredictionClaim | None, statistic: Statistic | None) -> bool:
    """Whether no value may exceed or fall below a prediction: that of a minimum or a maximum by an analysis."""
    return claim in (PredictionClaim.EXACT, PredictionClaim.BOUND) and statistic in (Statistic.MIN, Statistic.MAX)


class PredictionSource(StrEnum):
    """What predicts."""

    ANALYSIS = "analysis"
    SIMULATION = "simulation"


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparisonRow(Shown):
    """A predicted value beside a measured one; times are in picoseconds.

    Attributes
    ----------
    object : its name in the model, or in the trace if the model has none of that name
    statistic : None if nothing of the object is compared
    measured, predicted : None if there is no such value, for the `reason`
    predicted_range : if the prediction depends on an unknown phase, its ends over the phases; then `predicted` is the nearest value
        to the measured one; None if it is one value
    tolerance : of the deviation; None for a bound, which has none
    samples : number of measured values
    beyond : how many of them are beyond a bound; None if that is not known, or for what is no bound
    series : what was measured; None if nothing was
    """

    object: str
    kind: MeasuredKind | None
    quantity: str
    statistic: Statistic | None
    verdict: Agreement
    measured: Fraction | None = None
    predicted: Fraction | None = None
    predicted_range: tuple[Fraction, Fraction] | None = None
    claim: PredictionClaim | None = None
    method: str = ""
    tolerance: Fraction | None = None
    samples: int = 0
    beyond: int | None = None
    reason: str = ""
    series: Series | None = field(default=None, repr=False, compare=False)

    @property
    def deviation(self) -> Fraction | None:
        """The distance of the measurement from the prediction as a share of the measurement; positive if more was measured."""
        return self._deviation(self.measured)

    @property
    def deviation_of_prediction(self) -> Fraction | None:
        """The same as a share of the prediction."""
        return self._deviation(self.predicted)

    @property
    def bound_margin(self) -> Fraction | None:
        """By how much the measured extreme value is on the safe side of the bound; negative beyond it, None if there is no bound."""
        if not is_bound(self.claim, self.statistic) or self.measured is None or self.predicted is None:
            return None
        distance = self.predicted - self.measured
        return distance if self.statistic is Statistic.MAX else -distance

    def _deviation(self, base: Fraction | None) -> Fraction | None:
        if self.measured is None or self.predicted is None:
            return None
        if self.measured == self.predicted:
            return Fraction(0)
        return (self.measured - self.predicted) / abs(base) if base else None


@dataclass(frozen=True, slots=True, kw_only=True)
class DistributionRow(Shown):
    """How the distribution of measured values differs from that of simulated ones.

    Attributes
    ----------
    distance : of the measured values from the simulated ones
    is_hidden : whether the means agree although the distributions do not
    """

    object: str
    kind: MeasuredKind
    quantity: str
    distance: Distance
    is_hidden: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class LossRow(Shown):
    """How many values of a quantity were lost in a measurement: nothing is known of these times, perhaps they are the longest ones.

    Attributes
    ----------
    values, lost : how many were measured, and lost
    simulated : share of the stimuli without a response in the simulation; None for what is no chain, or without one
    """

    object: str
    kind: MeasuredKind
    quantity: str
    values: int
    lost: int
    simulated: Fraction | None

    @property
    def share(self) -> Fraction:
        """The share of all that was lost."""
        return Fraction(self.lost, self.values + self.lost)


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasuredLimit(ObservedLimit, Shown):
    """A deadline, requirement or constraint, judged by what was measured.

    Attributes
    ----------
    samples : number of measured values
    """

    samples: int


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Comparison(Shown):
    """Predictions beside what was measured.

    Attributes
    ----------
    model : the files of the model, "" if it is not in files
    tolerance : of deviations, relative to the measurement
    uncertainty : by how much a measured time may be wrong; None if it is not known
    duration, seed : of the simulation; None if there was none
    rows : all comparisons, in the order of the trace, then what was not measured
    limits : deadlines, requirements and constraints, judged by what was measured
    distributions : of the quantities of which the values are measured and simulated
    losses : the quantities of which values were lost
    differences : what changes of the model did before
    with_all : whether texts show all rows, or only the most important quantities and what does not agree
    """

    model: str
    measurement: Measurement
    tolerance: Fraction
    uncertainty: Time | None
    rows: tuple[ComparisonRow, ...]
    limits: tuple[MeasuredLimit, ...] = ()
    distributions: tuple[DistributionRow, ...] = ()
    losses: tuple[LossRow, ...] = ()
    duration: Time | None = None
    seed: int | None = None
    assumptions: tuple[str, ...] = ()
    findings: tuple[Finding, ...] = ()
    differences: tuple[Difference, ...] = ()
    with_all: bool = False

    def __repr__(self) -> str:
        counts = ", ".join(f"{self.count(agreement)} {agreement}" for agreement in Agreement if self.count(agreement))
        return f"<Comparison with {self.measurement.source}: {counts or 'nothing compared'}>"

    def count(self, agreement: Agreement) -> int:
        """The number of rows with a verdict."""
        return sum(row.verdict is agreement for row in self.rows)

    @property
    def compared(self) -> tuple[ComparisonRow, ...]:
        """The rows with a predicted and a measured value."""
        return tuple(row for row in self.rows if row.verdict in _COMPARED)

    @property
    def missed(self) -> tuple[MeasuredLimit, ...]:
        """The limits that were measured as missed."""
        return tuple(limit for limit in self.limits if limit.verdict is ObservedVerdict.MISSED)

    @property
    def holds(self) -> bool:
        """Whether something agrees, and nothing contradicts what the model states."""
        return self.count(Agreement.WITHIN) > 0 and not self.count(Agreement.OUTSIDE) and not self.count(Agreement.REFUTED)

    @property
    def is_damaged(self) -> bool:
        """Whether a part of the measurement could not be used, which perhaps contradicts the model."""
        return any(finding.severity is Severity.ERROR for finding in self.measurement.findings)

    @property
    def is_failed(self) -> bool:
        """Whether the model does not hold, nothing agrees, a limit was measured as missed, or the measurement is damaged."""
        return not self.holds or bool(self.missed) or self.is_damaged

    @property
    def not_compared(self) -> tuple[ComparisonRow, ...]:
        """What was measured and is not predicted, and what was not measured."""
        return tuple(row for row in self.rows if row.verdict not in _COMPARED)

    def find(self, name: str, quantity: str) -> tuple[ComparisonRow, ...]:
        """The rows of a quantity of an object."""
        return tuple(row for row in self.rows if (row.object, row.quantity) == (name, quantity))


_COMPARED = (Agreement.WITHIN, Agreement.DIFFERS, Agreement.OUTSIDE, Agreement.REFUTED)
