"""What was observed in a simulation, in words."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Protocol

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.impact import Impact
from amalthea_uros.design.changes.apply import Difference
from amalthea_uros.diagnostics import Finding
from amalthea_uros.judge.causes import distinct
from amalthea_uros.report.closing_line import left_text
from amalthea_uros.simulate.not_simulated import LIMITED_PROCESS_LEFT_OUT, consequence_of
from amalthea_uros.simulate.observations import RequirementObservation
from amalthea_uros.simulate.results import IDLE, Judged, Simulation
from amalthea_uros.units import SECOND, Time, number_text, time_text

_MINUTE = 60 * SECOND
REMINDER = "Observed values are no bounds; for bounds use `amuros analyze`."


class SimulationShown(Protocol):
    """The result of a simulation of some files."""

    @property
    def paths(self) -> tuple[Path, ...]:
        """The files."""

    @property
    def simulation(self) -> Simulation:
        """What was observed."""

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Problems found while reading the files, and what the simulation does not take into account."""

    @property
    def with_metrics(self) -> bool:
        """Whether the metrics of all processes are shown."""

    @property
    def differences(self) -> tuple[Difference, ...]:
        """What changes did before the run."""

    @property
    def impact(self) -> Impact | None:
        """What the changes do to what is observed; None without changes."""


def duration_text(duration: Time) -> str:
    """A duration, in minutes if it is a number of them: "5 min", "1.5 s"."""
    return f"{duration // _MINUTE} min" if duration % _MINUTE == 0 else time_text(duration)


def closing_line(simulation: Simulation) -> str:
    """What was missed, or what came closest to its limit; and that this is no bound."""
    run = f"Observed over {duration_text(simulation.duration)} (seed {simulation.seed})"
    parts = filter(None, (_incomplete(simulation), _missed(simulation), _not_observed(simulation)))
    return f"{run}: {'; '.join(parts)}. {REMINDER}"


def limit_text(requirement: RequirementObservation) -> str:
    """The limit, such as "at most 1 ms"."""
    if requirement.limit is None:
        return "-"
    return f"at {'most' if requirement.is_upper else 'least'} {value_text(requirement, requirement.limit)}"


def value_text(requirement: RequirementObservation, value: Fraction | None) -> str:
    """A value of what a requirement limits."""
    if value is None:
        return "-"
    return time_text(round(value)) if requirement.is_time else number_text(value)


def _incomplete(simulation: Simulation) -> str:
    """The first thing that was not simulated, and the number of the others; whether nothing at all was."""
    idle, errors = [each for each in simulation.errors if each == IDLE], [each for each in simulation.errors if each != IDLE]
    others = [counted(len(errors) - 1, "other error")] if errors[1:] else []
    return "; ".join([": ".join([*idle, *errors[:1]]), *others])


def _missed(simulation: Simulation) -> str:
    missed = distinct(simulation.missed)
    if missed:
        others = len(missed) - 1
        return _failure(missed[0]) + (f"; {counted(others, 'other failure')}" if others else "")
    if len(simulation.not_observed) == len(simulation.judged):
        return "" if simulation.judged else "no deadline, requirement or constraint to judge"
    what = "deadline or requirement" if simulation.requirements else "deadline"
    return f"no {what} missed{_tightest(simulation)}"


def _tightest(simulation: Simulation) -> str:
    item = simulation.tightest
    if item is None or item.margin is None or item.limit is None:
        return ""
    return f"; tightest: {item.name}, {left_text(item.margin, item.limit, item.is_upper)}"


def _failure(item: Judged) -> str:
    if isinstance(item, RequirementObservation):
        what = f"{item.quantity} of {item.object}" if item.object else item.quantity
        if item.value is None or item.limit is None:
            return f"{what}: {item.reason}"
        reason = f" ({item.reason})" if item.reason else ""
        return f"{what} is {value_text(item, item.value)}{reason}, limit {limit_text(item)}"
    if item.reason or item.response_time is None:
        return f"{item.name}: {item.reason}"
    kind = "period" if item.is_implicit else "deadline"
    return f"{item.name} responds after {time_text(round(item.response_time.max))}, {kind} {time_text(item.deadline or 0)}"


def _not_observed(simulation: Simulation) -> str:
    missing = simulation.not_observed
    if not missing:
        return ""
    count, left_out = f"not observed: {len(missing)} of {len(simulation.judged)}", {each.name for each in simulation.left_out}
    # What is not simulated stands before this in the line; what follows from it needs no reason of its own.
    consequences = {LIMITED_PROCESS_LEFT_OUT, *map(consequence_of, left_out)}
    others = [each for each in missing if each.name not in left_out and each.reason not in consequences]
    return f"{count}, because of {others[0].name!r}: {others[0].reason}" if others else count
