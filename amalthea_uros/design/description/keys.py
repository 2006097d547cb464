"""The keys of a description: a path of names for each value that its file has, or could have."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros.design.changes.key_names import shorter_names, with_gaps
from amalthea_uros.design.description.text_edits import Path, has_list
from amalthea_uros.perf.qualified import qualified_name
from amalthea_uros.spec.description import OF_CONTROLLER, Description, RobotController
from amalthea_uros.spec.loops import LoopSection
from amalthea_uros.spec.section import DescriptionSection, Shorthand
from amalthea_uros.spec.written import Written, section_class, written

#: What identifies an item of a list, the first key that it has.
_IDENTIFIERS = ("name", "topic", "service", "action", "process")
#: Words for keys that people look for under another name.
_OTHER_WORDS = {"board": "hardware.platform"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Holder:
    """A section, and where it is in the text."""

    path: Path
    section: DescriptionSection


@dataclass(frozen=True, slots=True, kw_only=True)
class DescriptionKey:
    """A value of a description.

    Attributes
    ----------
    path : of the value in the text
    names : the same with the names of objects in place of their numbers
    holders : the sections that it is in, the innermost one last
    field : the key in the innermost section
    item : the name of the value in a mapping by names; "" for others
    """

    path: Path
    names: tuple[str, ...]
    holders: tuple[Holder, ...]
    field: str
    item: str = ""

    @property
    def section(self) -> DescriptionSection:
        """The section with the value."""
        return self.holders[-1].section

    @property
    def value(self) -> Written | None:
        """The present value, also if it is that of the platform or the default; None if there is none."""
        value = written(self.section, self.field)
        if self.item and isinstance(value, Mapping):
            return value.get(self.item)
        return value

    @property
    def is_part(self) -> bool:
        """Whether the value has keys of its own, so that it is listed by these."""
        return not self.item and section_class(self.section, self.field) is not None

    @property
    def full_name(self) -> str:
        """All names."""
        return ".".join(self.names)


def is_listed(key: DescriptionKey) -> bool:
    """Whether a key is shown in lists: single values, and what may be written as one; of its parts, those that are stated."""
    kind = None if key.item else section_class(key.section, key.field)
    if kind is not None and not (issubclass(kind, Shorthand) and _is_one_value(getattr(key.section, key.field), key.path)):
        return False
    if isinstance(getattr(key.section, key.field), list) and _has_sections(getattr(key.section, key.field)):
        return False
    inner = any(isinstance(each.section, Shorthand) and _is_one_value(each.section, each.path) for each in key.holders[1:])
    return not inner or key.section.states(key.field)


def _is_one_value(section: object, path: Path) -> bool:
    """Whether a section that may be a plain value is shown as one; a loop if it is a list of items."""
    return path != ("hardware",) and (not isinstance(section, LoopSection) or section.items is not None)


def _has_sections(items: list[object]) -> bool:
    return any(isinstance(item, DescriptionSection) for item in items)


def keys_of(whole: Description, text: str) -> tuple[DescriptionKey, ...]:
    """All keys of a description.

    Parameters
    ----------
    whole : completed by its platform
    text : the text of the description; of the lists of a platform, no single items can be changed
    """
    return tuple(_keys((Holder(path=(), section=whole),), (), text))


def _keys(holders: tuple[Holder, ...], names: tuple[str, ...], text: str) -> Iterator[DescriptionKey]:
    path, section = holders[-1].path, holders[-1].section
    elsewhere = _stated_elsewhere(section)
    for field, info in type(section).model_fields.items():
        key = info.alias or field
        if key in elsewhere:
            continue
        yield DescriptionKey(path=(*path, key), names=(*names, key), holders=holders, field=field)
        yield from _inner(holders, (*names, key), (*path, key), field, text)


def _inner(holders: tuple[Holder, ...], names: tuple[str, ...], path: Path, field: str, text: str) -> Iterator[DescriptionKey]:
    value = getattr(holders[-1].section, field)
    if isinstance(value, DescriptionSection):
        name = getattr(value, "name", None)
        own = (*names, _of_part(name, holders)) if isinstance(name, str) else names
        yield from _keys((*holders, Holder(path=path, section=value)), own, text)
    elif isinstance(value, Mapping):
        for name, item in value.items():
            if isinstance(item, DescriptionSection):
                named = _of_part(name, holders)
                yield from _keys((*holders, Holder(path=(*path, name), section=item)), (*names, named), text)
            else:
                yield DescriptionKey(path=(*path, name), names=(*names, name), holders=holders, field=field, item=name)
    elif isinstance(value, list) and has_list(text, path, len(value)):
        for index, item in enumerate(value):
            if isinstance(item, DescriptionSection):
                holder = Holder(path=(*path, index), section=item)
                yield from _keys((*holders, holder), (*names, _name_of(item, index, holders)), text)


def _name_of(item: DescriptionSection, index: int, holders: Sequence[Holder]) -> str:
    names = ((key, getattr(item, key, None)) for key in _IDENTIFIERS)
    key, name = next(((key, name) for key, name in names if isinstance(name, str)), ("", str(index)))
    return _of_part(name, holders) if key == "name" else name


def _of_part(name: str, holders: Sequence[Holder]) -> str:
    """The name of an object in the system; one of several controllers has the name of that before its own."""
    parts = (each.section.name for each in holders if isinstance(each.section, RobotController))
    return next((qualified_name(part, name) for part in parts), name)


def _stated_elsewhere(section: DescriptionSection) -> Collection[str]:
    """The keys of a section that it cannot have, because it says where else their values are stated."""
    if getattr(section, "executors", False):
        return ("executor",)
    is_robot = isinstance(section, Description) and bool(section.controllers)
    if is_robot or (isinstance(section, RobotController) and section.file is not None):
        return ("hardware", *OF_CONTROLLER)
    return ()


def matching(target: str, keys: Sequence[DescriptionKey]) -> list[DescriptionKey]:
    """The keys that are meant by some of their names, the last one among them, in their order; those with the smallest gaps.

    >>> matching("uros_task.sleep", keys)[0].full_name   # doctest: +SKIP
    'middleware.executor.uros_task.loop.sleep'
    """
    target = _OTHER_WORDS.get(target, target)
    if whole := [key for key in keys if target.endswith(key.names[-1]) and key.full_name == target]:
        return whole
    gaps = with_gaps(target, keys)
    smallest = min((gap for gap, _ in gaps), default=0)
    return [key for gap, key in gaps if gap == smallest]


def short_name(key: DescriptionKey, keys: Sequence[DescriptionKey]) -> str:
    """The shortest name that means only this key, if possible with the object that has it."""
    for name in shorter_names(key):
        if [each.path for each in matching(name, keys)] == [key.path]:
            return name
    return key.full_name
