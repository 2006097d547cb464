"""Subjects with changes of their values: the text of a description is edited, any other system is changed itself."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property, partial
from typing import TYPE_CHECKING

from amalthea_uros._internal.files import read_text, reading_once
from amalthea_uros._internal.limits import DESCRIPTION_SIZE
from amalthea_uros._internal.paths import TEXT
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.design.changes.change import Change, Changes, Sweep, as_changes
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.system import System
from amalthea_uros.services.subject import Subject, SystemInput, open_system, require_settings
from amalthea_uros.timing.basics.settings import Settings

if TYPE_CHECKING:
    from amalthea_uros.design.changes.apply import Difference
    from amalthea_uros.design.changes.origin import ChangeOrigin
    from amalthea_uros.design.description.origin import DescriptionOrigin
    from amalthea_uros.design.model_attributes.origin import ModelOrigin
    from amalthea_uros.metamodel.model import Model


@dataclass(frozen=True, kw_only=True)
class ChangedSystem:
    """A system that was opened, and what changes of its values make of it.

    Attributes
    ----------
    find_origin : returns what the changes act on
    given : the system and the settings without the changes
    system, settings : with the changes
    differences : what the changes did
    """

    opened: SystemInput
    find_origin: Callable[[], ChangeOrigin]
    given: Configuration
    changes: tuple[Change, ...]
    system: System
    settings: Settings
    differences: tuple[Difference, ...]

    @cached_property
    def origin(self) -> ChangeOrigin:
        """The system or text that the changes act on."""
        return self.find_origin()

    @property
    def source(self) -> DescriptionOrigin | None:
        """The description with the changes; None for other systems."""
        if self.opened.assembly is None:
            return None
        from amalthea_uros.design.description.origin import DescriptionOrigin

        assert isinstance(self.origin, DescriptionOrigin)
        return self.origin.after(self.changes)

    @property
    def model_source(self) -> ModelOrigin | None:
        """The model without the changes; None for other systems."""
        if self.opened.model is None:
            return None
        from amalthea_uros.design.model_attributes.origin import ModelOrigin

        assert isinstance(self.origin, ModelOrigin)
        return self.origin

    def check_sweeps(self, sweeps: Iterable[Sweep]) -> None:
        """Refuse names and values that cannot be swept, before the first run; the ends of each sweep are tried."""
        for sweep in sweeps:
            for value in (sweep.values[0], sweep.values[-1]):
                changed = self.origin.configure((*self.changes, Change(sweep.object, sweep.key, value)))
                require_settings(changed.settings, changed.system)


@reading_once()
def open_changed(
    subject: Subject, settings: Settings | None = None, changes: Changes = (), *, with_bus: bool = False
) -> ChangedSystem:
    """The system of a subject with changes of its values; parameters and errors as for `open_system`.

    Raises
    ------
    InvalidArgumentError : the changes or settings name what does not exist, or a value is wrong.
    """
    opened, parsed = open_system(subject, with_bus=with_bus), as_changes(changes)
    given = Configuration(opened.system, settings or Settings())
    require_settings(given.settings, given.system)
    find_origin = _origin_finder(opened, given, with_bus=with_bus)
    unchanged = ChangedSystem(
        opened=opened,
        find_origin=find_origin,
        given=given,
        changes=parsed,
        system=given.system,
        settings=given.settings,
        differences=(),
    )
    return _changed(unchanged) if parsed else unchanged


def _changed(unchanged: ChangedSystem) -> ChangedSystem:
    """A system with its changes, of which none has been made yet."""
    origin, changes = unchanged.origin, unchanged.changes
    differences = origin.differences(changes)
    system, settings = origin.configure(changes)
    require_settings(settings, system)
    opened = _with_new_findings(unchanged.opened, origin, changes)
    return replace(unchanged, opened=opened, system=system, settings=settings, differences=differences)


def _with_new_findings(opened: SystemInput, origin: ChangeOrigin, changes: Sequence[Change]) -> SystemInput:
    """The opened system; of a model with other attributes, with the findings of that."""
    if opened.model is None:
        return opened
    from amalthea_uros.design.model_attributes.origin import ModelOrigin

    new = origin.findings(changes) if isinstance(origin, ModelOrigin) else None
    return opened if new is None else replace(opened, findings=(*opened.model.findings, *new))


def _origin_finder(opened: SystemInput, given: Configuration, *, with_bus: bool) -> Callable[[], ChangeOrigin]:
    """A function that returns a model, a system, or the text of a description as it is now, on which changes act."""
    if opened.model is not None:
        return partial(_model_origin, opened.model, given, is_own=bool(opened.paths))
    if opened.assembly is None:
        return partial(_system_origin, given)
    return partial(_description_origin, opened, _text_of(opened), given.settings, with_bus=with_bus)


def _model_origin(model: Model, given: Configuration, *, is_own: bool) -> ChangeOrigin:
    from amalthea_uros.design.model_attributes.editable import ModelSource
    from amalthea_uros.design.model_attributes.origin import ModelOrigin

    return ModelOrigin(given, ModelSource(model, is_own=is_own))


def _system_origin(given: Configuration) -> ChangeOrigin:
    from amalthea_uros.design.changes.origin import SystemOrigin

    return SystemOrigin(given)


def description_origin(opened: SystemInput, settings: Settings, *, with_bus: bool = False) -> DescriptionOrigin:
    """The text of a description, as what changes act on.

    Raises
    ------
    InvalidArgumentError : the content of a description cannot be written as text.
    """
    return _description_origin(opened, _text_of(opened), settings, with_bus=with_bus)


def _description_origin(opened: SystemInput, text: str, settings: Settings, *, with_bus: bool) -> DescriptionOrigin:
    from amalthea_uros.design.description.origin import DescriptionOrigin

    path = opened.paths[0] if opened.paths else TEXT
    return DescriptionOrigin(text=text, path=path, settings=settings, with_bus=with_bus)


def _text_of(opened: SystemInput) -> str:
    if opened.paths:
        return read_text(opened.paths[0], DESCRIPTION_SIZE)
    if isinstance(opened.subject, Mapping):
        from yaml import YAMLError, safe_dump

        try:
            return safe_dump(opened.subject, sort_keys=False, allow_unicode=True)
        except YAMLError as error:
            raise InvalidArgumentError(f"the content of the description cannot be written as YAML: {error}") from None
    return str(opened.subject)
