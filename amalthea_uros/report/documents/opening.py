"""What a report says first: the verdict with its causes, and how large the system is."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.results.analysis import Judged
from amalthea_uros.diagnostics import Finding
from amalthea_uros.findings.grouping import names_in
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.report.basics.document import (
    Tone,
)
from amalthea_uros.report.documents.judged import concerned, judged_items, why
from amalthea_uros.report.wording.answer import answer_lines
from amalthea_uros.report.wording.cells import tone_of, verdict_badge
from amalthea_uros.report.wording.closing_line import closing_line
from amalthea_uros.services.report import ReportContent

#: What is missed or unknown is listed up to so many items.
_MOST_REASONS = 12


#: More names that have one reason are only counted.
_MOST_NAMES = 4


_WORDS = {Tone.GOOD: "Schedulable", Tone.BAD: "Not schedulable", Tone.UNKNOWN: "Not proved schedulable"}


@dataclass(frozen=True, slots=True)
class Opening:
    """What the page says first.

    Attributes
    ----------
    word, line : in a few words, and the closing line of an analysis
    answer : what the verdict depends on, what most of it is, and what would help
    reasons : what is missed or unknown, and why
    """

    tone: Tone
    word: str
    line: str
    answer: Sequence[str]
    reasons: Sequence[tuple[str, str]]
    left_out: int


def facts(content: ReportContent) -> str:
    """How large the system is."""
    system = content.system
    wires = system.network.wires
    cores = len(system.cores.keys() - system.network.wire_cores)
    numbers = {"core": cores, "wire": len(wires), "task": len(system.software.tasks), "interrupt": len(system.software.isrs)}
    numbers |= {"runnable": len(system.software.runnables), "event chain": len(system.chains)}
    numbers |= {"limit": len(judged_items(content.analysis))}
    return ", ".join(counted(number, noun) for noun, number in numbers.items() if number)


def _together(reasons: Iterable[tuple[str, str]]) -> Iterator[tuple[str, str]]:
    """Each reason once, with the names of all that have it."""
    names: dict[str, list[str]] = {}
    for name, reason in reasons:
        names.setdefault(reason, []).append(name)
    for reason, found in names.items():
        distinct = list(dict.fromkeys(found))
        more = f" and {len(distinct) - _MOST_NAMES} more" if len(distinct) > _MOST_NAMES else ""
        yield ", ".join(distinct[:_MOST_NAMES]) + more, reason


def _unreported(warnings: Iterable[Finding], rows: Iterable[Judged]) -> Iterator[Finding]:
    """The warnings without those that give the reason of a row, or of another warning, for the same object once more."""
    # Such as "it has no priority; as the lowest it needs up to 9 us".
    stated = [(row, reason) for row in rows for reason in (why(row), why(row).partition("; ")[0])]
    reported = {(name, reason) for row, reason in stated for name in (row.name, concerned(row))}
    for warning in warnings:
        # Such as "the chain 'c' is not evaluated: the event has no event type".
        what, _, reason = warning.message.partition(": ")
        repeated = {(name, reason) for name in names_in(replace(warning, message=what))}
        if not reason or reported.isdisjoint(repeated):
            yield warning
        reported |= repeated


def opening(content: ReportContent) -> Opening:
    """The verdict, and what is missed or unknown."""
    summary = content.analysis.summary
    tone = tone_of(summary.schedulable)
    overloads = [(core.name, "the core is overloaded") for core in summary.overloaded]
    rows = [item for item in judged_items(content.analysis) if item.verdict is not Verdict.MET]
    others = _together((item.name, ": ".join(filter(None, (verdict_badge(item).word, why(item))))) for item in rows)
    warnings = [(each.rule, each.message) for each in _unreported(content.warnings, rows)]
    reasons = list(dict.fromkeys((*overloads, *others, *warnings)))
    answer = () if content.answer is None else tuple(answer_lines(content.answer))
    return Opening(
        tone, _WORDS[tone], closing_line(summary), answer, reasons[:_MOST_REASONS], max(0, len(reasons) - _MOST_REASONS)
    )
