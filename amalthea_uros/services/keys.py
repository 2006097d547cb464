"""All values of a subject that can be changed."""

from __future__ import annotations

from amalthea_uros._internal.records import dataclass
from amalthea_uros.design.changes.key import UNSET
from amalthea_uros.design.changes.kinds import KINDS
from amalthea_uros.services.changed import ChangedSystem, open_changed
from amalthea_uros.services.subject import Subject


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


def keys(subject: Subject) -> tuple[ChangeableValue, ...]:
    """The values of a description with those of its platform and the defaults; of any other system, those of its objects.

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    """
    changed = open_changed(subject)
    return _of_description(changed) if changed.source is not None else _of_system(changed)


def _of_description(changed: ChangedSystem) -> tuple[ChangeableValue, ...]:
    from amalthea_uros.design.description.keys import is_listed, short_name
    from amalthea_uros.design.description.text_edits import rendered

    assert changed.source is not None
    every = changed.source.keys
    return tuple(
        ChangeableValue(name=short_name(key, every), value=UNSET if key.value is None else rendered(key.value))
        for key in every
        if is_listed(key)
    )


def _of_system(changed: ChangedSystem) -> tuple[ChangeableValue, ...]:
    return tuple(
        ChangeableValue(name=f"{name}.{key}", value=property_.show(changed.given, name))
        for kind in KINDS
        for name in dict.fromkeys(kind.objects(changed.system))
        for key, property_ in kind.keys.items()
    )
