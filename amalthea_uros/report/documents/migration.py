"""A migration as a document: the files, what was lost, and what each step did."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass
from amalthea_uros.metamodel.versions import spelled
from amalthea_uros.report.basics.document import ResultDocument, Sentences, document, section, table
from amalthea_uros.report.wording.cells import shortened
from amalthea_uros.services.migrate import FileState, MigratedFile, MigrationChange, MigrationResult, NoteKind

#: Of more versions only the first and the last are named.
_MOST_VERSIONS = 3
#: Longer examples, such as a whole element as text, are cut.
_WIDTH = 60


@dataclass(frozen=True, slots=True)
class ChangeGroup:
    """The same thing that happened to several objects in one step: how often, and the first of them."""

    count: int
    first: MigrationChange

    @property
    def place(self) -> str:
        """Where the first one is: file and line."""
        where = self.first.location
        return f"{where.path}:{where.line}" if where is not None else ""


@dataclass(frozen=True, slots=True)
class StepReport:
    """What a step did, in the order of the first occurrence; `version` is the one to which it leads, "" for reading."""

    version: str
    groups: tuple[ChangeGroup, ...]

    @property
    def title(self) -> str:
        """The heading."""
        return f"To {spelled(self.version)}" if self.version else "Reading"


def steps(result: MigrationResult) -> list[StepReport]:
    """What happened, by step in the order of the migration."""
    grouped: dict[str, dict[tuple[str, str], list[MigrationChange]]] = {}
    for change in result.changes:
        grouped.setdefault(change.step, {}).setdefault((change.kind, change.message), []).append(change)
    goal = _version_key(result.version)
    back = sorted((step for step in grouped if _version_key(step) > goal), key=_version_key, reverse=True)
    on = sorted((step for step in grouped if _version_key(step) <= goal), key=_version_key)
    return [
        StepReport(step, tuple(ChangeGroup(len(changes), changes[0]) for changes in grouped[step].values()))
        for step in [*on[: on.count("")], *back, *on[on.count("") :]]
    ]


def summary(result: MigrationResult) -> str:
    """The closing line: "3 files: AMALTHEA 0.7.2 -> 3.3.0, 10,000 converted, 2 lost"."""
    done = [file for file in result.files if file.state in (FileState.WRITTEN, FileState.PLANNED, FileState.MIGRATED)]
    parts = []
    if done:
        parts.append(f"{counted(len(done), 'file')}: {_from(file.version for file in done)} -> {result.version}")
        parts += _counts(result.changes) or ["nothing else to convert"]
    if as_is := sum(file.state is FileState.AS_IS for file in result.files):
        has = "has" if as_is == 1 else "have"
        parts.append(f"{counted(as_is, 'file')} {has} {spelled(result.version)} already")
    if failed := sum(file.state is FileState.FAILED for file in result.files):
        parts.append(f"{counted(failed, 'file')} not written")
    if any(file.state is FileState.PLANNED for file in result.files):
        parts.append("dry run")
    return ", ".join(parts)


def _from(versions: Iterable[str]) -> str:
    """The versions before, or the range of many."""
    found = sorted(set(versions), key=_version_key)
    if len(found) > _MOST_VERSIONS:
        return f"{spelled(found[0])} to {found[-1]}"
    return ", ".join(map(spelled, found))


def _counts(changes: Iterable[MigrationChange]) -> list[str]:
    counts = Counter(change.kind for change in changes)
    return [f"{counts[kind]:,} {kind}" for kind in NoteKind if counts[kind]]


def _version_key(version: str) -> tuple[int, ...]:
    number = version.rpartition(" ")[2]
    is_itea = number != version
    digits = [int(part) for part in number.split(".") if part.isdigit()]
    return (0 if is_itea else 1, *digits) if version else ()


def migration_document(result: MigrationResult) -> ResultDocument:
    """The files, everything that was lost, what each step did, and the sum of it."""
    lost = ((each.object, each.location or "", each.message, each.detail) for each in result.lost)
    sections = (
        section("Files", Sentences(list(map(_file_text, result.files)))),
        section("Lost", table("", ("object", "place", "what", "detail"), ([*map(str, row)] for row in lost)), is_detail=True),
        *(section(step.title, table("", _COLUMNS, map(_group_row, step.groups))) for step in steps(result)),
    )
    return document(sections, summary(result), f"Migration to {spelled(result.version)}", findings=result.findings)


_COLUMNS = (">number", "", "what", "example", "first")


def _file_text(file: MigratedFile) -> str:
    version = f"{spelled(file.version)}, " if file.version else ""
    return f"{file.path}: {version}{file.state}" + (f" to {file.target}" if file.target is not None else "")


def _group_row(group: ChangeGroup) -> tuple[str, ...]:
    example = shortened(group.first.detail or group.first.object, _WIDTH)
    return (f"{group.count:,}", str(group.first.kind), group.first.message, example, group.place)
