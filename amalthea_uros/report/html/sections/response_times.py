"""Response times and what they consist of."""

from __future__ import annotations

from amalthea_uros.analyze.explanations.processes import ProcessExplanation, explain_process
from amalthea_uros.analyze.results.processes import ProcessResult
from amalthea_uros.report.html.badges import verdict_badge
from amalthea_uros.report.html.blocks import Block, Cell, Figure, Folded, Section, Table, table
from amalthea_uros.report.html.times import at_least, at_most, deadline_text
from amalthea_uros.report.judged import judged_rows, why
from amalthea_uros.report.pictures.response_bars import draw_responses
from amalthea_uros.report.process_order import by_core_and_priority
from amalthea_uros.services.report import ReportContent
from amalthea_uros.units import time_text

#: The processes whose interference is listed, the tightest first.
_MOST_EXPLAINED = 5


def section(content: ReportContent) -> Section | None:
    """All processes; of the tightest, who interferes."""
    analysis = content.analysis
    if not analysis.processes:
        return None
    ordered = sorted(analysis.processes, key=lambda each: by_core_and_priority(each.processor, each.is_isr, each.priority))
    terms = list(dict.fromkeys(term for each in ordered if each.response is not None for term in each.response.terms))
    times = ("WCET", "best", "worst", *terms, "deadline")
    titles = ("process", "core", ">priority", *(f">{time}" for time in times), "claim", "verdict", "why")
    simulation = content.simulation.simulation if content.simulation is not None else None
    blocks: list[Block] = [Figure("responses", draw_responses(analysis, simulation))]
    blocks += [table("Response times by core and priority", titles, [_row(each, terms) for each in ordered])]
    blocks += [_explained(each) for each in _tightest(content)]
    if analysis.of_periodic_executors:
        blocks.append(_callbacks(content))
    lead = "From the activation of a task to its end: the worst case is the sum of its own execution and of what delays it."
    return Section("response-times", "Response times", lead, blocks)


def _row(process: ProcessResult, terms: list[str]) -> tuple[Cell, ...]:
    response = process.response
    parts = response.terms if response is not None and response.worst is not None else {}
    return (
        process.name,
        process.processor or "unknown",
        "unknown" if process.priority is None else f"{'ISR ' if process.is_isr else ''}{process.priority}",
        at_most(process.wcet),
        at_least(response.best if response is not None else None),
        at_most(response.worst if response is not None else None, process.deadline),
        *(at_most(parts[term]) if parts.get(term) else "-" for term in terms),
        deadline_text(process.deadline, process.is_implicit),
        str(response.claim) if response is not None and response.worst is not None else "",
        verdict_badge(process),
        why(process),
    )


def _tightest(content: ReportContent) -> list[ProcessExplanation]:
    """The explanations of the processes with the tightest response times."""
    analysis = content.analysis
    names = [row.item.name if isinstance(row.item, ProcessResult) else row.item.object for row in judged_rows(analysis)]
    found = [analysis.processes[name] for name in dict.fromkeys(names) if name in content.system.processes]
    known = [each.name for each in found if each.response is not None and each.response.worst is not None]
    explained = (explain_process(analysis, name) for name in known)
    return [each for _, each in zip(range(_MOST_EXPLAINED), (each for each in explained if each.shares), strict=False)]


def _explained(explanation: ProcessExplanation) -> Folded:
    name = explanation.process.name
    rows = [(share.name, f"{share.jobs:,}", time_text(share.time)) for share in explanation.shares]
    shares = table(f"Interference in the worst case of {name}", ("by", ">jobs", ">time"), rows)
    return Folded(f"What delays {name}", [shares])


def _callbacks(content: ReportContent) -> Table:
    rows = []
    for callback in content.analysis.of_periodic_executors:
        response = callback.response
        rows.append(
            (
                callback.name,
                callback.process,
                at_least(response.best if response is not None else None),
                at_most(response.worst if response is not None else None, callback.deadline),
                deadline_text(callback.deadline, is_implicit=False),
                str(response.claim) if response is not None else "",
                callback.reason,
            )
        )
    titles = ("callback", "process", ">best", ">worst", ">deadline", "claim", "why")
    return table("Callbacks, from the activation of the process to the end of the callback", titles, rows)
