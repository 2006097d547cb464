"""The summary of a report, short enough for a comment on GitHub."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros._internal.plural import counted
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.report.basics.document import Block, ResultDocument, Section, Sentences, Table, document, section, table
from amalthea_uros.report.documents.analysis import latencies_of_messages
from amalthea_uros.report.documents.judged import limits_table
from amalthea_uros.report.documents.page import chains_table
from amalthea_uros.report.documents.simulation import REMINDER
from amalthea_uros.report.documents.simulation import closing_line as observed_line
from amalthea_uros.report.wording.closing_line import closing_line
from amalthea_uros.services.report import ReportContent

_MOST_ROWS, _MOST_CHANGES = 10, 40
_MOST_NAME, _MOST_MESSAGE = 80, 300
_ICONS = {
    Schedulable.YES: "\N{WHITE HEAVY CHECK MARK}",
    Schedulable.NO: "\N{CROSS MARK}",
    Schedulable.UNKNOWN: "\N{BLACK QUESTION MARK ORNAMENT}",
}


def summary_document(content: ReportContent) -> ResultDocument:
    """The verdict, the tightest requirements and the worst chains, and with changes what they did."""
    summary = content.analysis.summary
    title = f"{_ICONS[summary.schedulable]} Timing of {_short(content.title, _MOST_NAME)}"
    return document(_sections(content), closing_line(summary), title, content.date)


def _sections(content: ReportContent) -> Iterator[Section]:
    warnings = [f"{each.rule} {each.grade}: {_short(each.message, _MOST_MESSAGE)}" for each in content.warnings]
    yield section("The verdict is subject to these findings", Sentences(_first(warnings, "more finding")))
    if content.before is not None:
        rows = [(each.target, each.before, each.after) for each in content.differences]
        yield section("Changes", table("", ("value", "before", "after"), rows))
        from amalthea_uros.report.documents.changes import comparison_section

        found = comparison_section(content.before, content.analysis)
        before = Sentences([f"Before the changes: {closing_line(content.before.summary)}"])
        yield section(found.title, *(_shown(block, _MOST_CHANGES) for block in found.blocks), before)
    limits = limits_table(content.analysis)
    title = f"{counted(len(limits.rows), 'requirement')}, what is closest to its limit first"
    yield section(title, limits.first(_MOST_ROWS))
    messages = latencies_of_messages(content.analysis)
    yield section(messages.caption, messages.first(_MOST_ROWS), _rest(messages, "more chain"))
    chains = chains_table(content.analysis)
    yield section(f"Worst of {counted(len(chains.rows), 'event chain')}", chains.first(_MOST_ROWS))
    if content.simulation is not None:
        line = observed_line(content.simulation.simulation).removesuffix(REMINDER).rstrip()
        yield section("Simulation", Sentences([f"{line} Observed values are no bounds."]))


def _first(sentences: list[str], more: str) -> list[str]:
    rest = len(sentences) - _MOST_ROWS
    return [*sentences[:_MOST_ROWS], *([counted(rest, more)] if rest > 0 else [])]


def _rest(shown: Table, more: str) -> Sentences:
    rest = len(shown.rows) - _MOST_ROWS
    return Sentences([f"{counted(rest, more)} not shown."] if rest > 0 else [])


def _shown(block: Block, most: int) -> Block:
    return block.first(most) if isinstance(block, Table) else block


def _short(text: str, most: int) -> str:
    return text if len(text) <= most else f"{text[:most]}\N{HORIZONTAL ELLIPSIS}"
