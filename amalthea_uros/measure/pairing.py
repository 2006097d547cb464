"""Pairs of starts and ends, by the number of the job where the events have one, and by their order elsewhere.

What is uncertain is counted and never paired: nothing is paired across a gap, a second start without an end drops the one that is
open, and an event that stands before an earlier one ends what is open.
"""

from __future__ import annotations

import numpy as np

from amalthea_uros._internal.arrays import Flags, Numbers
from amalthea_uros._internal.records import dataclass
from amalthea_uros.measure.series import Counts

#: By so many numbers events may overtake each other; a counter that goes back further has started again.
_OVERTAKEN = 8


@dataclass(frozen=True, slots=True)
class Pairs:
    """Intervals that have a start and an end.

    Attributes
    ----------
    starts, ends : picoseconds, in the order of the starts
    segments : intervals of the same one have no gap between them
    follows : whether nothing is missing between an interval and the one before it
    """

    starts: Numbers
    ends: Numbers
    segments: Numbers
    follows: Flags
    counts: Counts


def paired_in_order(time: Numbers, segment: Numbers, is_end: Flags) -> Pairs:
    """Pair each end with the start directly before it.

    Parameters
    ----------
    time, segment, is_end : of the events, in the order of the log
    """
    is_same = segment[1:] == segment[:-1]
    is_back = is_same & (time[1:] < time[:-1])
    opened = np.flatnonzero(~is_end[:-1] & is_end[1:] & is_same & ~is_back) if len(time) else np.empty(0, np.int64)
    numbers = segment[opened]
    # Between two pairs that follow each other there is no other event, which would be an incomplete pair, and no step back.
    is_next = np.diff(opened, prepend=-1) == 2
    is_after_back = np.concatenate([[False], is_back])[opened] if len(opened) else np.empty(0, bool)
    follows = is_next & (np.diff(numbers, prepend=-1) == 0) & ~is_after_back
    return Pairs(
        time[opened],
        time[opened + 1],
        numbers,
        follows,
        Counts(incomplete=len(time) - 2 * len(opened), reordered=int(np.count_nonzero(is_back))),
    )


def paired_by_number(time: Numbers, segment: Numbers, is_end: Flags, counter: Numbers, modulus: int) -> Pairs:
    """Pair the start and the end with the same number.

    Parameters
    ----------
    time, segment, is_end : of the events, in the order of the log
    counter : the number that each event has, from 0 to `modulus` - 1
    """
    number, run = counted_on(counter, modulus)
    # Each part between gaps and resets has a number of its own.
    _, segment = np.unique(_keys(segment, run), return_inverse=True)
    segment = segment.astype(np.int64)
    back = int(np.count_nonzero((time[1:] < time[:-1]) & (segment[1:] == segment[:-1])))
    keys = _keys(segment, number)
    start_keys, starts = np.unique(keys[~is_end], return_index=True)
    end_keys, ends = np.unique(keys[is_end], return_index=True)
    common, first, second = np.intersect1d(start_keys, end_keys, assume_unique=True, return_indices=True)
    begin, end = time[~is_end][starts[first]], time[is_end][ends[second]]
    is_right = end >= begin
    numbers, segments = number[~is_end][starts[first]], segment[~is_end][starts[first]]
    is_rising = np.diff(begin, prepend=begin[:1]) >= 0
    follows = is_rising & (np.diff(common, prepend=common[:1] - 2) == 1) & is_right & np.concatenate([[True], is_right])[:-1]
    lost = lost_numbers(number, run)
    repeated = len(time) - len(start_keys) - len(end_keys)
    incomplete = len(start_keys) + len(end_keys) - 2 * int(np.count_nonzero(is_right))
    order = np.lexsort((numbers[is_right], segments[is_right]))
    kept = np.flatnonzero(is_right)[order]
    return Pairs(
        begin[kept],
        end[kept],
        segments[kept],
        follows[kept],
        Counts(incomplete=incomplete, lost=lost, duplicated=repeated, reordered=back),
    )


def counted_on(counter: Numbers, modulus: int) -> tuple[Numbers, Numbers]:
    """Numbers that do not start again from 0, and how often the counter had been reset before each.

    A counter may wrap many times, but between two events it is taken to advance by less than half of its range.
    """
    if not len(counter):
        return counter, counter
    steps = np.diff(counter) % modulus
    few = min(_OVERTAKEN, modulus // 2)
    is_back = steps >= modulus - few
    is_reset = ~is_back & (steps > max(modulus // 2, few))
    steps = np.where(is_back, steps - modulus, np.where(is_reset, 0, steps))
    number = np.concatenate([[0], np.cumsum(steps)])
    return number - number.min(), np.concatenate([[0], np.cumsum(is_reset)])


def lost_numbers(number: Numbers, run: Numbers) -> int:
    """How many numbers are missing between the first and the last one of each run of a counter."""
    found = np.unique(_keys(run, number))
    is_same = np.diff(found >> _BITS) == 0
    return int(np.maximum(np.diff(found) - 1, 0)[is_same].sum())


#: Numbers of jobs have fewer bits.
_BITS = 40


def _keys(segment: Numbers, number: Numbers) -> Numbers:
    return segment << _BITS | number
