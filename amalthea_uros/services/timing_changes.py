"""The differences of two systems in words of timing: what a change of one into the other would set."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import StrEnum

from amalthea_uros.perf.system import System
from amalthea_uros.services.changes.apply import Difference
from amalthea_uros.services.changes.key import UNSET, Configuration, Kind
from amalthea_uros.services.changes.kinds import KINDS
from amalthea_uros.timing.settings import Settings


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


def timing_changes(old: System, new: System) -> tuple[TimingChange, ...]:
    """The differences, by kind and in the order of the new system; what was removed is last of its kind."""
    if old == new:
        return ()
    configurations = Configuration(old, Settings()), Configuration(new, Settings())
    found = [change for kind in KINDS for change in _of_kind(kind, *configurations)]
    return tuple(_without_repetition(found, old, new))


def _of_kind(kind: Kind, old: Configuration, new: Configuration) -> Iterator[TimingChange]:
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


def _differences(kind: Kind, name: str, old: Configuration | None, new: Configuration | None) -> Iterator[Difference]:
    for key, found in kind.keys.items():
        before, after = (UNSET if side is None else found.show(side, name) for side in (old, new))
        if before != after:
            yield Difference(name, key, before, after)


def _without_repetition(changes: Iterable[TimingChange], old: System, new: System) -> Iterator[TimingChange]:
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
