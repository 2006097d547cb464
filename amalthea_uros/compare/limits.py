"""Deadlines, requirements and constraints, judged by what was measured.

That a limit was kept is no proof that it always is. A baseline that was subtracted is added again, because a limit is one of the
whole time.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction

from amalthea_uros._internal.plural import counted
from amalthea_uros.compare.agreement import LEAST, Rule
from amalthea_uros.compare.naming import Target
from amalthea_uros.compare.results import MeasuredLimit
from amalthea_uros.judge.causes import quantity_of
from amalthea_uros.judge.evidence import ObservedProcess, ObservedValues
from amalthea_uros.judge.limits import (
    NO_LIMIT,
    SystemLimit,
    activation_limit,
    deadline_limit,
    deadline_of,
    is_from_period,
    nominal_period,
    stated_limits,
    without_number,
)
from amalthea_uros.judge.verdict import ObservedVerdict, not_observed, observe, observe_process
from amalthea_uros.measure.baselines import with_baseline
from amalthea_uros.measure.series import Counts, Series
from amalthea_uros.perf.constraints import Requirement, TimeMetric
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.timing.context import TimingContext

#: Object and quantity -> what was measured of it.
_Measured = Mapping[tuple[str, str], Series]


def judge_limits(system: System, settings: Settings, targets: Iterable[Target], rule: Rule) -> Iterator[MeasuredLimit]:
    """The verdicts on all deadlines, requirements and constraints."""
    return (_with_doubt(limit, rule) for limit in _judged_limits(system, settings, tuple(targets)))


def _judged_limits(system: System, settings: Settings, targets: Collection[Target]) -> Iterator[MeasuredLimit]:
    lost = {target.name: target.series.counts for target in targets if target.series.counts.lost_activations}
    measured = {
        (target.name, target.quantity): with_baseline(target.series)
        for target in targets
        if target.series.statistics is not None and not target.reason and len(target.statistics) > 1
    }
    stated = list(stated_limits(system))
    of_requirements = {
        (quantity_of(limit), limit.limit) for item, limits in stated if isinstance(item, Requirement) for limit in limits
    }
    for process, limit in _deadlines(TimingContext.of_scheduling(system, settings)):
        if process.name in lost:
            yield _with_lost_activations(limit or activation_limit(process), lost[process.name])
        # A deadline that is also stated as a requirement is judged once.
        elif limit is not None and (quantity_of(limit), limit.limit) not in of_requirements:
            yield _judged(limit, measured, system)
    for item, limits in stated:
        for limit in limits or [without_number(item)]:
            yield _judged(limit, measured, system)


def _with_doubt(limit: MeasuredLimit, rule: Rule) -> MeasuredLimit:
    """A limit that was kept, with the remark that it may have been missed if the measured time is wrong."""
    is_near = limit.is_time and limit.margin is not None and limit.margin < rule.uncertainty
    if limit.verdict is not ObservedVerdict.OK or not is_near:
        return limit
    doubt = "the distance from the limit is within the uncertainty of the measurement"
    return replace(limit, reason="; ".join(filter(None, (limit.reason, doubt))))


def _deadlines(context: TimingContext) -> Iterator[tuple[Process, SystemLimit | None]]:
    """The processes, and the limits that their deadlines are."""
    for name, process in context.system.processes.items():
        deadline = deadline_of(name, context)
        yield process, None if deadline is None else deadline_limit(process, deadline.value, deadline.is_implicit)


def _judged(limit: SystemLimit, measured: _Measured, system: System) -> MeasuredLimit:
    series = measured.get((limit.object, limit.metric or ""))
    missing = _not_measured(limit)
    if missing or series is None:
        return MeasuredLimit.of(limit, not_observed(missing or "no value of it was measured"), samples=0)
    assert series.statistics is not None
    values, samples = _values(series), series.statistics.count
    if not limit.is_jitter:
        return MeasuredLimit.of(limit, observe(limit, values), samples=samples)
    period = nominal_period(limit, system) if is_from_period(limit) else None
    if is_from_period(limit) and period is None:
        return MeasuredLimit.of(limit, not_observed(f"{limit.object!r} has no nominal period"), samples=samples)
    return MeasuredLimit.of(limit, observe(limit, values.jitter(period)), samples=samples)


def _with_lost_activations(limit: SystemLimit, counts: Counts) -> MeasuredLimit:
    """The verdict on a process of which activations were lost, whatever its jobs responded after, and whether it has a deadline."""
    judgement = observe_process(limit, ObservedProcess(response=ObservedValues(), lost_activations=counts.lost_activations))
    assert judgement is not None
    return MeasuredLimit.of(limit, judgement, samples=0)


def _not_measured(limit: SystemLimit) -> str:
    """Why a limit is about nothing that traces show; how often jobs migrate is not measured, so the time on one core is not known."""
    if isinstance(limit.item, Requirement):
        metric = limit.item.limit.metric
        is_measurable = isinstance(metric, TimeMetric) and metric is not TimeMetric.CORE_EXECUTION_TIME
        return "" if is_measurable else f"the {metric} is not measured in traces"
    if limit.metric is not None:
        return NO_LIMIT if limit.limit is None else ""
    return "it is not a quantity of one process, runnable or chain, so it was not measured"


def _values(series: Series) -> ObservedValues:
    statistics, lost = series.statistics, series.counts.lost
    assert statistics is not None
    reason = LEAST if series.is_least else f"{counted(lost, 'value')} lost, which may be later" if lost else ""
    return ObservedValues(
        low=Fraction(statistics.min),
        high=Fraction(statistics.max),
        is_complete=not lost,
        are_least=series.is_least,
        reason=reason,
    )
