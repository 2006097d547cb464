"""An analysis for people."""

from __future__ import annotations

from fractions import Fraction
from math import ceil

from amalthea_uros.analyze.results import Analysis, ProcessorResult, ProcessResult, RequirementResult
from amalthea_uros.analyze.verdicts import Verdict
from amalthea_uros.report.closing_line import closing_line
from amalthea_uros.report.latencies import write_chains
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.report.text.metrics import write_callbacks, write_metrics
from amalthea_uros.services.analyze import AnalysisResult
from amalthea_uros.units import Time, frequency_text, time_text

BAR = 20
_BADNESS = (Verdict.UNBOUNDED, Verdict.MISSED, Verdict.UNKNOWN, Verdict.MET, None)


def write(result: AnalysisResult, terminal: Terminal) -> None:
    """Write tables of loads, response times, chains and requirements, worst first, with methods, assumptions and the verdict."""
    analysis = result.analysis
    _processors(terminal, analysis)
    _processes(terminal, analysis)
    write_callbacks(terminal, analysis.callbacks)
    if result.with_metrics:
        write_metrics(terminal, analysis.processes)
    write_chains(terminal, analysis.chains)
    _requirements(terminal, analysis)
    if result.sensitivity is not None:
        from amalthea_uros.report.text.sensitivity import write_sensitivity

        write_sensitivity(terminal, result.sensitivity)
    if result.proposals is not None:
        from amalthea_uros.report.text.proposals import write_proposals

        write_proposals(terminal, result.proposals)
    _methods(terminal, analysis)
    if analysis.assumptions:
        terminal.heading("Assumptions")
        for sentence in analysis.assumptions:
            terminal.line(f"  {sentence}")
    terminal.heading(closing_line(analysis.summary))


def _processors(terminal: Terminal, analysis: Analysis) -> None:
    used = [processor for processor in analysis.processors if processor.worst != 0]
    if not used:
        return
    terminal.line(terminal.style("Load", "1"))
    rows = []
    for processor in used:
        clock = frequency_text(processor.frequency) if processor.frequency else "?"
        rows.append(
            (processor.name, clock, _percent(processor.best), _percent(processor.mean), _worst(processor), _bar(processor))
        )
    terminal.table(("core", "clock", "best", "mean", "worst", ""), rows, right=(1, 2, 3, 4))


def _percent(load: Fraction | None) -> str:
    return "?" if load is None else f"{float(load):.3%}"


def _worst(processor: ProcessorResult) -> str:
    """The worst load, or the part of it that is known."""
    if processor.worst is not None or not processor.at_least:
        return _percent(processor.worst)
    return f"at least {_percent(processor.at_least)}"


def _bar(processor: ProcessorResult) -> str:
    """The worst load as far as it is known as a bar, with an exclamation mark above 100 %."""
    filled = min(BAR, ceil(processor.at_least * BAR))
    rest = ("." if processor.worst is not None else "?") * (BAR - filled)
    return "#" * filled + rest + ("!" if processor.is_overloaded else "")


def _processes(terminal: Terminal, analysis: Analysis) -> None:
    terminal.heading("Response times")
    ordered = sorted(analysis.processes, key=_urgency)
    rows = []
    for process in ordered:
        response = process.response
        rows.append(
            (
                process.name,
                process.processor or "?",
                "?" if process.priority is None else f"{'ISR ' if process.is_isr else ''}{process.priority}",
                _time(process.wcet),
                _time(response.best if response else None),
                _time(response.worst if response else None),
                f"{'period ' if process.is_implicit else ''}{_time(process.deadline, '-')}",
                process.failure or process.verdict or "-",
                process.reason or (str(response.claim) if response else ""),
            )
        )
    headings = ("process", "core", "priority", "WCET", "best", "worst", "deadline", "verdict", "")
    terminal.table(headings, rows, right=(2, 3, 4, 5, 6))


def _urgency(process: ProcessResult) -> tuple[int, float]:
    """Bad verdicts first, then those that use up most of their deadline."""
    response = process.response
    use = 0.0
    if response is not None and response.worst is not None and process.deadline:
        use = response.worst / process.deadline
    return (_BADNESS.index(process.verdict), -use)


def _time(value: Time | None, missing: str = "?") -> str:
    return missing if value is None else time_text(value)


def _requirements(terminal: Terminal, analysis: Analysis) -> None:
    if not analysis.requirements:
        return
    terminal.heading("Requirements")
    ordered = sorted(analysis.requirements, key=lambda r: _BADNESS.index(r.verdict))
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
    lower, upper = requirement.lower, requirement.upper
    if lower == upper or requirement.verdict is Verdict.MET or lower is None or upper is None:
        return _time(requirement.value)
    return f"{time_text(lower)} to {time_text(upper)}"


def _margin(requirement: RequirementResult) -> str:
    return "" if requirement.margin is None or requirement.verdict is Verdict.UNKNOWN else time_text(requirement.margin)


def _methods(terminal: Terminal, analysis: Analysis) -> None:
    methods = dict.fromkeys(
        f"{process.response.method} ({process.response.source})" for process in analysis.processes if process.response
    )
    if methods:
        terminal.heading("Methods")
        for method in methods:
            terminal.line(f"  {method}")
