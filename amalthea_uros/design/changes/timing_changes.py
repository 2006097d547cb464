"""The differences of two systems in words of timing: what a change of one into the other would set."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from enum import StrEnum

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.design.changes.apply import Difference, apply, describe
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.changes.key import UNSET, ChangeableKind, Configuration
from amalthea_uros.design.changes.kinds import KINDS
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.settings import Settings


class Happening(StrEnum):
    """What happened to an object."""

    ADDED = "added"
    REMOVED = "removed"
    CHANGED = "changed"


@dataclass(frozen=True, slots=True, kw_only=True)
class TimingChange:
    """What differs about an object in two systems.

    Attributes
    ----------
    kind : of the object, such as "task"
    differences : the values on both sides; of an added or removed object all values that are stated
    """

    kind: str
    object: str
    happening: Happening
    differences: tuple[Difference, ...]


#: Objects of other kinds matter only by what others use of them.
_COUNTED = ("task", "ISR", "runnable", "core", "scheduler")


#: Keys of names, which say nothing about timing: the values of the objects that have them are compared.
_NAMES = ("stimulus",)


def timing_changes(old: System, new: System) -> tuple[TimingChange, ...]:
    """The differences, by kind and in the order of the new system; what was removed is last of its kind."""
    return tuple(_changes(Configuration(old, Settings()), Configuration(new, Settings())))


def described(given: Configuration, changes: Sequence[Change]) -> tuple[Difference, ...]:
    """The values before and after changes, those that were set and what else differs because of them; raises as `apply`."""
    differences = describe(*given, changes)
    return (*differences, *consequences(given, apply(*given, changes), differences))


def consequences(old: Configuration, new: Configuration, given: Sequence[Difference]) -> Iterator[Difference]:
    """What else differs because of some changes, such as the arrivals of messages that an executor with another period takes."""
    told = {(each.object, each.key) for each in given}
    times = {(each.before, each.after) for each in given if each.key == "execution_time"}
    for change in _changes(old, new):
        for each in change.differences:
            is_same_time = each.key == "execution_time" and (each.before, each.after) in times
            if (each.object, each.key) not in told and change.happening is Happening.CHANGED and not is_same_time:
                yield replace(each, is_consequence=True)


def _changes(old: Configuration, new: Configuration) -> Iterator[TimingChange]:
    if old == new:
        return iter(())
    found = [change for kind in KINDS for change in _of_kind(kind, old, new)]
    return _without_repetition(found, old.system, new.system)


def _of_kind(kind: ChangeableKind, old: Configuration, new: Configuration) -> Iterator[TimingChange]:
    before, after = (dict.fromkeys(kind.objects(side.system)) for side in (old, new))
    for name in (*after, *(name for name in before if name not in after)):
        is_old, is_new = name in before, name in after
        if is_old and is_new:
            if kind.name == "runnable" and old.system.runnables[name] == new.system.runnables[name]:
                continue  # there are many of them
            happening = Happening.CHANGED
        elif kind.name in _COUNTED:
            happening = Happening.ADDED if is_new else Happening.REMOVED
        else:
            continue
        differences = tuple(_differences(kind, name, old if is_old else None, new if is_new else None))
        if differences or happening is not Happening.CHANGED:
            yield TimingChange(kind=kind.name, object=name, happening=happening, differences=differences)


def _differences(kind: ChangeableKind, name: str, old: Configuration | None, new: Configuration | None) -> Iterator[Difference]:
    for key, found in kind.keys.items():
        if key in _NAMES:
            continue
        before, after = (UNSET if side is None else found.show(side, name) for side in (old, new))
        if before != after:
            yield Difference(name, key, before, after)


def _without_repetition(changes: Sequence[TimingChange], old: System, new: System) -> Iterator[TimingChange]:
    """The changes without those that another one says, too: of a stimulus and its process, a clock and its core."""
    listed = list(changes)
    said = {(each.object, difference.key) for each in listed for difference in each.differences}
    runnable_times = {
        (difference.before, difference.after) for each in listed if each.kind == "runnable" for difference in each.differences
    }
    for each in listed:
        match each.kind:
            case "stimulus":
                users = [process.name for process in new.processes.values() if each.object in process.stimuli]
                kept = [d for d in each.differences if not any((user, d.key) in said for user in users)]
            case "clock":
                users = [core.name for core in new.cores.values() if core.clock == each.object]
                kept = [d for d in each.differences if not any((user, d.key) in said for user in users)]
            case "task" | "ISR" if each.happening is Happening.CHANGED:
                kept = [d for d in each.differences if d.key != "execution_time" or (d.before, d.after) not in runnable_times]
            case _:
                kept = list(each.differences)
        if kept or each.happening is not Happening.CHANGED:
            yield TimingChange(kind=each.kind, object=each.object, happening=each.happening, differences=tuple(kept))
