"""An analysis for people and for programs."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from pathlib import Path
from typing import IO, Any

from amalthea_uros import __version__
from amalthea_uros.analyze.assignment import Proposal
from amalthea_uros.analyze.explanation import Share
from amalthea_uros.analyze.results import Analysis, ProcessorResult, ProcessResult, RequirementResult, Verdict
from amalthea_uros.analyze.sensitivity import GREATEST, Sensitivity
from amalthea_uros.diagnostics import Finding
from amalthea_uros.report.chains import chain_json, write_chains
from amalthea_uros.report.findings import finding_json
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.units import Time, frequency_text, time_text

BAR = 20
_COLOURS = {Verdict.MET: "32", Verdict.MISSED: "31", Verdict.UNBOUNDED: "31", Verdict.UNKNOWN: "33"}
_BADNESS = (Verdict.UNBOUNDED, Verdict.MISSED, Verdict.UNKNOWN, Verdict.MET)


@dataclass(frozen=True, slots=True)
class Extras:
    """What is shown on request."""

    sensitivity: Sensitivity | None = None
    proposals: tuple[Proposal, ...] | None = None


def write_text(analysis: Analysis, extras: Extras, stream: IO[str]) -> None:
    """Tables that a person reads at a glance, worst first."""
    terminal = Terminal(stream)
    _processors(terminal, analysis)
    _processes(terminal, analysis)
    write_chains(terminal, analysis.chains)
    _requirements(terminal, analysis)
    _sensitivity(terminal, extras.sensitivity)
    for proposal in extras.proposals or ():
        _proposal(terminal, proposal)
    _methods(terminal, analysis)
    if analysis.assumptions:
        terminal.heading("Assumptions")
        for sentence in analysis.assumptions:
            terminal.line(f"  {sentence}")


def _processors(terminal: Terminal, analysis: Analysis) -> None:
    used = [processor for processor in analysis.processors if processor.worst != 0]
    if not used:
        return
    terminal.line(terminal.style("Load", "1"))
    rows = []
    for processor in used:
        clock = frequency_text(processor.frequency) if processor.frequency else "?"
        loads = [_percent(load) for load in (processor.best, processor.mean, processor.worst)]
        rows.append((processor.name, clock, *loads, _bar(processor)))
    terminal.table(("core", "clock", "best", "mean", "worst", ""), rows, right=(1, 2, 3, 4))


def _percent(load: Fraction | None) -> str:
    return "?" if load is None else f"{float(load):.3%}"


def _bar(processor: ProcessorResult) -> str:
    """The worst load as a bar; what is above 100 % stands out of it."""
    if processor.worst is None:
        return ""
    filled = ceil(processor.worst * BAR)
    return "#" * min(filled, BAR) + "." * (BAR - filled) + ("!" if processor.worst > 1 else "")


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
                _time(process.deadline, "-"),
                process.verdict if process.verdict is not Verdict.UNKNOWN or response is None else "-",
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
            _time(requirement.value),
            requirement.verdict,
            _margin(requirement),
        )
        for requirement in ordered
    ]
    terminal.table(("requirement", "what", "limit", "value", "verdict", "margin"), rows, right=(3, 5))


def _limit(requirement: RequirementResult) -> str:
    if requirement.limit is None:
        return "-"
    return ("at most " if requirement.is_upper else "at least ") + time_text(requirement.limit)


def _margin(requirement: RequirementResult) -> str:
    return requirement.reason if requirement.margin is None else time_text(requirement.margin)


def _sensitivity(terminal: Terminal, found: Sensitivity | None) -> None:
    if found is None:
        return
    terminal.heading("Execution times may be multiplied by at most")
    rows = [("all together", _factor(found.everything)), *((name, _factor(f)) for name, f in found.processes.items())]
    terminal.table(("of", "factor"), rows, right=(1,))


def _factor(factor: Fraction | None) -> str:
    if factor is None:
        return "no factor helps"
    return f"{float(factor):.3f}" if factor < GREATEST else f"{GREATEST} or more"


def _proposal(terminal: Terminal, proposal: Proposal) -> None:
    terminal.heading(f"Priorities on {proposal.core}")
    if proposal.priorities is None:
        terminal.line(f"  nothing is proposed: {proposal.reason}")
        return
    ordered = sorted(proposal.priorities.items(), key=lambda item: -item[1])
    rows = [(name, "?" if (now := proposal.current[name]) is None else str(now), str(to)) for name, to in ordered]
    terminal.table(("task", "now", "proposed"), rows, right=(1, 2))


def _methods(terminal: Terminal, analysis: Analysis) -> None:
    methods = dict.fromkeys(
        f"{process.response.method} ({process.response.source})" for process in analysis.processes if process.response
    )
    if methods:
        terminal.heading("Methods")
        for method in methods:
            terminal.line(f"  {method}")


def write_explanation(analysis: Analysis, name: str, shares: Sequence[Share], stream: IO[str]) -> None:
    """What the response time of a process is made of, and whose jobs interfere."""
    terminal = Terminal(stream)
    process = next(process for process in analysis.processes if process.name == name)
    response = process.response
    if response is None:
        terminal.line(f"{terminal.style(name, '1')}: its response time is not known: {process.reason}")
        return
    if response.worst is None:
        terminal.line(f"{terminal.style(name, '1')}: its response time has no bound: {response.reason}")
        return
    terminal.line(f"{terminal.style(name, '1')}: worst-case response time {time_text(response.worst)} ({response.claim})")
    terms = [(term, time_text(value)) for term, value in response.terms.items() if value]
    terminal.table(("made of", ""), [*terms, ("sum", time_text(response.worst))], right=(1,))
    if shares:
        rows = [(share.name, share.jobs, time_text(share.time)) for share in shares]
        terminal.table(("interference by", "jobs", "time"), rows, right=(1, 2))
    terminal.line(f"  {response.method} ({response.source}), {response.jobs} jobs looked at")


def write_json(
    analysis: Analysis,
    extras: Extras,
    paths: Sequence[Path],
    findings: Sequence[Finding],
    all_methods: bool,
    stream: IO[str],
) -> None:
    """The same for programs; times are picoseconds under names that end in `_ps`."""
    result: dict[str, Any] = {
        "amuros": __version__,
        "model": " ".join(map(str, paths)),
        "assumptions": list(analysis.assumptions),
        "findings": [finding_json(finding) for finding in (*findings, *analysis.findings)],
        "processors": [
            {
                "name": processor.name,
                "utilisation": {
                    "bcet": _number(processor.best),
                    "acet": _number(processor.mean),
                    "wcet": _number(processor.worst),
                },
            }
            for processor in analysis.processors
        ],
        "processes": [_process_json(process) for process in analysis.processes],
        "chains": [chain_json(chain, all_methods) for chain in analysis.chains],
        "requirements": [
            {
                "name": requirement.name,
                "object": requirement.object,
                "quantity": requirement.quantity,
                "limit_ps": requirement.limit,
                "value_ps": requirement.value,
                "margin_ps": requirement.margin,
                "verdict": requirement.verdict,
                "reason": requirement.reason,
            }
            for requirement in analysis.requirements
        ],
    }
    if extras.sensitivity is not None:
        result["sensitivity"] = {
            "everything": _number(extras.sensitivity.everything),
            "processes": {name: _number(factor) for name, factor in extras.sensitivity.processes.items()},
        }
    if extras.proposals is not None:
        result["priorities"] = [
            {"processor": p.core, "current": p.current, "proposed": p.priorities, "reason": p.reason} for p in extras.proposals
        ]
    json.dump(result, stream, indent=2, ensure_ascii=False)
    stream.write("\n")


def _number(value: Fraction | None) -> float | None:
    return None if value is None else float(value)


def _process_json(process: ProcessResult) -> dict[str, Any]:
    response = process.response
    return {
        "name": process.name,
        "kind": "isr" if process.is_isr else "task",
        "processor": process.processor,
        "priority": process.priority,
        "preemption": process.preemption,
        "bcet_ps": process.bcet,
        "acet_ps": None if process.acet is None else round(process.acet),
        "wcet_ps": process.wcet,
        "bcrt_ps": response.best if response else None,
        "wcrt_ps": response.worst if response else None,
        "deadline_ps": process.deadline,
        "verdict": process.verdict,
        "reason": process.reason,
        "method": response.method if response else None,
        "source": response.source if response else None,
        "claim": response.claim if response else None,
        "terms": {f"{term.replace(' ', '_')}_ps": value for term, value in response.terms.items()} if response else {},
    }
