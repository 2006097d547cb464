"""What is in models, and what differs between them, as documents."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from amalthea_uros._internal.plural import counted
from amalthea_uros.difference.comparison import ChangeKind, ModelChange
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.metamodel.versions import spelled
from amalthea_uros.report.basics.document import (
    Lead,
    Line,
    ResultDocument,
    Section,
    Sentences,
    Tone,
    document,
    lines,
    section,
    table,
)

if TYPE_CHECKING:
    from amalthea_uros.design.changes.apply import Difference
    from amalthea_uros.design.changes.timing_changes import TimingChange
    from amalthea_uros.metamodel.element import Element
    from amalthea_uros.metamodel.summary import ModelSummary
    from amalthea_uros.services.diff import DiffResult
    from amalthea_uros.services.info import InfoResult

#: More classes and memories are only counted: the rare ones hide what matters.
_MOST_CLASSES, _MOST_MEMORIES = 12, 6


def info_document(result: InfoResult) -> ResultDocument:
    """Tables of the files, cores, processes, chains and classes of a model."""
    summary = result.summary
    unresolved = [counted(summary.unresolved, "unresolved reference")] if summary.unresolved else []
    chains = [(each.name, each.stimulus or "-", each.response or "-", f"{each.items}") for each in summary.chains]
    sections = (
        section("", lines(*_files(summary)), Sentences(unresolved)),
        _cores(summary),
        _processes(summary),
        section(f"Event chains ({len(chains)})", table("", ("name", "from", "to", ">items"), chains)),
        _classes(summary),
    )
    return document(sections)


def _files(summary: ModelSummary) -> Iterator[Lead]:
    for file in summary.documents:
        size = f", {file.characters / 1000:,.1f} kB" if file.characters else ", built in memory"
        version = spelled(file.version)
        if file.migrated_from is not None:
            version = f"{spelled(file.migrated_from)}, migrated to {file.version} in memory"
        zipped = ", zipped" if file.compressed else ""
        yield Lead(file.path, f": {version}, {counted(file.objects, 'object')}{size}{zipped}")


def _cores(summary: ModelSummary) -> Section:
    memories = ", ".join(summary.memories[:_MOST_MEMORIES])
    more = f" and {len(summary.memories) - _MOST_MEMORIES} more" if len(summary.memories) > _MOST_MEMORIES else ""
    title = f"Cores ({len(summary.cores)})" + (f", memories ({len(summary.memories)}): {memories}{more}" if memories else "")
    rows = [
        (core.name, core.structure, core.definition, core.frequency, ", ".join(core.schedulers) or "-")
        for core in summary.cores
    ]
    return section(title, table("", ("core", "in", "type", ">clock", "schedulers"), rows))


def _processes(summary: ModelSummary) -> Section:
    tasks = sum(process.kind == "task" for process in summary.processes)
    rows = [
        (
            each.name,
            each.kind,
            "; ".join(each.stimuli) or "-",
            str(each.priority or "-"),
            each.preemption or "-",
            each.scheduler or "-",
            f"{each.runnable_calls}",
        )
        for each in summary.processes
    ]
    titles = ("name", "kind", "activated", ">priority", "preemption", "scheduler", ">calls")
    return section(f"Tasks ({tasks}) and ISRs ({len(rows) - tasks})", table("", titles, rows))


def _classes(summary: ModelSummary) -> Section:
    shown = list(summary.counts.items())
    rest = shown[_MOST_CLASSES:] if len(shown) > _MOST_CLASSES + 1 else []
    rows = [(f"{count:,}", name) for name, count in shown[: len(shown) - len(rest)]]
    if rest:
        rows.append((f"{sum(count for _, count in rest):,}", f"of {len(rest)} more classes"))
    title = f"Objects ({sum(summary.counts.values()):,} of {counted(len(summary.counts), 'class')})"
    return section(title, table("", (">count", "class"), rows))


#: The marks and colours of what is added, removed and changed.
_ADDED, _REMOVED, _CHANGED = ("+", Tone.GOOD), ("-", Tone.BAD), ("~", Tone.UNKNOWN)
_MARKS = {ChangeKind.ADDED: _ADDED, ChangeKind.REMOVED: _REMOVED, ChangeKind.CHANGED: _CHANGED, ChangeKind.MOVED: _CHANGED}
#: The values that say what an object is, with the words before them.
_IDENTIFYING = {"period": "every ", "execution_time": "", "priority": "priority ", "core": "", "frequency": ""}


def diff_document(result: DiffResult) -> ResultDocument:
    """What changes the timing, all changes grouped by object, how many there are, and what they do to the results."""
    from amalthea_uros.report.documents.changes import impact_section

    groups: dict[tuple[Element | None, Element | None], list[ModelChange]] = {}
    for change in result.changes:
        groups.setdefault((change.old_element, change.new_element), []).append(change)
    impact = [] if result.impact is None else [impact_section(result.impact)]
    if result.described:
        summary = lines(f"{counted(len(result.described), 'difference')} of the descriptions")
        differences = [section("", *map(_described, result.described))]
    else:
        summary = lines(_summary(result.changes))
        differences = [
            section("Timing", Sentences(list(map(_timing_text, result.timing)))),
            section("Objects" if result.timing else "", *(block for group in groups.values() for block in _object(group))),
        ]
    sections = (
        *differences,
        section("", summary),
        *impact,
    )
    return document(sections, kept=[summary, *(block for each in impact for block in each.blocks)])


def _described(difference: Difference) -> Sentences:
    """A value of a description before and after, or an object that only one of them has."""
    from amalthea_uros.design.description.comparison import PRESENT

    if PRESENT in (difference.before, difference.after):
        mark, tone = _ADDED if difference.after == PRESENT else _REMOVED
        return Sentences([Lead(f"{mark} {difference.target}", "", tone)])
    return Sentences([str(difference)])


def _object(group: Sequence[ModelChange]) -> Iterator[Sentences]:
    """An object that differs, and what of it; of a whole object its content and the number of its parts."""
    first = group[0]
    mark, tone = _MARKS[first.kind]
    known = ""
    if not first.feature:
        parts = sum(1 for _ in _element(first).walk()) - 1
        known = ", ".join(filter(None, (first.old, first.new, counted(parts, "part") if parts else "")))
    name = f"{mark} {first.class_name} {first.qualified_name}"
    yield lines(Lead(name, f" ({known})" if known else "", tone))
    yield Sentences([_sentence(change) for change in group if change.feature], indent=4)


def _element(change: ModelChange) -> Element:
    element = change.new_element or change.old_element
    assert element is not None
    return element


def _sentence(change: ModelChange) -> str:
    if change.kind is ChangeKind.MOVED:
        return f"moved: {change.old} -> {change.new}"
    features = features_of(type(_element(change))).values()
    if any(feature.many and feature.xml_name == change.feature for feature in features):
        return f"{change.feature}: {', '.join(filter(None, (change.old, change.new)))}"
    return f"{change.feature}: {change.old} -> {change.new}"


def _summary(changes: Sequence[ModelChange]) -> str:
    if not changes:
        return "no differences in meaning"
    counts = Counter(change.kind for change in changes)
    listed = ", ".join(f"{counts[kind]} {kind}" for kind in ChangeKind if counts[kind])
    return f"{counted(len(changes), 'difference')}: {listed}"


def _timing_text(change: TimingChange) -> Line:
    """A process, core or stimulus that is added, removed, or has other values."""
    # `amuros info` does without systems.
    from amalthea_uros.design.changes.timing_changes import Happening
    from amalthea_uros.report.wording.cells import words

    if change.happening is Happening.CHANGED:
        values = ", ".join(f"{words(each.key)} {each.before} -> {each.after}" for each in change.differences)
        return f"{change.object}: {values}"
    is_added = change.happening is Happening.ADDED
    mark, tone = _ADDED if is_added else _REMOVED
    stated = {each.key: each.after if is_added else each.before for each in change.differences}
    values = ", ".join(f"{word}{stated[key]}" for key, word in _IDENTIFYING.items() if key in stated)
    return Lead(f"{mark} {change.kind} {change.object}", f" ({values})" if values else "", tone)
