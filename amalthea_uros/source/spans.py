"""Parts of a text, by the positions where they begin and end."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable
from itertools import accumulate


class TextSpans:
    """Parts of a text that may overlap; whether a position is in one of them is looked up in logarithmic time.

    Parameters
    ----------
    spans : the first position of each, and the first one after it
    """

    def __init__(self, spans: Iterable[tuple[int, int]]) -> None:
        ordered = sorted(spans)
        self._starts = [start for start, _ in ordered]
        #: The greatest end of each part and those before it.
        self._ends = list(accumulate((end for _, end in ordered), max))

    def __contains__(self, position: int) -> bool:
        number = bisect_right(self._starts, position)
        return number > 0 and position < self._ends[number - 1]
