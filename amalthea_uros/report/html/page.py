"""A report as one HTML page, which needs nothing outside of itself."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from amalthea_uros._internal.addresses import DOCUMENTATION
from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.resources import resource_folder
from amalthea_uros._version import __version__
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.report.closing_line import closing_line
from amalthea_uros.report.escape import visible
from amalthea_uros.report.html.badges import tone_of, verdict_badge
from amalthea_uros.report.html.blocks import Section, Tone
from amalthea_uros.report.html.sections import (
    bus,
    changes,
    executors,
    findings,
    histograms,
    hops,
    load,
    message_chains,
    methods,
    observed,
    pools,
    response_times,
    system,
    tightest,
    worst_window,
)
from amalthea_uros.report.judged import judged_rows, why
from amalthea_uros.report.pictures.style import style_sheet
from amalthea_uros.services.report import ReportContent

#: The sections in their order; those that have nothing to show are left out.
_SECTIONS: Sequence[Callable[[ReportContent], Section | None]] = (
    changes.section,
    tightest.section,
    message_chains.section,
    system.section,
    load.section,
    response_times.section,
    executors.section,
    observed.section,
    worst_window.section,
    histograms.section,
    hops.section,
    findings.section,
    methods.section,
    bus.section,
    pools.section,
)

#: What is missed or unknown is listed up to so many items.
_MOST_REASONS = 12
#: More names that have one reason are only counted.
_MOST_NAMES = 4
_WORDS = {Tone.GOOD: "Schedulable", Tone.BAD: "Not schedulable", Tone.UNKNOWN: "Unknown whether schedulable"}


@dataclass(frozen=True, slots=True)
class Opening:
    """What the page says first.

    Attributes
    ----------
    word, line : in a few words, and the closing line of an analysis
    reasons : what is missed or unknown, and why
    """

    tone: Tone
    word: str
    line: str
    reasons: Sequence[tuple[str, str]]
    left_out: int


def render(content: ReportContent) -> str:
    """The page."""
    sections = [section for make in _SECTIONS if (section := make(content)) is not None]
    template = _environment().get_template("page.html.jinja")
    return template.render(
        title=content.title,
        date=content.date,
        facts=_facts(content),
        verdict=_verdict(content),
        sections=sections,
        picture_style=Markup(style_sheet()),
        version=__version__,
        documentation=DOCUMENTATION,
    )


def _environment() -> Environment:
    environment = Environment(
        loader=FileSystemLoader(resource_folder("templates/report")),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        finalize=_finalized,
    )
    environment.filters["file"] = _file
    return environment


def _finalized(value: object) -> object:
    """Text of models without hidden characters, which could pretend to be other text."""
    return visible(value) if isinstance(value, str) and not isinstance(value, Markup) else value


def _file(name: str) -> Markup:
    """A file of ours, to be a part of the page."""
    return Markup((resource_folder("templates/report") / name).read_text(encoding="utf-8"))


def _facts(content: ReportContent) -> str:
    """How large the system is."""
    system = content.system
    numbers = {"core": len(system.cores), "task": len(system.software.tasks), "interrupt": len(system.software.isrs)}
    numbers |= {"runnable": len(system.software.runnables), "event chain": len(system.chains)}
    numbers |= {"limit": len(judged_rows(content.analysis))}
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


def _verdict(content: ReportContent) -> Opening:
    summary = content.analysis.summary
    tone = tone_of(summary.schedulable)
    overloads = [(core.name, "the core is overloaded") for core in summary.overloaded]
    rows = (row.item for row in judged_rows(content.analysis) if row.item.verdict is not Verdict.MET)
    others = _together((item.name, ": ".join(filter(None, (verdict_badge(item).word, why(item))))) for item in rows)
    warnings = [(each.rule, each.message) for each in content.warnings]
    reasons = list(dict.fromkeys((*overloads, *others, *warnings)))
    return Opening(tone, _WORDS[tone], closing_line(summary), reasons[:_MOST_REASONS], max(0, len(reasons) - _MOST_REASONS))
