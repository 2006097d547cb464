"""All values of a subject that can be changed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from amalthea_uros._internal.records import dataclass
from amalthea_uros.design.changes.key import UNSET
from amalthea_uros.design.changes.kinds import KINDS
from amalthea_uros.services.changed import ChangedSystem, open_changed
from amalthea_uros.services.subject import Subject

if TYPE_CHECKING:
    from amalthea_uros.design.description.origin import DescriptionOrigin
    from amalthea_uros.design.model_attributes.origin import ModelOrigin


@dataclass(frozen=True, slots=True, kw_only=True)
class ChangeableValue:
    """A value that can be changed.

    Attributes
    ----------
    name : as for `--set`
    value : as text; "not set" if there is none
    """

    name: str
    value: str


def keys(subject: Subject, *, matching: str = "") -> tuple[ChangeableValue, ...]:
    """The values of a description with those of its platform and the defaults; of any other system, those of its objects.

    Of an AMALTHEA model, every attribute of an object is such a value. As there are many, they are listed only for a text.

    Parameters
    ----------
    matching : only values whose names contain this text

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    """
    changed = open_changed(subject)
    if changed.source is not None:
        return _of_description(changed.source, matching)
    of_system = tuple(each for each in _of_system(changed) if _matches(each.name, matching))
    if not matching or changed.model_source is None:
        return of_system
    known = {each.name for each in of_system}
    return (*of_system, *(each for each in _of_model(changed.model_source, matching) if each.name not in known))


def _matches(name: str, text: str) -> bool:
    return text.casefold() in name.casefold()


def _of_description(source: DescriptionOrigin, matching: str) -> tuple[ChangeableValue, ...]:
    from amalthea_uros.design.description.keys import is_listed, short_name
    from amalthea_uros.design.description.text_edits import rendered

    every = source.keys
    named = ((short_name(key, every), key) for key in every if is_listed(key))
    return tuple(
        ChangeableValue(name=name, value=UNSET if key.value is None else rendered(key.value))
        for name, key in named
        if _matches(name, matching) or _matches(key.full_name, matching)
    )


def _of_system(changed: ChangedSystem) -> tuple[ChangeableValue, ...]:
    return tuple(
        ChangeableValue(name=f"{name}.{key}", value=property_.show(changed.given, name))
        for kind in KINDS
        for name in dict.fromkeys(kind.objects(changed.system))
        for key, property_ in kind.keys.items()
    )


def _of_model(origin: ModelOrigin, matching: str) -> tuple[ChangeableValue, ...]:
    from amalthea_uros.design.model_attributes.keys import short_names
    from amalthea_uros.design.model_attributes.values import shown

    every = origin.editable.keys
    names = short_names([key for key in every if _matches(key.full_name, matching)], every)
    return tuple(ChangeableValue(name=name, value=shown(key)) for key, name in names.items())
