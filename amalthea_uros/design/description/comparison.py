"""The differences of two descriptions, in their own words: values that one of them states otherwise, and objects of one of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TypeAlias

from amalthea_uros._internal.records import replace
from amalthea_uros.design.changes.apply import Difference
from amalthea_uros.design.changes.key import UNSET
from amalthea_uros.design.description.keys import DescriptionKey, is_listed, keys_of, short_name
from amalthea_uros.design.description.text_edits import rendered, value_text
from amalthea_uros.spec.read import description_text
from amalthea_uros.uros.described import describe_text

#: The names on the way to a value or an object, which identify it in both descriptions.
_Names: TypeAlias = tuple[str, ...]
#: What is shown of an object that only one description has.
PRESENT = "present"


class _DescriptionSide:
    """A description with its values by name."""

    def __init__(self, text: str, path: Path) -> None:
        self.text = text
        described = describe_text(text, path)
        self.keys: Sequence[DescriptionKey] = keys_of(described.whole, text)
        self.files = {each.name: path.parent / each.file for each in described.description.controllers if each.file is not None}
        self.values: Mapping[_Names, DescriptionKey] = {key.names: key for key in self.keys if is_listed(key)}
        self.objects = {self._object(key): None for key in self.keys if self._object(key)}

    def _object(self, key: DescriptionKey) -> _Names:
        """The names of the innermost item of a list that a value is in."""
        depth = max((index for index, step in enumerate(key.path) if isinstance(step, int)), default=-1)
        inner = len(key.path) - 1 - depth
        return () if depth < 0 else key.names[: len(key.names) - inner]

    def states(self, key: DescriptionKey) -> bool:
        """Whether the text has a value."""
        return value_text(self.text, key.path) is not None

    def shown(self, names: _Names) -> str:
        """A value as text."""
        key = self.values.get(names)
        return UNSET if key is None or key.value is None else rendered(key.value)


def description_differences(old: str, old_path: Path, new: str, new_path: Path) -> tuple[Difference, ...]:
    """The values that differ, in the order of the new description, and the objects that only one has.

    Values of platforms and defaults are compared where one of the texts states them.

    Raises
    ------
    ReadError : something in one of them is wrong.
    """
    sides = _DescriptionSide(old, old_path), _DescriptionSide(new, new_path)
    return (*_differences(*sides), *_of_files(*sides))


def _of_files(old: _DescriptionSide, new: _DescriptionSide) -> Iterator[Difference]:
    """The differences of the files of the controllers that both robots have, with the names of these."""
    for name in (each for each in new.files if each in old.files):
        before, after = old.files[name], new.files[name]
        for each in description_differences(description_text(before), before, description_text(after), after):
            yield replace(each, object=f"{name}.{each.object}".removesuffix("."))


def _differences(old: _DescriptionSide, new: _DescriptionSide) -> Iterator[Difference]:
    shown: list[_Names] = []
    for names in dict.fromkeys((*new.objects, *old.objects)):
        if (names in old.objects) != (names in new.objects) and not _is_within(names, shown):
            shown.append(names)
            before, after = (PRESENT if names in side.objects else UNSET for side in (old, new))
            yield Difference(".".join(names[-2:-1]), names[-1], before, after)
    for names in dict.fromkeys((*new.values, *old.values)):
        sides = [(side, side.values[names]) for side in (new, old) if names in side.values]
        if _is_within(names, shown) or not any(side.states(key) for side, key in sides):
            continue
        before, after = old.shown(names), new.shown(names)
        if before != after:
            shown.append(names)
            side, key = sides[0]
            name, _, last = short_name(key, side.keys).rpartition(".")
            yield Difference(name, last, before, after)


def _is_within(names: _Names, others: Sequence[_Names]) -> bool:
    """Whether a value is a part of one that is shown."""
    return any(names[: len(other)] == other for other in others)
