"""Points in time in ascending order, from one limit to the next.

A stimulus is a generator of blocks whose sizes do not depend on the limits. So neither do the occurrences.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple, TypeAlias

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros.errors import UnknownError

#: Numbers up to this, and sums of two of them, fit into 64 bits.
LONGEST = 2**61
#: StimulusOccurrences in a block, at most.
_BLOCK = 4096


class OccurrenceBlock(NamedTuple):
    """Some occurrences in ascending order.

    Attributes
    ----------
    end : no later block has an occurrence before this time
    """

    end: int
    times: Numbers


OccurrenceBlocks: TypeAlias = Iterator[OccurrenceBlock]


class StimulusOccurrences:
    """The occurrences of a stimulus, in time units; those before 0 are left out.

    Attributes
    ----------
    assumptions : on which they are based, in sentences
    """

    def __init__(self, blocks: OccurrenceBlocks, assumptions: tuple[str, ...] = ()) -> None:
        self.assumptions = assumptions
        self._blocks = blocks
        self._end = 0
        self._pending: list[Numbers] = []

    def until(self, limit: int) -> Numbers:
        """The occurrences from the last limit on, before this one."""
        while self._end < limit:
            self._read_block(limit)
        times = np.concatenate(self._pending) if self._pending else np.empty(0, np.int64)
        reached = int(np.searchsorted(times, limit))
        self._pending = [times[reached:]]
        return times[:reached]

    def reach(self, start: int, limit: int, most: int) -> int:
        """A time after `start`, up to a limit, before which there are at most about so many occurrences: not many more than a block."""
        while self._end < limit and (self._end <= start or sum(map(len, self._pending)) < most):
            self._read_block(limit)
        return min(self._end, limit)

    def _read_block(self, limit: int) -> None:
        block = next(self._blocks, None)
        if block is None:
            self._end = limit
            return
        self._end = block.end
        self._pending.append(block.times[np.searchsorted(block.times, 0) :])


def block_size(longest: int) -> int:
    """How many steps of a length a block can have, so that times fit into 64 bits.

    Raises
    ------
    UnknownError : not even one.
    """
    if longest > LONGEST:
        raise UnknownError("a time of the stimulus exceeds the supported range")
    return max(1, min(_BLOCK, LONGEST // max(1, longest)))
