"""An AMALTHEA model as what changes act on: its attributes are edited, and its system is extracted again."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.design.changes.apply import Difference, apply, check_key, describe
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.changes.timing_changes import consequences, described
from amalthea_uros.design.model_attributes.editable import EditableModel, ModelSource
from amalthea_uros.design.model_attributes.keys import ModelKey
from amalthea_uros.design.model_attributes.refusals import refusal
from amalthea_uros.design.model_attributes.values import shown
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.system import System


@dataclass(frozen=True, slots=True)
class DividedModelChanges:
    """Changes by what they act on.

    Attributes
    ----------
    attributes : of objects of the model
    others : of the system, by the keys of its objects, such as `Task.period`
    """

    attributes: tuple[tuple[ModelKey, Change], ...]
    others: tuple[Change, ...]


@dataclass(frozen=True, slots=True)
class ModelOrigin:
    """A system that was extracted from a model. Keys of the system are changed there, everything else in the model.

    Attributes
    ----------
    present : the system and the settings without changes
    source : the model
    """

    present: Configuration
    source: ModelSource = field(compare=False)

    @property
    def editable(self) -> EditableModel:
        """The model that is edited; InvalidArgumentError if a copy cannot be made of the model."""
        return self.source.editable

    def configure(self, changes: Sequence[Change]) -> Configuration:
        """The system and the settings with changes; InvalidArgumentError if something is wrong with one."""
        divided = self.divided(changes)
        return apply(self._edited_system(divided), self.present.settings, divided.others)

    def findings(self, changes: Sequence[Change]) -> tuple[Finding, ...] | None:
        """The findings of extracting the changed model; None if no attribute is changed. Raises as `configure`."""
        attributes = self.divided(changes).attributes
        return self.editable.extracted(attributes).findings if attributes else None

    def differences(self, changes: Sequence[Change]) -> tuple[Difference, ...]:
        """The values before and after changes, and what else differs because of them; raises as `configure`."""
        divided = self.divided(changes)
        if not divided.attributes:
            return described(self.present, changes) if changes else ()
        edited = self._edited_system(divided)
        stated = (*self._attributes(divided), *describe(edited, self.present.settings, divided.others))
        return (*stated, *consequences(self.present, self.configure(changes), stated))

    def divided(self, changes: Iterable[Change]) -> DividedModelChanges:
        """The changes by what they act on; InvalidArgumentError if nothing, or more than one value, has a name."""
        attributes, others = [], []
        for change in changes:
            reason = _refused(self.present.system, change)
            if reason is None:
                others.append(change)
                continue
            key = self.editable.key(change.target)
            if key is None:
                raise refusal(change, self.editable.keys, self.present.system, reason)
            attributes.append((key, change))
        return DividedModelChanges(tuple(attributes), tuple(others))

    def _edited_system(self, divided: DividedModelChanges) -> System:
        return self.editable.extracted(divided.attributes).system if divided.attributes else self.present.system

    def _attributes(self, divided: DividedModelChanges) -> list[Difference]:
        before = {change.target: shown(key) for key, change in divided.attributes}
        by_target = {change.target: (key, change) for key, change in divided.attributes}
        with self.editable.edited(divided.attributes):
            return [
                Difference(change.object, change.key, before[target], _shown_again(key))
                for target, (key, change) in by_target.items()
            ]

    def __reduce__(self) -> tuple[object, ...]:
        # A replaced system has no tables of names yet.
        return ModelOrigin, (self.present._replace(system=replace(self.present.system)), self.source)


def _shown_again(key: ModelKey) -> str:
    """The value after an edit, which may have given a part to an object that had none."""
    is_part = key.feature.data_type is None and not key.feature.is_reference
    if is_part and key.part is None:
        key = replace(key, part=key.holder.__dict__.get(key.feature.name))
    return shown(key)


def _refused(system: System, change: Change) -> InvalidArgumentError | None:
    """Why a change is none of a key of the system; None if it is one."""
    try:
        check_key(system, change.object, change.key)
    except InvalidArgumentError as error:
        return error
    return None
