"""What a migration loses: of files that are migrated while they are read, and of models that go back to an older version."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.metamodel.versions import spelled
from amalthea_uros.xmi.emf.reader import read
from amalthea_uros.xmi.emf.versions import is_older
from amalthea_uros.xmi.migrate.load import MigratedSet
from amalthea_uros.xmi.tree.notes import NoteKind


def announcements(migrated: MigratedSet) -> list[Finding]:
    """That files were migrated in memory, and what was lost."""
    models = migrated.models
    places = [place for place in range(len(models.trees)) if not migrated.is_unchanged(place)]
    if not places:
        return []
    first = models.trees[places[0]]
    others = f" ({len(places)} files)" if len(places) > 1 else ""
    stated = ", ".join(dict.fromkeys(spelled(migrated.versions[place]) for place in places))
    files = "the files are" if len(places) > 1 else "the file is"
    message = f"{stated} was migrated to {migrated.target} in memory{others}; {files} unchanged"
    help_text = "`amuros migrate` writes the model in a newer version, with a report of what was converted."
    where = models.origins.location(first.root.origin)
    return [Finding("XMI008", Severity.INFO, message, where, help_text), *_losses(migrated)]


#: So many kinds of lost content are named; the report of the command names all.
_NAMED = 4


def _losses(migrated: MigratedSet) -> list[Finding]:
    """What the migration could not keep, in one finding at the first place."""
    lost = [note for note in migrated.notes if note.kind is NoteKind.LOST]
    if not lost:
        return []
    first = lost[0]
    numbers = Counter(note.message for note in lost)
    if len(numbers) == 1:
        detail = f": {first.detail}" if first.detail else ""
        what = f"{first.message}{detail}" + (f" ({len(lost):,} times, this is the first)" if len(lost) > 1 else "")
    else:
        named = [f"{message} ({number:,})" for message, number in numbers.most_common(_NAMED)]
        rest = f" and {len(numbers) - _NAMED} more kinds" if len(numbers) > _NAMED else ""
        what = f"{', '.join(named)}{rest}; this is the first place"
    origins = migrated.models.origins
    help_text = "The new version has no place for it. `amuros migrate --dry-run` lists everything that is converted or lost."
    where = origins.location(first.origin, first.attribute)
    message = f"lost in the migration to {migrated.target}: {what}"
    return [Finding("XMI009", Severity.WARNING, message, where, help_text, origins.object_name(first.origin))]


# Migration back: why it is refused

#: What the reader says about content that is not in the model: unknown, misplaced, wrong or given twice.
_NOT_IN_THE_MODEL = frozenset({"XMI010", "XMI011", "XMI012", "XMI013", "XMI014"})

#: So many objects are named for each thing that is lost; the others are counted.
_NAMED_OBJECTS = 20

_TIMES = re.compile(r" \((\d[\d,]*) times, this is the first\)$")
_VERSION = re.compile(r" ?\(?(?:of )?AMALTHEA [\d.]+\)?")


def losses_of_going_back(migrated: MigratedSet) -> list[Finding]:
    """An error for each thing that a set of files would lose; none if no file of it was newer before."""
    if not migrated.is_down:
        return []
    help_text = f"Remove it from the model, or choose a version newer than {migrated.target}."
    lost = list(_noted(migrated))
    places = {_place(where) for _, where, _ in lost}
    before = Counter(_keys(_findings_before(migrated)))
    for finding in migrated.model.findings if migrated.model else ():
        if finding.rule in _NOT_IN_THE_MODEL:
            key, number = _key(finding)
            # A step knows better than the reader what is lost.
            if number > before[key] and _place(finding.location) not in places:
                lost.append((finding.message, finding.location, finding.object))
    return [
        Finding("XMI102", Severity.ERROR, f"AMALTHEA {migrated.target} cannot hold this: {message}", where, help_text, name)
        for message, where, name in lost
    ]


def _place(where: Location | None) -> tuple[str, int | None, int | None] | None:
    return (str(where.path), where.line, where.column) if where is not None else None


def _noted(migrated: MigratedSet) -> Iterable[tuple[str, Location | None, str]]:
    origins = migrated.models.origins
    notes = [note for note in migrated.notes if note.kind is NoteKind.LOST and note.version]
    total = Counter(note.message for note in notes)
    named: Counter[str] = Counter()
    for note in notes:
        named[note.message] += 1
        if named[note.message] > _NAMED_OBJECTS:
            continue
        rest = total[note.message] - _NAMED_OBJECTS
        more = f" (and {rest:,} more of this kind)" if named[note.message] == _NAMED_OBJECTS and rest > 0 else ""
        message = f"{note.message}: {note.detail}" if note.detail else note.message
        yield message + more, origins.location(note.origin, note.attribute), origins.object_name(note.origin)


def _findings_before(migrated: MigratedSet) -> Iterable[Finding]:
    """What the files say in their own version."""
    for tree, version in zip(migrated.models.trees, migrated.versions, strict=True):
        if not is_older(version):
            try:
                yield from read(tree.path, tree.content).findings
            except ReadError:
                continue


def _keys(findings: Iterable[Finding]) -> dict[str, int]:
    found: dict[str, int] = {}
    for finding in findings:
        key, number = _key(finding)
        found[key] = found.get(key, 0) + number
    return found


def _key(finding: Finding) -> tuple[str, int]:
    """What a finding is about, whatever the version, and how often it occurs."""
    times = _TIMES.search(finding.message)
    text = _VERSION.sub("", _TIMES.sub("", finding.message))
    return f"{finding.rule} {text}", int(times[1].replace(",", "")) if times else 1
