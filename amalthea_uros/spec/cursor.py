"""The place in a YAML text that ends where somebody is writing, and so is seldom complete."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import yaml

from amalthea_uros._internal.records import dataclass, field

#: What is written at the cursor to find the place; no key of anybody.
_MARK = "amuros-place-of-the-cursor"

_Parser: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class Cursor(NamedTuple):
    """A place in a text.

    Attributes
    ----------
    path : keys and positions in lists, of the mapping for a key and of the value for a value
    stated : the keys of this mapping that are before the place
    """

    path: tuple[int | str, ...]
    stated: tuple[str, ...] = ()


def place_of_key(before: str) -> Cursor | None:
    """The place of a key that would follow a text; None if no key can follow."""
    return _marked(f"{before}{_MARK}: 0")


def place_of_value(before: str) -> Cursor | None:
    """The place of a value that would follow a text; None if no value can follow."""
    return _marked(f"{before}{_MARK}")


@dataclass(slots=True)
class _Level:
    """A mapping or list that is not closed.

    Attributes
    ----------
    key : of a mapping: the one whose value follows; None: a key follows
    count : of a list: the items so far
    """

    is_list: bool
    key: str | None = None
    keys: list[str] = field(default_factory=list)
    count: int = 0

    @property
    def part(self) -> int | str | None:
        """Where the next value is."""
        return self.count if self.is_list else self.key

    def closed(self) -> None:
        """Continue after a value."""
        self.count += 1
        self.key = None


def _marked(text: str) -> Cursor | None:
    levels: list[_Level] = []
    for event in _events(text):
        is_start = isinstance(event, yaml.MappingStartEvent | yaml.SequenceStartEvent)
        if is_start:
            levels.append(_Level(isinstance(event, yaml.SequenceStartEvent)))
        elif isinstance(event, yaml.MappingEndEvent | yaml.SequenceEndEvent):
            levels.pop()
            if levels:
                levels[-1].closed()
        elif isinstance(event, yaml.ScalarEvent | yaml.AliasEvent) and levels:
            value = event.value if isinstance(event, yaml.ScalarEvent) else ""
            level = levels[-1]
            is_key = not level.is_list and level.key is None
            if value == _MARK:
                outer = [each.part for each in (levels[:-1] if is_key else levels)]
                return Cursor(tuple(part for part in outer if part is not None), tuple(level.keys))
            if is_key:
                level.key = value
                level.keys.append(value)
            else:
                level.closed()
    return None


def _events(text: str) -> Iterator[Any]:
    """The events of the parser up to the first error."""
    try:
        yield from yaml.parse(text, Loader=_Parser)
    except yaml.YAMLError:
        return
