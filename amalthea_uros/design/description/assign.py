"""The edits in a description for a new value of a key."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from amalthea_uros._internal.paths import TEXT
from amalthea_uros._internal.records import dataclass
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.changes.key_names import only_one
from amalthea_uros.design.description.keys import DescriptionKey, Holder, matching, short_name
from amalthea_uros.design.description.text_edits import Path, Value, has_mapping, value_text, with_value
from amalthea_uros.errors import InvalidArgumentError, ReadError
from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.spec.nodes import plain, read_nodes
from amalthea_uros.spec.section import Shorthand
from amalthea_uros.spec.written import content, is_list, section_class, written
from amalthea_uros.units import BIT_RATE, DATA_SIZE, FREQUENCY, TIME

#: Keys of which a section has one; they say the same in different ways.
_SYNONYMS = ("rate", "interval", "period")
_UNITS = "|".join(sorted({*TIME.units, *FREQUENCY.units, *DATA_SIZE.units, *BIT_RATE.units}, key=len, reverse=True))
#: A quantity without the blank before its unit.
_COMPACT = re.compile(rf"([0-9.]+)({_UNITS})")
#: Bounds such as "2us..4us".
_RANGE = re.compile(r"([^.]+(?:\.\d+[^.]*)?)\.\.(.+)")


def the_key(target: str, keys: Sequence[DescriptionKey]) -> DescriptionKey | None:
    """The key with a name, None if there is none.

    Raises
    ------
    InvalidArgumentError : the name means several keys.
    """
    return only_one(target, matching(target, keys), "description", lambda several: [short_name(each, keys) for each in several])


@dataclass(frozen=True, slots=True)
class Assignment:
    """A value for a key of a description.

    Attributes
    ----------
    target : the object and key that the user named
    instead_of : a key in whose place it is written
    """

    target: str
    path: Path
    value: Value
    instead_of: str | None = None


@dataclass(slots=True)
class Assignments:
    """Collects what is written for several changes.

    Attributes
    ----------
    text : without the changes
    written : by path; what is within another one is a part of that
    """

    text: str
    written: dict[Path, Assignment]

    @property
    def every(self) -> tuple[Assignment, ...]:
        """All of them."""
        return tuple(self.written.values())

    def add(self, key: DescriptionKey, change: Change) -> None:
        """Give a key the value of a change.

        Raises
        ------
        InvalidArgumentError : the value is not valid YAML, or has parts that are stated one by one.
        """
        value = value_of(key, change)
        holder = self._replaced_holder(key)
        if holder is None:
            self.written[key.path] = Assignment(change.target, key.path, value, self._instead_of(key))
            return
        present = self.written.get(holder.path)
        whole = _copied(present.value) if present is not None else content(holder.section)
        assert isinstance(whole, dict)
        place = whole
        for name in key.path[len(holder.path) : -1]:
            place = place.setdefault(str(name), {})
        if not isinstance(place, dict):
            raise InvalidArgumentError(f"{change}: {key.full_name} is stated as one value; change that")
        for other in _SYNONYMS if key.path[-1] in _SYNONYMS else ():
            place.pop(other, None)
        place[str(key.path[-1])] = value
        self.written[holder.path] = Assignment(change.target, holder.path, whole)

    def _replaced_holder(self, key: DescriptionKey) -> Holder | None:
        """The section that is written as a whole: one that the text has as a plain value, or that only the platform states."""
        for holder in key.holders[1:]:
            if holder.path in self.written:
                return holder
            is_whole = isinstance(holder.section, Shorthand)
            if is_whole and not has_mapping(self.text, holder.path):
                return holder
        return None

    def _instead_of(self, key: DescriptionKey) -> str | None:
        """The key that says the same in the text."""
        if key.path[-1] not in _SYNONYMS:
            return None
        others = (each for each in _SYNONYMS if each != key.path[-1])
        return next((each for each in others if value_text(self.text, (*key.path[:-1], each)) is not None), None)


def value_of(key: DescriptionKey, change: Change) -> Value:
    """The value of a change as it is written for a key.

    Raises
    ------
    InvalidArgumentError : it is not valid YAML, or would remove what is stated part by part.
    """
    try:
        node, _, findings = read_nodes(TEXT, change.value)
    except ReadError as error:
        raise InvalidArgumentError(f"{change}: {error.findings[0].message}") from None
    value: Any = plain(node)
    if findings or value is None:
        raise InvalidArgumentError(f"{change}: {findings[0].message if findings else 'no value'}")
    part = None if key.item else section_class(key.section, key.field)
    if isinstance(value, str):
        if part is not None and {"min", "max"} <= part.model_fields.keys() and (bounds := _RANGE.fullmatch(value)):
            return {"min": _spaced(bounds[1].strip()), "max": _spaced(bounds[2].strip())}
        if not key.item and is_list(key.section, key.field) and part is None:
            return [name for name in map(str.strip, value.split(",")) if name]
        value = _spaced(value)
    if part is not None and issubclass(part, Shorthand) and not isinstance(value, Mapping):
        _refuse_loss(key, part, change)
    return value  # type: ignore[no-any-return]


def _refuse_loss(key: DescriptionKey, part: type[Shorthand], change: Change) -> None:
    """Refuse one value for what has further parts, which would be lost."""
    present = written(key.section, key.field)
    if not isinstance(present, Mapping):
        return
    lost = [name for name in present if name not in part.shorthand]
    if lost and (not issubclass(part, ExecutionTimeSection) or not {"on", "histogram"}.isdisjoint(lost)):
        parts = ", ".join(f"{change.target}.{name}" for name in present)
        raise InvalidArgumentError(f"{change}: it has parts, which are stated one by one; change {parts}")


def _spaced(text: str) -> str:
    """A quantity with the blank before its unit."""
    return _COMPACT.sub(r"\1 \2", text) if _COMPACT.fullmatch(text) else text


def _copied(value: Value) -> Value:
    if isinstance(value, Mapping):
        return {key: _copied(item) for key, item in value.items()}
    return value


def is_stated_by_parts(key: DescriptionKey) -> bool:
    """Whether a key is an execution time that depends on the hardware, or was measured."""
    section = getattr(key.section, key.field, None)
    return isinstance(section, ExecutionTimeSection) and section.on is not None


def apply_assignments(text: str, edits: Iterable[Assignment]) -> str:
    """The text with other values."""
    for each in edits:
        text = with_value(text, each.path, each.value, each.instead_of)
    return text
