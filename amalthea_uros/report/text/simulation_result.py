"""A simulation for people."""

from __future__ import annotations

from fractions import Fraction
from math import ceil, floor

from amalthea_uros.judge.verdict import WORST_OBSERVED_FIRST, ObservedVerdict
from amalthea_uros.report.findings import joined
from amalthea_uros.report.latencies import HEADING
from amalthea_uros.report.process_order import by_core_and_priority
from amalthea_uros.report.simulated import SimulationShown, closing_line, duration_text, limit_text, value_text
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.report.text import impact
from amalthea_uros.simulate.observations import ChainObservation, MetricObservation, ProcessObservation, RequirementObservation
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric
from amalthea_uros.units import NANOSECOND, Rounding, Time, percent_text, rounded_time_text, time_text


def write(result: SimulationShown, terminal: Terminal) -> None:
    """Write tables of loads, response times, chains and requirements, with assumptions and what was observed."""
    simulation = result.simulation
    run = f"{duration_text(simulation.duration)}, seed {simulation.seed}, mode {simulation.mode}"
    of_files = f" of {joined(result.paths)}" if result.paths else ""
    terminal.line(f"{terminal.style('Simulation', '1')}{of_files}: {run}")
    _cores(terminal, simulation)
    _processes(terminal, simulation)
    if result.with_metrics:
        _metrics(terminal, simulation)
    _chains(terminal, simulation)
    _runnables(terminal, simulation)
    _labels(terminal, simulation)
    _requirements(terminal, simulation)
    if result.impact is not None:
        impact.write(result.impact, terminal, f"observed with seed {simulation.seed}")
    if simulation.assumptions:
        terminal.heading("Assumptions")
        for sentence in simulation.assumptions:
            terminal.line(f"  {sentence}")
    terminal.heading(closing_line(simulation))


def write_closing(result: SimulationShown, terminal: Terminal) -> None:
    """Write what was observed, in one line."""
    terminal.line(closing_line(result.simulation))


def _cores(terminal: Terminal, simulation: Simulation) -> None:
    used = [core for core in simulation.cores if core.load]
    if used:
        terminal.heading("Load")
        terminal.table(("core", "load"), [(core.name, _percent(core.load)) for core in used], right=(1,))


def _percent(load: Fraction) -> str:
    return f"{percent_text(load, 3)}%"


def _processes(terminal: Terminal, simulation: Simulation) -> None:
    terminal.heading("Observed response times")
    ordered = sorted(simulation.processes, key=lambda each: by_core_and_priority(each.core, each.is_isr, each.priority))
    rows = [
        (
            process.name,
            process.core or "-",
            f"{process.jobs:,}",
            _percent(process.load),
            *_min_mean_max(process.response_time, process.deadline),
            _deadline(process),
            f"{process.lost_activations:,}",
            _verdict(process.verdict),
            process.reason,
        )
        for process in ordered
    ]
    headings = ("process", "core", "jobs", "load", "min", "mean", "max", "deadline", "lost", "verdict", "")
    terminal.table(headings, rows, right=range(2, 9))


def _min_mean_max(found: MetricObservation | None, limit: Time | None = None) -> tuple[str, ...]:
    if found is None:
        return ("-",) * 3
    ends = ((found.min, Rounding.DOWN), (found.mean, Rounding.NEAREST), (found.max, Rounding.UP))
    return tuple(rounded_time_text(value, rounding, limit) for value, rounding in ends)


def _deadline(process: ProcessObservation) -> str:
    if process.deadline is None:
        return "-"
    return f"{'period ' if process.is_implicit else ''}{time_text(process.deadline)}"


def _verdict(verdict: ObservedVerdict | None) -> str:
    return "-" if verdict is None else verdict.replace("_", " ")


def _metrics(terminal: Terminal, simulation: Simulation) -> None:
    for process in simulation.processes:
        terminal.heading(f"Metrics of {process.name} (us)")
        rows = [
            (name.replace("_", " "), _microseconds(found.min), _microseconds(found.mean), _microseconds(found.max, is_max=True))
            for name, found in process.metrics.items()
        ]
        terminal.table(("metric", "min", "avg", "max"), rows or [("none", *[""] * 3)], right=(1, 2, 3))


