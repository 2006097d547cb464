"""The analysis of one variant of a sweep, as a row of a table; it can be sent to other computers."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from amalthea_uros.analyze.impact import ComparedFigure, FigureUnit, figures
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.sensitivity import max_growth
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.campaign.run import Record, Run, Value
from amalthea_uros.design.campaign.sending import system_bytes, system_from
from amalthea_uros.design.changes.apply import apply
from amalthea_uros.design.changes.change import Change
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.settings import Settings

SCHEDULABLE, GROWTH = "schedulable", "maximum_growth"


@dataclass(frozen=True, slots=True)
class AnalysisJob:
    """Analyses a system with the changes of a run."""

    system: System
    settings: Settings
    changes: tuple[Change, ...] = ()
    with_growth: bool = False

    def __call__(self, run: Run) -> Record:
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
