"""Deadlines, requirements and constraints, judged by what was measured.

The verdicts are those of a simulation on the same values: that a limit was kept is no proof that it always is. A baseline that was
subtracted is added again, because a limit is one of the whole time.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from amalthea_uros._internal.by_name import Results
from amalthea_uros.measure.baselines import with_baseline
from amalthea_uros.measure.series import Measurement, Series
from amalthea_uros.perf.constraints import Bound, Requirement, TimeMetric
from amalthea_uros.perf.system import System
from amalthea_uros.services.comparison.agreement import LEAST
from amalthea_uros.services.comparison.naming import Target
from amalthea_uros.services.comparison.results import MeasuredLimit
from amalthea_uros.simulate.limited_values import LimitedQuantity
from amalthea_uros.simulate.results import (
    ChainObservation,
    CountObservation,
    MetricObservation,
    ObservedVerdict,
    Occurrence,
    ProcessObservation,
    RequirementObservation,
    RunnableObservation,
)
from amalthea_uros.simulate.verdicts import ObservedConstraint, deadline_of, judge_process, judge_requirements
from amalthea_uros.timing.chain_quantity import ChainQuantity
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.job_metric import JobMetric
from amalthea_uros.timing.settings import Settings

_NONE = CountObservation(total=0, min=0, max=0)
#: What limits call quantities that have another name where they are measured.
_QUANTITIES = {
    "start delay": JobMetric.INITIAL_PENDING_TIME,
    "reaction": ChainQuantity.REDUCED_REACTION_TIME,
    "data age": ChainQuantity.REDUCED_DATA_AGE,
}
#: The end of the names of jitters: they are differences of two values.
_JITTER = " jitter"
#: Quantity -> what was measured of it.
_Metrics = Mapping[str, MetricObservation]


class _NotMeasured:
    """Observes no constraints of occurrences."""

    def quantities(self, _constraint: ObservedConstraint) -> Sequence[LimitedQuantity]:
        """Nothing."""
        return ()

    def reason(self, constraint: ObservedConstraint) -> str:
        """Why."""
        return (
            f"what {constraint.name!r} limits is not a quantity of one process, runnable or chain, so that it was not measured"
        )


def judge_limits(
    system: System, settings: Settings, measurement: Measurement, targets: Iterable[Target]
) -> Iterator[MeasuredLimit]:
    """The verdicts on all deadlines, requirements and constraints."""
    found = tuple(targets)
    measured: dict[str, dict[str, MetricObservation]] = {}
    for target in found:
        if target.series.statistics is not None and not target.reason and len(target.statistics) > 1:
            measured.setdefault(target.name, {})[target.quantity] = _observation(target.series)
    context = TimingContext.of_scheduling(system, settings)
    processes = Results(_process(name, measured.get(name, {}), context) for name in system.processes)
    chains = Results(_chain(name, measured.get(name, {})) for name in system.chains)
    runnables = Results(_runnable(name, measured[name]) for name in system.runnables if name in measured)
    # A deadline that is also stated as a requirement is judged once.
    stated = {(each.process, each.limit.value) for each in system.constraints.requirements}
    yield from (_deadline(each) for each in processes if each.verdict and (each.name, each.deadline) not in stated)
    times = tuple(filter(_is_measurable, system.constraints.requirements))
    judged = replace(system, constraints=replace(system.constraints, requirements=times))
    least = {target.name for target in found if target.series.is_least}
    for limit in judge_requirements(judged, processes, chains, measurement.duration, runnables, _NotMeasured()):
        yield _certain(_limit(limit, measured.get(limit.object, {})), limit.object in least)
    yield from (_not_a_time(each) for each in system.constraints.requirements if not _is_measurable(each))


def _is_measurable(requirement: Requirement) -> bool:
    """Whether the values of a series show it; how often jobs migrate is not measured, so the time on one core is not known."""
    is_time = isinstance(requirement.limit.metric, TimeMetric)
    return is_time and requirement.limit.metric is not TimeMetric.CORE_EXECUTION_TIME


def _observation(series: Series) -> MetricObservation:
    """A series as what a simulation observes, with the baseline."""
    series = with_baseline(series)
    statistics = series.statistics
    assert statistics is not None
    return MetricObservation(
        count=statistics.count,
        min=Fraction(statistics.min),
        mean=statistics.mean,
        max=Fraction(statistics.max),
        std=statistics.std or 0.0,
        at_min=_occurrence(series, statistics.min),
        at_max=_occurrence(series, statistics.max),
    )


def _occurrence(series: Series, value: int) -> Occurrence:
    """Where a value is first; at the start of the trace if that is not known."""
    if series.values is None or series.times is None:
        return Occurrence(instance=0, time=Fraction(0))
    place = int((series.values == value).argmax())
    return Occurrence(instance=place, time=Fraction(int(series.times[place])))


def _process(name: str, metrics: _Metrics, context: TimingContext) -> ProcessObservation:
    deadline = deadline_of(name, context)
    found = ProcessObservation(
        name=name,
        is_isr=False,
        core=None,
        priority=None,
        jobs=max((each.count for each in metrics.values()), default=0),
        load=Fraction(0),
        metrics=_of_jobs(metrics),
        preemptions=_NONE,
        migrations=_NONE,
        deadline=None if deadline is None else deadline.value,
        is_implicit=deadline is not None and deadline.is_implicit,
    )
    judged = judge_process(found)
    if judged.verdict is ObservedVerdict.NOT_OBSERVED:
        return replace(judged, reason="its response time was not measured")
    return judged


def _runnable(name: str, metrics: _Metrics) -> RunnableObservation:
    count = max((each.count for each in metrics.values()), default=0)
    return RunnableObservation(name=name, executions=count, metrics=_of_jobs(metrics), preemptions=_NONE, migrations=_NONE)


def _of_jobs(metrics: _Metrics) -> dict[JobMetric, MetricObservation]:
    return {metric: metrics[metric] for metric in JobMetric if metric in metrics}


def _chain(name: str, metrics: _Metrics) -> ChainObservation:
    quantities = {quantity: metrics[quantity] for quantity in ChainQuantity if quantity in metrics}
    return ChainObservation(name=name, quantities=quantities, routes=(), reason="" if quantities else "it was not measured")


def _deadline(process: ProcessObservation) -> MeasuredLimit:
    response = process.response_time
    return MeasuredLimit(
        name=process.name,
        object=process.name,
        quantity="response time, period" if process.is_implicit else "response time, deadline",
        is_upper=True,
        limit=None if process.deadline is None else Fraction(process.deadline),
        value=None if response is None else response.max,
        verdict=process.verdict or ObservedVerdict.NOT_OBSERVED,
        samples=0 if response is None else response.count,
        reason=process.reason,
    )


def _limit(found: RequirementObservation, metrics: _Metrics) -> MeasuredLimit:
    is_missing = found.verdict is ObservedVerdict.NOT_OBSERVED and found.object
    limited = found.quantity.removesuffix(_JITTER)
    values = metrics.get(_QUANTITIES.get(limited, limited.replace(" ", "_")))
    return MeasuredLimit(
        name=found.name,
        object=found.object,
        quantity=found.quantity,
        is_upper=found.is_upper,
        limit=found.limit,
        value=found.value,
        verdict=found.verdict,
        samples=0 if values is None else values.count,
        is_time=found.is_time,
        reason=f"the {found.quantity} of {found.object!r} was not measured" if is_missing else found.reason,
    )


def _certain(limit: MeasuredLimit, is_least: bool) -> MeasuredLimit:
    """A verdict that also holds if the real values are longer than those that were measured."""
    if not is_least or limit.verdict is ObservedVerdict.NOT_OBSERVED:
        return limit
    if limit.is_upper and limit.verdict is ObservedVerdict.MISSED and not limit.quantity.endswith(_JITTER):
        return limit
    return replace(limit, verdict=ObservedVerdict.NOT_OBSERVED, reason=LEAST)


def _not_a_time(requirement: Requirement) -> MeasuredLimit:
    limit = requirement.limit
    return MeasuredLimit(
        name=requirement.name,
        object=requirement.process or requirement.runnable or "",
        quantity=str(limit.metric),
        is_upper=limit.bound is Bound.UPPER,
        limit=Fraction(str(limit.value)),
        value=None,
        verdict=ObservedVerdict.NOT_OBSERVED,
        samples=0,
        is_time=isinstance(limit.metric, TimeMetric),
        reason=f"the {limit.metric} is not measured in traces",
    )
