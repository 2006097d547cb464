"""The names that may be meant by an unknown one: close matches, in limited time."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass

#: Longer names are not compared, because the time of a comparison grows with the product of the lengths.
MAX_LENGTH = 200


def similar(name: str, known: Iterable[str], count: int = 1, cutoff: float = 0.6) -> list[str]:
    """The known names most similar to another one, the most similar first; at least as similar as `cutoff`, from 0 to 1."""
    from difflib import get_close_matches  # only after a mistake

    if len(name) > MAX_LENGTH:
        return []
    return get_close_matches(name, [each for each in known if len(each) <= MAX_LENGTH], n=count, cutoff=cutoff)


@dataclass(slots=True)
class Suggestions:
    """Suggestions for many unknown names; the last ones get none where all of them would take longer than reading.

    Attributes
    ----------
    comparisons : of two names that are still made
    """

    comparisons: int = 20_000

    def nearest(self, name: str, known: Collection[str], cutoff: float = 0.6) -> str:
        """The most similar known name, "" if none is similar."""
        self.comparisons -= len(known)
        return next(iter(similar(name, known, cutoff=cutoff)), "") if self.comparisons > 0 else ""

    def advice(self, name: str, known: Collection[str], cutoff: float = 0.6) -> str:
        """The most similar known name as the begin of a help line, "" if none is similar."""
        near = self.nearest(name, known, cutoff)
        return f"Did you mean {near!r}? " if near else ""