def _microseconds(value: Fraction, is_max: bool = False) -> str:
    """A time in microseconds with three digits, so that minimum and maximum are rounded outwards; means are cut off."""
    nanoseconds = (ceil if is_max else floor)(value / NANOSECOND)
    whole, digits = divmod(abs(nanoseconds), 1000)
    return f"{'-' if nanoseconds < 0 else ''}{whole}.{digits:03}"


def _chains(terminal: Terminal, simulation: Simulation) -> None:
    if simulation.chains:
        terminal.heading(HEADING)
        rows = [_chain(chain) for chain in simulation.chains]
        headings = ("chain", "observations", "min", "mean", "reaction", "data age", "unanswered", "")
        terminal.table(headings, rows, right=range(1, 7))


def _chain(chain: ChainObservation) -> tuple[str, ...]:
    age = _min_mean_max(chain.quantities.get(ChainQuantity.REDUCED_DATA_AGE))
    missing = f"{chain.not_evaluated:,} latencies too long to be observed" if chain.not_evaluated else ""
    return (
        chain.name,
        f"{chain.observations:,}",
        *_min_mean_max(chain.quantities.get(ChainQuantity.REDUCED_REACTION_TIME)),
        age[2],
        f"{chain.unanswered:,}",
        chain.reason or missing,
    )


def _runnables(terminal: Terminal, simulation: Simulation) -> None:
    if simulation.runnables:
        terminal.heading("Runnables with requirements")
        rows = [
            (
                runnable.name,
                f"{runnable.executions:,}",
                *_min_mean_max(runnable.metrics.get(JobMetric.RESPONSE_TIME)),
                _min_mean_max(runnable.metrics.get(JobMetric.NET_EXECUTION_TIME))[2],
            )
            for runnable in simulation.runnables
        ]
        headings = ("runnable", "executions", "min response", "mean", "max", "max net execution")
        terminal.table(headings, rows, right=range(1, 6))


def _labels(terminal: Terminal, simulation: Simulation) -> None:
    if simulation.labels:
        terminal.heading("Labels")
        rows = [
            (
                label.name,
                *(f"{number:,}" for number in (label.reads, label.writes, label.unwritten_reads, label.overwritten)),
                *_min_mean_max(label.age),
            )
            for label in simulation.labels
        ]
        headings = ("label", "reads", "writes", "unwritten", "overwritten", "min age", "mean", "max")
        terminal.table(headings, rows, right=range(1, 8))


def _requirements(terminal: Terminal, simulation: Simulation) -> None:
    if not simulation.requirements:
        return
    terminal.heading("Requirements")
    rows = [
        (
            requirement.name,
            f"{requirement.quantity} of {requirement.object}" if requirement.object else requirement.quantity,
            limit_text(requirement),
            _rounded(requirement, requirement.value, Rounding.UP if requirement.is_upper else Rounding.DOWN, requirement.limit),
            _verdict(requirement.verdict),
            "" if requirement.margin is None else _rounded(requirement, requirement.margin, Rounding.DOWN),
            _remark(requirement),
        )
        for requirement in sorted(simulation.requirements, key=lambda each: WORST_OBSERVED_FIRST.index(each.verdict))
    ]
    terminal.table(("requirement", "what", "limit", "observed", "verdict", "margin", ""), rows, right=(3, 5))


def _rounded(
    requirement: RequirementObservation, value: Fraction | None, rounding: Rounding, limit: Fraction | None = None
) -> str:
    if value is None or not requirement.is_time:
        return value_text(requirement, value)
    return rounded_time_text(value, rounding, limit)


def _remark(requirement: RequirementObservation) -> str:
    """Why, and when a limit was missed first."""
    is_missed = requirement.verdict is ObservedVerdict.MISSED and requirement.at is not None
    when = f"at {time_text(round(requirement.at or 0))}" if is_missed else ""
    return ", ".join(filter(None, (requirement.reason, when)))
