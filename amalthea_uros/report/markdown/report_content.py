"""The summary of a report as Markdown, short enough for a comment on GitHub."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.impact import impact
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.report.closing_line import closing_line
from amalthea_uros.report.judged import judged_rows, limit_text, margin_text, requirements_of, why, worst_chains
from amalthea_uros.report.latencies import value_text
from amalthea_uros.report.markdown_text import escaped, table
from amalthea_uros.report.message_chains import HEADINGS as MESSAGE_HEADINGS
from amalthea_uros.report.message_chains import RIGHT as MESSAGE_RIGHT
from amalthea_uros.report.message_chains import latency_row
from amalthea_uros.report.simulated import REMINDER
from amalthea_uros.report.simulated import closing_line as observed_line
from amalthea_uros.services.impact_text import HEADINGS, RIGHT, cells, unchanged_text
from amalthea_uros.services.report import ReportContent

#: GitHub accepts 65,536 characters in a comment; names may be long.
_MOST_CHARACTERS = 60_000
_MOST_ROWS, _MOST_CHANGES = 10, 40
_MOST_NAME, _MOST_MESSAGE = 80, 300
_ICONS = {
    Schedulable.YES: "\N{WHITE HEAVY CHECK MARK}",
    Schedulable.NO: "\N{CROSS MARK}",
    Schedulable.UNKNOWN: "\N{BLACK QUESTION MARK ORNAMENT}",
}


def lines(content: ReportContent) -> Iterator[str]:
    """The verdict, the tightest requirements and the worst chains, and with changes what they did."""
    length = 0
    for line in _all_lines(content):
        length += len(line) + 1
        if length > _MOST_CHARACTERS:
            yield from ("", "The rest is left out, because comments have a limited length.")
            return
        yield line


def _all_lines(content: ReportContent) -> Iterator[str]:
    summary = content.analysis.summary
    yield f"## {_ICONS[summary.schedulable]} Timing of {escaped(_short(content.title))}"
    if content.date:
        yield from ("", escaped(content.date))
    yield from ("", escaped(closing_line(summary)))
    yield from _warnings(content)
    yield from _changes(content)
    yield from _requirements(content)
    yield from _message_chains(content)
    yield from _chains(content)
    if content.simulation is not None:
        line = observed_line(content.simulation.simulation).removesuffix(REMINDER).rstrip()
        yield from ("", f"{escaped(line)} Observed values are no bounds.")


def _warnings(content: ReportContent) -> Iterator[str]:
    found = content.warnings
    if not found:
        return
    yield from ("", "The verdict is subject to these findings:", "")
    yield from (f"- {each.rule} {each.severity}: {escaped(_short(each.message, _MOST_MESSAGE))}" for each in found[:_MOST_ROWS])
    if len(found) > _MOST_ROWS:
        yield f"- {counted(len(found) - _MOST_ROWS, 'more finding')}"


def _changes(content: ReportContent) -> Iterator[str]:
    if content.before is None:
        return
    rows = [(each.target, each.before, each.after) for each in content.differences]
    yield from ("", "### Changes", "", *_table(("value", "before", "after"), rows))
    found = impact(content.before, content.analysis)
    if found.rows:
        left_out = max(0, len(found.rows) - _MOST_CHANGES)
        shown = cells(found)[:_MOST_CHANGES]
        yield from ("", "### Before and after", "", *_table(HEADINGS, shown, right=RIGHT))
        yield from (
            "",
            *([f"{counted(left_out, 'more row')} not shown."] if left_out else []),
            escaped(f"{unchanged_text(found)}."),
        )
    yield from ("", escaped(f"Before the changes: {closing_line(content.before.summary)}"))


def _requirements(content: ReportContent) -> Iterator[str]:
    found = judged_rows(content.analysis)
    if not found:
        return
    rows = [
        (row.item.name, row.what, row.value, row.limit, row.margin, row.claim, str(row.item.verdict), why(row.item))
        for row in islice(found, _MOST_ROWS)
    ]
    yield from ("", f"### {counted(len(found), 'requirement')}, what is closest to its limit first", "")
    yield from _table(("requirement", "what", "value", "limit", "margin", "claim", "verdict", "why"), rows, right=(2, 3, 4))


def _message_chains(content: ReportContent) -> Iterator[str]:
    chains = content.analysis.message_chains
    if not chains:
        return
    yield from ("", "### Latency of messages, end to end", "")
    yield from _table((*MESSAGE_HEADINGS, "why"), list(map(latency_row, chains[:_MOST_ROWS])), right=MESSAGE_RIGHT)
    if len(chains) > _MOST_ROWS:
        yield from ("", f"{counted(len(chains) - _MOST_ROWS, 'more chain')} not shown.")


def _chains(content: ReportContent) -> Iterator[str]:
    chains = worst_chains(content.analysis)
    if not chains:
        return
    rows = []
    for chain in chains[:_MOST_ROWS]:
        worst = next(iter(requirements_of(chain.name, content.analysis)), None)
        limits = (
            ("-", "-", "") if worst is None else (f"{worst.quantity} {limit_text(worst)}", margin_text(worst), worst.verdict)
        )
        quantities = (LatencyQuantity.MAX_REDUCED_REACTION_TIME, LatencyQuantity.MAX_REDUCED_DATA_AGE)
        values = [chain.value(quantity) for quantity in quantities]
        claims = dict.fromkeys(str(value.claim) for value in values if value is not None and value.value is not None)
        rows.append((chain.name, *map(value_text, values), ", ".join(claims), *limits, chain.reason))
    yield from ("", f"### Worst of {counted(len(chains), 'event chain')}", "")
    headings = ("chain", "reaction time", "data age", "claim", "limit", "margin", "verdict", "why")
    yield from _table(headings, rows, right=(1, 2, 4, 5))


def _table(headings: Sequence[str], rows: Sequence[Sequence[object]], right: Sequence[int] = ()) -> Iterator[str]:
    """A table with shortened texts, without columns in which there is nothing."""
    kept = [number for number in range(len(headings)) if any(row[number] not in ("", "-") for row in rows)]
    shown = [[_short(str(row[number])) for number in kept] for row in rows]
    return table([headings[number] for number in kept], shown, [index for index, number in enumerate(kept) if number in right])


def _short(text: str, most: int = _MOST_NAME) -> str:
    """The text, or its start if it is long: a name may be of any length."""
    return text if len(text) <= most else f"{text[:most]}\N{HORIZONTAL ELLIPSIS}"
