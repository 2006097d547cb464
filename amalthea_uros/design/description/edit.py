"""An `app.yaml` with other values: its text is changed where they are written, and the result is read again and compared."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from amalthea_uros._internal.paths import TEXT
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.changes.changed_model import changed_system
from amalthea_uros.design.description import text_edits
from amalthea_uros.design.description.meaning import arrival_periods, differences, meaning
from amalthea_uros.design.description.places import Assignment, Places
from amalthea_uros.errors import InvalidArgumentError, ReadError
from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import time_text
from amalthea_uros.uros.described import describe_text

#: Changes of what a description states otherwise than a system does; there is no other way to them that could be compared.
_STRUCTURAL = ("order", "semantics", "callbacks", "runs_in", "runs_when")


@dataclass(frozen=True, slots=True, kw_only=True)
class ValueEdit:
    """A value that was written.

    Attributes
    ----------
    target : the object and the key, such as "Executor_Task.period"
    line : of the edited text, counted from 1
    before : None if the key was not there
    is_consequence : whether it keeps a value as it was that would otherwise have followed the others
    """

    target: str
    line: int
    before: str | None
    after: str
    is_consequence: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class EditedDescription:
    """A description with other values.

    Attributes
    ----------
    path : the file that the text is from
    before, text : without and with the edits
    edits : in the order of the changes
    """

    path: Path
    before: str
    text: str
    edits: tuple[ValueEdit, ...]


def edit_description(text: str, path: Path = TEXT, changes: Sequence[Change] = ()) -> EditedDescription:
    """The text of a description with changes.

    The edited text is read again, and must describe the system that the changes make of the present one. Where values that the
    description leaves open would follow the changes, such as priorities by rate, they are written, too.

    Parameters
    ----------
    text : with the line ends of the file
    path : the file of the text, for findings, and for the files that it names

    Raises
    ------
    ReadError : something in the text is wrong.
    InvalidArgumentError : a change cannot be stated in a description, or would have other effects than stated.
    """
    structural = [change for change in changes if change.key in _STRUCTURAL]
    if structural:
        return _restructured(text, path, structural, [change for change in changes if change.key not in _STRUCTURAL])
    before = describe_text(text, path)
    expected = changed_system(before.assembly.system, changes, Settings())
    places = Places(before.description, before.platform, before.core_types, before.assembly.priority_scale)
    assignments = [assignment for change in changes for assignment in places.assignments(change)]
    consequences: list[Assignment] = []
    while True:
        edited = apply_assignments(text, [*assignments, *consequences])
        found = _system(edited, path, changes)
        pinned = {assignment.target for assignment in (*assignments, *consequences)}
        different = differences(meaning(expected), meaning(found))
        if not different:
            break
        more = [change for change in _pins(different, expected, found) if change.target not in pinned]
        if not more:
            raise InvalidArgumentError(_other_effect(changes, different, before.assembly.system, expected))
        consequences += [assignment for change in more for assignment in places.assignments(change)]
    edits = [*value_edits(text, edited, assignments), *value_edits(text, edited, consequences, is_consequence=True)]
    return EditedDescription(path=path, before=text, text=edited, edits=tuple(edits))


def _restructured(text: str, path: Path, structural: Sequence[Change], values: Sequence[Change]) -> EditedDescription:
    """The text with changes for which there is no other way than a description, and then with other values of what it describes."""
    before = describe_text(text, path)
    places = Places(before.description, before.platform, before.core_types, before.assembly.priority_scale)
    assignments = [assignment for change in structural for assignment in places.assignments(change)]
    rebuilt = apply_assignments(text, assignments)
    _system(rebuilt, path, structural)
    edited = edit_description(rebuilt, path, values)
    edits = (*value_edits(text, edited.text, assignments), *edited.edits)
    return EditedDescription(path=path, before=text, text=edited.text, edits=edits)


def apply_assignments(text: str, assignments: Iterable[Assignment]) -> str:
    """The text with other values."""
    for each in assignments:
        text = text_edits.with_value(text, each.path, each.value, each.instead_of)
    return text


def value_edits(
    before: str, after: str, assignments: Iterable[Assignment], *, is_consequence: bool = False
) -> Iterable[ValueEdit]:
    """The values that were written, with their lines."""
    for each in assignments:
        yield ValueEdit(
            target=each.target,
            line=text_edits.line_of(after, each.path),
            before=text_edits.value_text(before, each.path),
            after=text_edits.value_text(after, each.path) or "",
            is_consequence=is_consequence,
        )


def _system(text: str, path: Path, changes: Sequence[Change]) -> System:
    try:
        return describe_text(text, path).assembly.system
    except ReadError as error:
        reasons = "; ".join(finding.message for finding in error.findings)
        what = ", ".join(map(str, changes))
        raise InvalidArgumentError(f"a description with {what} is not valid: {reasons}") from None


def _pins(different: Iterable[tuple[str, str]], expected: System, found: System) -> Iterable[Change]:
    """The changes that make what follows by default as it is to be: priorities by rate, and periods on offer."""
    for name, what in different:
        if what == "order of priorities":
            priorities = {each.task: each.priority for each in found.mapping.tasks}
            for each in expected.mapping.tasks:
                if each.priority is not None and each.priority != priorities.get(each.task):
                    yield Change(each.task, "priority", str(each.priority))
        elif what == "period":
            match [expected.stimuli_by_name[stimulus] for stimulus in expected.processes[name].stimuli]:
                case [Periodic(period=period)]:
                    yield Change(name, "period", time_text(period))


def _other_effect(changes: Sequence[Change], different: Sequence[tuple[str, str]], before: System, expected: System) -> str:
    what, after = ", ".join(map(str, changes)), arrival_periods(expected)
    for source, period in arrival_periods(before).items():
        if after.get(source, period) != period:
            same = Change(source, "arrival_period", time_text(period))
            return (
                f"{what} also changes the time between two messages of {source!r} from {time_text(period)} to "
                f"{time_text(after[source])}; add {same} to keep it, or the new value"
            )
    others = ", ".join(f"the {key.replace('_', ' ')} of {name}" for name, key in different[:5])
    return f"an app.yaml cannot state {what}: {others} would differ from what the change makes of the system"
