"""What the analysis and a simulation predict of each quantity that can be measured.

A quantity is predicted only where its definition is that of the measured one. The mean reaction time of an analysis is that of events
at any time, for example, but the measured one is that of the worst events, so that it has no counterpart.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.analyze.response_times.metrics import merged
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import ChainResult, LatencyQuantity
from amalthea_uros.analyze.results.processes import Metric
from amalthea_uros.compare.agreement import Prediction, measured_values
from amalthea_uros.compare.host import HostPredictor
from amalthea_uros.compare.results import PredictionClaim, Statistic
from amalthea_uros.compare.simulated import Run
from amalthea_uros.errors import UnknownError
from amalthea_uros.measure.series import MeasuredKind, TimeStatistics
from amalthea_uros.perf.host import Host
from amalthea_uros.simulate.observations import MetricObservation
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import Time, time_text

#: The predictions of a quantity.
Predictions = Mapping[Statistic, tuple[Prediction, ...]]


class _EndQuantities(NamedTuple):
    """The quantities of an analysis that are the minimum, the mean and the maximum of a measured one."""

    minimum: LatencyQuantity | None = None
    mean: LatencyQuantity | None = None
    maximum: LatencyQuantity | None = None


_FIRST_TO_FIRST = _EndQuantities(
    LatencyQuantity.MIN_FIRST_TO_FIRST, LatencyQuantity.MEAN_FIRST_TO_FIRST, LatencyQuantity.MAX_REDUCED_REACTION_TIME
)
_LAST_TO_LAST = _EndQuantities(
    LatencyQuantity.MIN_LAST_TO_LAST, LatencyQuantity.MEAN_LAST_TO_LAST, LatencyQuantity.MAX_REDUCED_DATA_AGE
)
_OF_CHAINS: Mapping[str, _EndQuantities] = {
    ChainQuantity.REACTION_TIME: _EndQuantities(maximum=LatencyQuantity.MAX_REACTION_TIME),
    ChainQuantity.REDUCED_REACTION_TIME: _FIRST_TO_FIRST,
    ChainQuantity.DATA_AGE: _EndQuantities(maximum=LatencyQuantity.MAX_DATA_AGE),
    ChainQuantity.REDUCED_DATA_AGE: _LAST_TO_LAST,
    ChainQuantity.FIRST_TO_FIRST: _FIRST_TO_FIRST,
    ChainQuantity.FIRST_TO_LAST: _EndQuantities(maximum=LatencyQuantity.MAX_FIRST_TO_LAST),
    ChainQuantity.LAST_TO_FIRST: _EndQuantities(LatencyQuantity.MIN_LAST_TO_FIRST, None, LatencyQuantity.MAX_LAST_TO_FIRST),
    ChainQuantity.LAST_TO_LAST: _LAST_TO_LAST,
}
#: The metrics to which an overhead is added: it is part of an execution, and not of the distance of two of them.
_WITH_OVERHEAD = (JobMetric.NET_EXECUTION_TIME, JobMetric.GROSS_EXECUTION_TIME, JobMetric.RESPONSE_TIME)
#: Parts of the response time of a callback: its bound is one of these, too.
_WITHIN_RESPONSE = (JobMetric.NET_EXECUTION_TIME, JobMetric.GROSS_EXECUTION_TIME, JobMetric.RUNNING_TIME)
_ENDS = {Statistic.MIN: "minimum", Statistic.MEAN: "mean", Statistic.MAX: "maximum"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Predictor:
    """Looks predictions up.

    Attributes
    ----------
    analysis : None if it is not asked
    host : of the system, about which the analysis is asked
    runs : simulations, the first one as long as the measurement; none if they are not asked
    in_phases : the analyses that predict means, in each phase that is possible; none if simulations predict them
    overheads : process -> what is added to its predicted times; "" stands for all others
    """

    analysis: Analysis | None
    runs: tuple[Run, ...]
    host: Host
    in_phases: tuple[Analysis, ...] = ()
    overheads: Mapping[str, Time] = field(default_factory=dict)

    def of(self, kind: MeasuredKind, name: str, quantity: str) -> Predictions:
        """The predictions of a quantity.

        Raises
        ------
        UnknownError : there is none.
        """
        found = [*self._analyzed(kind, name, quantity), *self._simulated(kind, name, quantity)]
        if not found:
            raise UnknownError(self._reason(kind, name, quantity))
        return {
            statistic: tuple(self._with_overhead(name, quantity, statistic, one) for each, one in found if each is statistic)
            for statistic in Statistic
        }

    # The analysis.

    def _analyzed(self, kind: MeasuredKind, name: str, quantity: str) -> Iterator[tuple[Statistic, Prediction]]:
        if self.analysis is None:
            return
        yield from _extremes(_of(self.analysis, kind, name, quantity))
        yield from HostPredictor(self.host, self.analysis.host).of(kind, name, quantity).items()
        means = [_of(each, kind, name, quantity).get(Statistic.MEAN) for each in self.in_phases]
        known = [each for each in means if each is not None]
        # The bound of a mean is no prediction of it.
        if known and len(known) == len(means) and all(each.claim is PredictionClaim.EXACT for each in known):
            values = [each.value for each in known]
            yield Statistic.MEAN, replace(known[0], value=min(values), high=max(values))

    # The simulation.

    def _simulated(self, kind: MeasuredKind, name: str, quantity: str) -> Iterator[tuple[Statistic, Prediction]]:
        if not self.runs:
            return
        found = [values for run in self.runs if (values := _values(run, kind, name, quantity))]
        first, others = self.runs[0].simulation, len(self.runs) - 1
        phases = f", and in {others} phases" if others else ""
        method = f"simulation of {time_text(first.duration)}, seed {first.seed}{phases}"
        for statistic in found[0] if found else ():
            each = [values[statistic] for values in found if statistic in values]
            claim, count = PredictionClaim.SIMULATED, _count(self.runs[0], kind, name, quantity)
            yield statistic, Prediction(value=min(each), high=max(each), claim=claim, method=method, count=count)

    # Both.

    def _with_overhead(self, name: str, quantity: str, statistic: Statistic, found: Prediction) -> Prediction:
        overhead = overhead_of(name, quantity, self.overheads)
        if not overhead or statistic is Statistic.JITTER:
            return found
        return replace(
            found,
            value=found.value + overhead,
            high=None if found.high is None else found.high + overhead,
            method=f"{found.method}, plus {time_text(overhead)} of overhead",
        )

    def _reason(self, kind: MeasuredKind, name: str, quantity: str) -> str:
        """Why nothing is predicted."""
        stated = next(filter(None, self._stated_reasons(kind, name)), "")
        known = tuple(ChainQuantity) if kind is MeasuredKind.CHAIN else tuple(JobMetric)
        if quantity not in known:
            return f"{quantity!r} is no quantity of a {kind}; say what it is with --as '{name}.{quantity}={name}.QUANTITY'"
        what = quantity.replace("_", " ")
        return stated or f"neither analysis nor simulation has the {what} of {name!r}"

    def _stated_reasons(self, kind: MeasuredKind, name: str) -> Iterator[str]:
        if self.analysis is not None:
            analysis = self.analysis
            yield from (each.reason for each in analysis.processes if (kind, each.name) == (MeasuredKind.PROCESS, name))
            yield from (each.reason for each in analysis.callbacks if (kind, each.name) == (MeasuredKind.RUNNABLE, name))
            yield from (each.reason for each in analysis.chains if (kind, each.name) == (MeasuredKind.CHAIN, name))
            yield HostPredictor(self.host, analysis.host).reason(kind, name)
        if self.runs:
            yield from (
                each.reason for each in self.runs[0].simulation.chains if (kind, each.name) == (MeasuredKind.CHAIN, name)
            )


def _of(analysis: Analysis, kind: MeasuredKind, name: str, quantity: str) -> dict[Statistic, Prediction]:
    """What an analysis has of a quantity."""
    if kind is MeasuredKind.CHAIN:
        chain = next((each for each in analysis.chains if each.name == name), None)
        return {} if chain is None else dict(_of_chain(chain, quantity))
    metric = _metric(analysis, kind, name, quantity)
    if metric is not None:
        return dict(_of_metric(metric, quantity))
    is_part = kind is MeasuredKind.RUNNABLE and quantity in _WITHIN_RESPONSE
    whole = _metric(analysis, kind, name, JobMetric.RESPONSE_TIME) if is_part else None
    if whole is None or whole.max is None:
        return {}
    method = f"analysis of the response time, of which the {quantity.replace('_', ' ')} is a part"
    return {Statistic.MAX: Prediction(value=Fraction(whole.max), claim=PredictionClaim.BOUND, method=method)}


def _extremes(found: Mapping[Statistic, Prediction]) -> Iterator[tuple[Statistic, Prediction]]:
    yield from ((statistic, each) for statistic, each in found.items() if statistic is not Statistic.MEAN)


def _metric(analysis: Analysis, kind: MeasuredKind, name: str, quantity: str) -> Metric | None:
    holders = analysis.processes if kind is MeasuredKind.PROCESS else analysis.callbacks
    variants = [each.metrics for each in holders if each.name == name]
    found: Mapping[JobMetric, Metric] = merged(variants) if variants else {}
    return next((metric for each, metric in found.items() if each == quantity), None)


def _of_metric(metric: Metric, quantity: str) -> Iterator[tuple[Statistic, Prediction]]:
    claim = PredictionClaim.EXACT if metric.claim is Claim.EXACT else PredictionClaim.BOUND
    method = f"analysis of the {quantity.replace('_', ' ')}"
    if metric.min is not None:
        yield Statistic.MIN, Prediction(value=Fraction(metric.min), claim=claim, method=method)
    if metric.max is not None:
        yield Statistic.MAX, Prediction(value=Fraction(metric.max), claim=claim, method=method)
    if metric.mean is not None:
        yield Statistic.MEAN, Prediction(value=metric.mean, claim=PredictionClaim.EXACT, method=method)


def _of_chain(chain: ChainResult, quantity: str) -> Iterator[tuple[Statistic, Prediction]]:
    for statistic, end in _ENDS.items():
        name = getattr(_OF_CHAINS.get(quantity, _EndQuantities()), end)
        value = None if name is None else chain.value(name)
        if value is not None and value.value is not None:
            claim = PredictionClaim.EXACT if value.claim is Claim.EXACT else PredictionClaim.BOUND
            yield statistic, Prediction(value=Fraction(value.value), claim=claim, method=value.method)


def _values(run: Run, kind: MeasuredKind, name: str, quantity: str) -> dict[Statistic, Fraction]:
    """What a run has of a quantity: of all of it, and what only its trace shows."""
    statistics = _statistics(run, kind, name, quantity)
    values = {} if statistics is None else dict(measured_values(statistics))
    found = _observed(run.simulation, kind, name, quantity)
    if found is not None:
        values |= {Statistic.MIN: found.min, Statistic.MEAN: found.mean, Statistic.MAX: found.max}
        values[Statistic.JITTER] = found.jitter
    return values


def _statistics(run: Run, kind: MeasuredKind, name: str, quantity: str) -> TimeStatistics | None:
    """What was measured in the trace of a run."""
    series = (each for each in run.values.series if (each.kind, each.name, each.quantity) == (kind, name, quantity))
    return next((each.statistics for each in series), None)


def _count(run: Run, kind: MeasuredKind, name: str, quantity: str) -> int | None:
    """How many values a run has of a quantity."""
    statistics = _statistics(run, kind, name, quantity)
    found = _observed(run.simulation, kind, name, quantity)
    return found.count if found is not None else None if statistics is None else statistics.count


def overhead_of(name: str, quantity: str, overheads: Mapping[str, Time]) -> Time:
    """What is added to the predicted values of a quantity."""
    return overheads.get(name, overheads.get("", 0)) if quantity in _WITH_OVERHEAD else 0


def _observed(simulation: Simulation, kind: MeasuredKind, name: str, quantity: str) -> MetricObservation | None:
    """What a simulation has of a quantity."""
    found: Iterator[Iterable[tuple[str, MetricObservation]]] = iter(())
    match kind:
        case MeasuredKind.PROCESS:
            found = (each.metrics.items() for each in simulation.processes if each.name == name)
        case MeasuredKind.RUNNABLE:
            found = iter(
                [*(each.metrics.items() for each in simulation.runnables if each.name == name), *_of_handles(simulation, name)]
            )
        case MeasuredKind.CHAIN:
            found = (each.quantities.items() for each in simulation.chains if each.name == name)
    return next((observation for items in found for each, observation in items if each == quantity), None)


def _of_handles(simulation: Simulation, runnable: str) -> Sequence[Iterable[tuple[str, MetricObservation]]]:
    """The observations of a callback of an executor that loops; if several handles call it, only values are known of all."""
    handles = (handle for executor in simulation.executors for handle in executor.handles if handle.runnable == runnable)
    metrics = [handle.metrics.items() for handle in handles]
    return metrics if len(metrics) == 1 else []
