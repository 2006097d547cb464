"""An analysis for people."""

from __future__ import annotations

from fractions import Fraction
from math import ceil

from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.processes import ProcessorResult, ProcessResult
from amalthea_uros.analyze.results.requirements import RequirementResult
from amalthea_uros.judge.verdict import WORST_FIRST, Verdict
from amalthea_uros.report.closing_line import closing_line
from amalthea_uros.report.latencies import write_chains
from amalthea_uros.report.message_chains import write_message_chains
from amalthea_uros.report.process_order import by_core_and_priority
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.report.text import impact
from amalthea_uros.report.text.executors import write_executors
from amalthea_uros.report.text.metrics import write_callbacks, write_metrics
from amalthea_uros.services.analyze import AnalysisResult
from amalthea_uros.units import Rounding, Time, frequency_text, percent_text, rounded_time_text, time_text

BAR = 20


def write(result: AnalysisResult, terminal: Terminal) -> None:
    """Write tables of loads, response times, chains and requirements, with methods, assumptions and the verdict."""
    analysis = result.analysis
    write_message_chains(analysis.message_chains, terminal)
    _processors(terminal, analysis)
    _processes(terminal, analysis)
    write_callbacks(terminal, analysis.of_periodic_executors)
    write_executors(terminal, analysis.executors)
    if result.with_metrics:
        write_metrics(terminal, analysis.processes)
    write_chains(terminal, analysis.chains)
    _requirements(terminal, analysis)
    if result.impact is not None:
        impact.write(result.impact, terminal)
    if result.sensitivity is not None:
        from amalthea_uros.report.text import sensitivity

        sensitivity.write(result.sensitivity, terminal)
    if result.proposals is not None:
        from amalthea_uros.report.text.proposals import write_proposals

        write_proposals(terminal, result.proposals)
    _methods(terminal, analysis)
    if analysis.assumptions:
        terminal.heading("Assumptions")
        for sentence in analysis.assumptions:
            terminal.line(f"  {sentence}")
    terminal.heading(closing_line(analysis.summary))


def write_closing(result: AnalysisResult, terminal: Terminal) -> None:
    """Write the verdict only."""
    terminal.line(closing_line(result.analysis.summary))


def _processors(terminal: Terminal, analysis: Analysis) -> None:
    used = [processor for processor in analysis.processors if processor.worst != 0]
    if not used:
        return
    terminal.line(terminal.style("Load", "1"))
    rows = [
        (
            processor.name,
            frequency_text(processor.frequency) if processor.frequency else "?",
            _percent(processor.best, Rounding.DOWN),
            _percent(processor.mean, Rounding.NEAREST),
            _worst(processor),
            _bar(processor),
        )
        for processor in used
    ]
    terminal.table(("core", "clock", "best", "mean", "worst", ""), rows, right=(1, 2, 3, 4))


def _percent(load: Fraction | None, rounding: Rounding) -> str:
    """A load in percent with three decimals; bounds are rounded so that they remain bounds."""
    return "?" if load is None else f"{percent_text(load, 3, rounding)}%"


def _worst(processor: ProcessorResult) -> str:
    """The worst load, or the part of it that is known."""
    if processor.worst is not None or not processor.at_least:
        return _percent(processor.worst, Rounding.UP)
    return f"at least {_percent(processor.at_least, Rounding.DOWN)}"


def _bar(processor: ProcessorResult) -> str:
    """The worst load as far as it is known as a bar, with an exclamation mark above 100 %."""
    filled = min(BAR, ceil(processor.at_least * BAR))
    rest = ("." if processor.worst is not None else "?") * (BAR - filled)
    return "#" * filled + rest + ("!" if processor.is_overloaded else "")


def _processes(terminal: Terminal, analysis: Analysis) -> None:
    terminal.heading("Response times")
    ordered = sorted(analysis.processes, key=lambda each: by_core_and_priority(each.processor, each.is_isr, each.priority))
    rows = []
    for process in ordered:
        response = process.response
        rows.append(
            (
                process.name,
                process.processor or "?",
                "?" if process.priority is None else f"{'ISR ' if process.is_isr else ''}{process.priority}",
                _time(process.wcet, Rounding.UP),
                _time(response.best if response else None, Rounding.DOWN),
                _time(response.worst if response else None, Rounding.UP, process.deadline),
                _deadline(process),
                process.failure or process.verdict or "-",
                process.reason or (str(response.claim) if response else ""),
            )
        )
    headings = ("process", "core", "priority", "WCET", "best", "worst", "deadline", "verdict", "")
    terminal.table(headings, rows, right=(2, 3, 4, 5, 6))


def _time(value: Time | None, rounding: Rounding, limit: Time | None = None) -> str:
    return "?" if value is None else rounded_time_text(value, rounding, limit)


def _deadline(process: ProcessResult) -> str:
    if process.deadline is None:
        return "-"
    return f"{'period ' if process.is_implicit else ''}{time_text(process.deadline)}"


def _requirements(terminal: Terminal, analysis: Analysis) -> None:
    if not analysis.requirements:
        return
    terminal.heading("Requirements")
    ordered = sorted(analysis.requirements, key=lambda r: WORST_FIRST.index(r.verdict))
    rows = [
        (
            requirement.name,
            f"{requirement.quantity} of {requirement.object}" if requirement.object else requirement.quantity,
            _limit(requirement),
            _value(requirement),
            requirement.verdict,
            _margin(requirement),
            requirement.reason,
        )
        for requirement in ordered
    ]
    terminal.table(("requirement", "what", "limit", "value", "verdict", "margin", ""), rows, right=(3, 5))


def _limit(requirement: RequirementResult) -> str:
    if requirement.limit is None:
        return "-"
    return ("at most " if requirement.is_upper else "at least ") + time_text(requirement.limit)


def _value(requirement: RequirementResult) -> str:
    """The maximum or minimum that is limited: its safe end, or both ends if it lies between them and the verdict is not met."""
    lower, upper, limit = requirement.lower, requirement.upper, requirement.limit
    if lower == upper or requirement.verdict is Verdict.MET or lower is None or upper is None:
        return _time(requirement.value, Rounding.UP if requirement.is_upper else Rounding.DOWN, limit)
    return f"{rounded_time_text(lower, Rounding.DOWN, limit)} to {rounded_time_text(upper, Rounding.UP, limit)}"


def _margin(requirement: RequirementResult) -> str:
    if requirement.margin is None or requirement.verdict is Verdict.UNKNOWN:
        return ""
    return rounded_time_text(requirement.margin, Rounding.DOWN)


def _methods(terminal: Terminal, analysis: Analysis) -> None:
    methods = dict.fromkeys(
        f"{process.response.method} ({process.response.source})" for process in analysis.processes if process.response
    )
    if methods:
        terminal.heading("Methods")
        for method in methods:
            terminal.line(f"  {method}")
