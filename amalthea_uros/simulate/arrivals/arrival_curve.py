"""Occurrences of which only limits are known: how much time any n consecutive ones span."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.stimuli import ArrivalCurve
from amalthea_uros.simulate.arrivals.occurrences import LONGEST, OccurrenceBlock, OccurrenceBlocks, block_size
from amalthea_uros.simulate.options import SimulationMode
from amalthea_uros.simulate.sampling.words import RandomSource
from amalthea_uros.units import Time

#: CurveLimits of more occurrences are not simulated.
_MOST = 1000
_BLOCK = 256
#: More than any sum of limits.
_UNLIMITED = 2**62

#: Assumptions.
STARTS_AT_0 = "the first occurrence of a stimulus with an arrival curve is at time 0"
FOLLOWS = "without an upper limit, an occurrence follows the earliest possible time by the mean minimum distance at most"


@dataclass(frozen=True, slots=True)
class CurveLimits:
    """All limits that follow from those of an arrival curve.

    They are the longest and shortest paths in the graph of the limits, a simple temporal network (R. Dechter, I. Meiri, J. Pearl,
    "Temporal constraint networks", Artificial Intelligence 49, 1991): occurrences that respect them can always be continued.

    Attributes
    ----------
    lower : (distances, least time that so many consecutive distances take)
    upper : (distances, greatest time); empty if there is no limit
    spacing : the mean least distance
    """

    lower: tuple[tuple[int, Time], ...]
    upper: tuple[tuple[int, Time], ...]
    spacing: Time

    @property
    def longest(self) -> int:
        """How many past occurrences limit the next one."""
        return max(distances for distances, _ in (*self.lower, *self.upper))


def limits_of(stimulus: ArrivalCurve) -> CurveLimits:
    """The limits of an arrival curve.

    Raises
    ------
    UnknownError : the limits contradict each other, or there are none.
    """
    points = [point for point in stimulus.points if point.occurrences > 1]
    if any((point.lower or 0) < 0 or (point.upper or 0) < 0 for point in points):
        raise UnknownError("a border of its arrival curve is negative")
    if not any(point.lower or point.upper for point in points):
        raise UnknownError("its arrival curve has no borders")
    most = max(point.occurrences for point in points) - 1
    longest = LONGEST // max(most, 2 * len(points))
    if most >= _MOST or any(max(point.lower or 0, point.upper or 0) > longest for point in points):
        raise UnknownError("a border of its arrival curve, or the number of its occurrences, exceeds the supported range")
    edges = [(point.occurrences - 1, point.upper) for point in points if point.upper is not None]
    edges += [(1 - point.occurrences, -point.lower) for point in points if point.lower is not None]
    paths = _shortest_paths([*edges, (-1, 0)], 2 * most)
    middle = 2 * most
    lower = {distance: -int(paths[middle - distance]) for distance in range(1, most + 1)}
    upper = {distance: int(paths[middle + distance]) for distance in range(1, most + 1)}
    upper = {distance: time for distance, time in upper.items() if time < _UNLIMITED // 2}
    spacing = -(-lower[most] // most)
    if not spacing and not any(upper.values()):
        raise UnknownError("the borders of its arrival curve allow an unlimited number of occurrences at the same time")
    return CurveLimits(_not_implied(lower, max), _not_implied(upper, min), spacing)


def arrival_curve(limits: CurveLimits, mode: SimulationMode, source: RandomSource, time_base: int) -> OccurrenceBlocks:
    """Occurrences within the limits: as early as possible in the worst case, as late as possible in the best.

    Raises
    ------
    UnknownError : as early as possible would be an unlimited number at the same time.
    """
    if mode is SimulationMode.WORST and not limits.spacing:
        raise UnknownError("the borders of its arrival curve allow an unlimited number of occurrences at the same time")
    longest = max(limits.spacing, *(time for _, time in (*limits.lower, *limits.upper)))
    return _chosen(limits, mode, source, time_base, min(_BLOCK, block_size(longest * time_base)))


def _chosen(limits: CurveLimits, mode: SimulationMode, source: RandomSource, time_base: int, size: int) -> OccurrenceBlocks:
    past: deque[int] = deque([0], maxlen=limits.longest)
    yield OccurrenceBlock(0, np.array([0], np.int64))
    lower = [(-distances, time * time_base) for distances, time in limits.lower]
    upper = [(-distances, time * time_base) for distances, time in limits.upper]
    slack = max(1, limits.spacing) * time_base
    while True:
        words = source.words(size).tolist() if mode is SimulationMode.SAMPLED else [_SHARES[mode]] * size
        times = []
        for word in words:
            known = len(past)
            earliest = max([past[-1], *(past[index] + time for index, time in lower if -index <= known)])
            latest = min([past[index] + time for index, time in upper if -index <= known], default=earliest + slack)
            past.append(earliest + ((latest - earliest + 1) * word >> 64))
            times.append(past[-1])
        yield OccurrenceBlock(times[-1], np.array(times, np.int64))


#: What the modes take instead of a random word: the earliest, the middle, the latest time.
_SHARES = {SimulationMode.WORST: 0, SimulationMode.AVERAGE: 2**63, SimulationMode.BEST: 2**64 - 1}


def _shortest_paths(edges: Sequence[tuple[int, Time]], reach: int) -> Numbers:
    """The lengths of the shortest paths from the middle to each of 2 * reach + 1 nodes in a row, by Bellman and Ford.

    As each node has the same edges, those of a path can be in any order. If neither an edge nor the distance of two nodes is longer
    than `reach` / 2, there is an order in which the path between them does not leave the range.
    """
    paths = np.full(2 * reach + 1, _UNLIMITED, np.int64)
    paths[reach] = 0
    # A path from the middle to itself that is shorter than 0 contradicts.
    while paths[reach] == 0 and paths.min() > -_UNLIMITED:
        before = paths.copy()
        for step, length in edges:
            targets, sources = (slice(step, None), slice(None, -step)) if step > 0 else (slice(None, step), slice(-step, None))
            reached = np.where(paths[sources] < _UNLIMITED, paths[sources] + length, _UNLIMITED)
            paths[targets] = np.minimum(paths[targets], reached)
        if (paths == before).all():
            return paths
    raise UnknownError("the borders of its arrival curve contradict each other")


def _not_implied(limits: dict[int, Time], tighter: Callable[[int, int], int]) -> tuple[tuple[int, Time], ...]:
    """The limits that do not follow from those of fewer distances."""
    found = []
    for distances, time in limits.items():
        sums = (limits[part] + limits[distances - part] for part in range(1, distances) if part in limits)
        implied = any(tighter(total, time) == total for total in sums)
        if not implied:
            found.append((distances, time))
    return tuple(found)
