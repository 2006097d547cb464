"""What a sweep tries, and the analysis of one variant as a row of a table; it can be sent to other computers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from amalthea_uros.analyze.impact import ComparedFigure, FigureUnit, figures
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.sensitivity import max_growth
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.campaign.run import CampaignRun, Record, Value, system_bytes, system_from
from amalthea_uros.design.changes.apply import apply
from amalthea_uros.design.changes.change import (
    SWEEP_FORM,
    Change,
    Sweep,
    combinations,
    parse_sweep,
    sampled,
    split_target,
    variants,
)
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.settings import Settings

#: Sweeps as callers give them: `{"Task.period": ["1 ms", "2 ms"]}` or `["Task.period=1ms..5ms/1ms"]`.
Sweeps: TypeAlias = Mapping[str, Sequence[object]] | Iterable[str | Sweep]


@dataclass(frozen=True, slots=True, kw_only=True)
class SweepPlan:
    """What is to be analysed.

    Attributes
    ----------
    sweeps : the values to try
    runs : the variants
    total : number of all combinations, of which a sample has fewer
    seed : of the sample; None without one
    """

    sweeps: tuple[Sweep, ...]
    runs: tuple[CampaignRun, ...]
    total: int
    seed: int | None


def plan_sweep(sweeps: tuple[Sweep, ...], sample: int | None = None, seed: int = 1) -> SweepPlan:
    """The variants of all combinations, or of a sample.

    Raises
    ------
    InvalidArgumentError : nothing is swept, a sample without anything, too many combinations, or two sweeps of one property.
    """
    if not sweeps:
        raise InvalidArgumentError(f"nothing is swept; expected {SWEEP_FORM}")
    if sample is not None and sample < 1:
        raise InvalidArgumentError(f"a sample of {sample} variants is not possible; expected at least 1")
    found = variants(sweeps) if sample is None else sampled(sweeps, sample, seed)
    runs = tuple(CampaignRun(number, seed, changes) for number, changes in enumerate(found, start=1))
    return SweepPlan(sweeps=sweeps, runs=runs, total=combinations(sweeps), seed=None if sample is None else seed)


def as_sweeps(sweeps: Sweeps) -> tuple[Sweep, ...]:
    """Sweeps in any of the forms that callers give.

    Raises
    ------
    InvalidArgumentError : a text is not of the form of a sweep, or a list of values is empty.
    """
    if isinstance(sweeps, Mapping):
        return tuple(_listed(target, values) for target, values in sweeps.items())
    texts: Sequence[str | Sweep] = [sweeps] if isinstance(sweeps, str) else list(sweeps)
    return tuple(each if isinstance(each, Sweep) else parse_sweep(each) for each in texts)


def _listed(target: str, values: Sequence[object]) -> Sweep:
    if isinstance(values, str):
        return parse_sweep(f"{target}={values}")
    if not values:
        raise InvalidArgumentError(f"{target!r} has no values to try")
    return Sweep(*split_target(target, target, SWEEP_FORM, "Executor_Task.period"), tuple(map(str, values)))


SCHEDULABLE, GROWTH = "schedulable", "maximum_growth"


@dataclass(frozen=True, slots=True)
class AnalysisJob:
    """Analyses a system with the changes of a run."""

    system: System
    settings: Settings
    changes: tuple[Change, ...] = ()
    with_growth: bool = False

    def __call__(self, run: CampaignRun) -> Record:
        """The results as a row of a table."""
        analysis = analyze_system(*apply(self.system, self.settings, (*self.changes, *run.changes)))
        found = _record(analysis)
        if self.with_growth:
            growth = max_growth(analysis)
            found[GROWTH] = None if growth is None else float(growth)
        return found

    def __reduce__(self) -> tuple[object, ...]:
        return _received_job, (system_bytes(self.system), self.settings, self.changes, self.with_growth)


def _received_job(system: bytes, settings: Settings, changes: tuple[Change, ...], with_growth: bool) -> AnalysisJob:
    return AnalysisJob(system_from(system), settings, changes, with_growth)


def _record(analysis: Analysis) -> dict[str, Value]:
    """The compared figures of an analysis, by names such as "Executor_Task.worst_case_response_time_ps"."""
    found: dict[str, Value] = {}
    names: Counter[str] = Counter()
    for figure in figures(analysis):
        name = f"{figure.object}.{figure.quantity}".removeprefix(".")
        names[name] += 1
        # Requirements of one name can limit several quantities.
        number = f" {names[name]}" if names[name] > 1 else ""
        found[name + number + ("_ps" if figure.unit is FigureUnit.TIME else "")] = _cell(figure)
    return found


def _cell(figure: ComparedFigure) -> Value:
    value = figure.value
    if value is None or isinstance(value, str):
        return None if value is None else str(value)
    return int(value) if figure.unit is FigureUnit.TIME else float(value)
