"""A description as what changes act on: its text is edited, and described and built again."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.design.changes.apply import Difference, apply, describe
from amalthea_uros.design.changes.change import Change, compact
from amalthea_uros.design.changes.key import UNSET, Configuration
from amalthea_uros.design.changes.timing_changes import consequences
from amalthea_uros.design.description.assign import Assignment, Assignments, apply_assignments, is_stated_by_parts, the_key
from amalthea_uros.design.description.built_objects import BuiltObjects
from amalthea_uros.design.description.keys import DescriptionKey, keys_of, matching, short_name
from amalthea_uros.design.description.refusals import described_elsewhere, refusal
from amalthea_uros.design.description.text_edits import rendered, value_text
from amalthea_uros.design.description.texts import edited_assembly
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.uros.assemble import Assembly
from amalthea_uros.uros.described import describe_text

#: Keys that are changed in the system that is built, because it is an assumption about it which no description states.
ASSUMED = ("communication", "arrival_jitter")
#: Values of tasks that are shown if it follows from changes; everything else is seen in the results.
_FOLLOWING = ("period", "offset", "priority", "core")


@dataclass(frozen=True, slots=True, kw_only=True)
class DividedChanges:
    """Changes by what they act on.

    Attributes
    ----------
    stated : in the description, by the key that was named; None for the name of an object that is built from the description
    assumed : in the system that is built from it
    """

    assignments: tuple[Assignment, ...]
    stated: tuple[tuple[Change, DescriptionKey | None], ...]
    assumed: tuple[Change, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class DescriptionOrigin:
    """The text of a description.

    Attributes
    ----------
    path : of its file, for findings, and for the files that it names
    with_bus : whether the CAN bus is a part of the system
    assumed : what is changed in the system after it was built
    """

    text: str
    path: Path
    settings: Settings
    with_bus: bool = False
    assumed: tuple[Change, ...] = ()

    @property
    def present(self) -> Configuration:
        """The system and the settings without changes."""
        return apply(self._system(describe_text(self.text, self.path).assembly), self.settings, self.assumed)

    @property
    def keys(self) -> tuple[DescriptionKey, ...]:
        """All values of the description."""
        return _keys(self.text, self.path)

    def configure(self, changes: Sequence[Change]) -> Configuration:
        """The system of the edited description, and the settings; InvalidArgumentError if something is wrong with a change."""
        system, assumed = self.rebuilt(changes)
        return apply(system, self.settings, (*self.assumed, *assumed))

    def after(self, changes: Sequence[Change]) -> DescriptionOrigin:
        """The edited description; raises as `configure`."""
        divided = self.divided(changes)
        return replace(self, text=self._text(divided), assumed=(*self.assumed, *divided.assumed))

    def rebuilt(self, changes: Sequence[Change]) -> tuple[System, tuple[Change, ...]]:
        """The system of the edited description, and the changes that no description states; raises as `configure`."""
        divided = self.divided(changes)
        return self._changed_system(divided, changes), divided.assumed

    def edited(self, changes: Sequence[Change]) -> str:
        """The text of the description with changes.

        Raises
        ------
        InvalidArgumentError : something is wrong with a change, or no description states it.
        """
        divided = self.divided(changes)
        if divided.assumed:
            names = ", ".join(map(str, divided.assumed))
            raise InvalidArgumentError(f"an app.yaml does not state {names}; write an AMALTHEA model (.amxmi) instead")
        self._changed_system(divided, changes)
        return self._text(divided)

    def differences(self, changes: Sequence[Change]) -> tuple[Difference, ...]:
        """The values before and after changes, and what of tasks follows from them."""
        if not changes:
            return ()
        divided, old = self.divided(changes), self._system(describe_text(self.text, self.path).assembly)
        new = self._changed_system(divided, changes)
        text = self._text(divided)
        values = {each.target: self._difference(each, key, text, divided) for each, key in divided.stated}
        values |= {
            f"{each.object}.{each.key}": each for each in describe(new, self.settings, divided.assumed) if divided.assumed
        }
        wires = {message.name for message in (*old.network.transmissions, *new.network.transmissions)}
        following = consequences(Configuration(old, Settings()), Configuration(new, Settings()), tuple(values.values()))
        tasks = (each for each in following if each.object in new.processes and each.object not in wires)
        return (*values.values(), *(each for each in tasks if each.key in _FOLLOWING))

    def divided(self, changes: Sequence[Change]) -> DividedChanges:
        """The changes by what they act on.

        Raises
        ------
        InvalidArgumentError : nothing has the name of a change, several values have it, or its value is wrong.
        """
        collected, derived = Assignments(self.text, {}), list[Assignment]()
        stated, assumed = list[tuple[Change, DescriptionKey | None]](), list[Change]()
        for change in changes:
            key = the_key(change.target, self.keys)
            if key is not None and not is_stated_by_parts(key):
                collected.add(key, change)
                stated.append((change, key))
            elif change.key in ASSUMED:
                assumed.append(change)
            else:
                derived += self._of_built_object(change)
                stated.append((change, None))
        return DividedChanges(assignments=(*collected.every, *derived), stated=tuple(stated), assumed=tuple(assumed))

    def meant(self, target: str) -> bool:
        """Whether a name means a value of the description."""
        return bool(matching(target, self.keys))

    def changes_of(self, assignments: Sequence[Assignment]) -> tuple[Change, ...]:
        """All edits, as changes by the shortest names of the values."""
        by_path = {key.path: key for key in self.keys}
        values = []
        for each in assignments:
            key = by_path.get(each.path)
            target = each.target if key is None else short_name(key, self.keys)
            name, _, last = target.rpartition(".")
            values.append(Change(name, last, compact(rendered(each.value))))
        return tuple(values)

    def _of_built_object(self, change: Change) -> Sequence[Assignment]:
        """The edits for a value of an object that is built, such as the runnable of a task."""
        described = describe_text(self.text, self.path)
        if elsewhere := described_elsewhere(change, described):
            raise InvalidArgumentError(elsewhere)
        try:
            return BuiltObjects(described, self.text).assignments(change)
        except InvalidArgumentError as error:
            raise refusal(change, self.keys, self.present.system, error) from None

    def _text(self, divided: DividedChanges) -> str:
        return apply_assignments(self.text, divided.assignments)

    def _changed_system(self, divided: DividedChanges, changes: Sequence[Change]) -> System:
        return self._system(edited_assembly(self._text(divided), self.path, changes))

    def _system(self, assembly: Assembly) -> System:
        with_bus = assembly.system_with_bus() if self.with_bus else None
        return with_bus or assembly.system

    def _difference(self, change: Change, key: DescriptionKey | None, text: str, divided: DividedChanges) -> Difference:
        path = key.path if key else next(each.path for each in divided.assignments if each.target == change.target)
        before = value_text(self.text, path)
        if before is None and key is not None and key.value is not None:
            before = rendered(key.value)
        return Difference(change.object, change.key, before or UNSET, value_text(text, path) or UNSET)


@lru_cache(maxsize=4)
def _keys(text: str, path: Path) -> tuple[DescriptionKey, ...]:
    return keys_of(describe_text(text, path).whole, text)
