"""The memory of the kernel while it is built."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from amalthea_uros.simulate.layout import HEAD


@dataclass(slots=True)
class Image:
    """Records and lists, one after the other; the head comes first."""

    words: list[int] = field(default_factory=lambda: [0] * HEAD)

    def record(self, size: int, fields: Mapping[int, int] | None = None) -> int:
        """A new record of zeros, apart from some fields; the place at which it begins."""
        place = len(self.words)
        self.words += [0] * size
        self.put(place, fields or {})
        return place

    def put(self, record: int, fields: Mapping[int, int]) -> None:
        """Set fields of a record."""
        for number, value in fields.items():
            self.words[record + number] = value

    def items(self, values: Iterable[int]) -> tuple[int, int]:
        """A new list; the places at which it begins and ends."""
        place = len(self.words)
        self.words += values
        return place, len(self.words)
