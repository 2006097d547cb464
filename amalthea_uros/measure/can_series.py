"""The series of what markers in a CAN log delimit or report."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

import numpy as np

from amalthea_uros._internal.arrays import Flags, Numbers
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.measure.chains import reactions
from amalthea_uros.measure.markers import (
    Decoder,
    Marker,
    MarkerChain,
    MarkerCounter,
    MarkerOccurrences,
    MarkerPair,
    Measurable,
    ReportedStatistics,
    ReportedValue,
)
from amalthea_uros.measure.pairing import Pairs, paired_by_number, paired_in_order
from amalthea_uros.measure.series import Counts, Series, TimeStatistics, merged, statistics_or_none
from amalthea_uros.timing.basics.quantities import JobMetric

#: Times of more than 50 days that a controller reports are none, like those that are not numbers; their squares are still exact.
_LONGEST = 2**62
#: Only these may be negative.
_SIGNED = (JobMetric.SLACK_TIME, JobMetric.LATENESS)


def markers_of(item: Measurable) -> tuple[Marker, ...]:
    """The markers that an object needs, in a fixed order."""
    match item:
        case MarkerPair():
            return item.start, item.end
        case MarkerChain():
            return item.stimulus, item.response
        case _:
            return (item.marker,)


@dataclass(frozen=True, slots=True)
class MeasuredObject:
    """An object on one bus.

    Attributes
    ----------
    undecoded : number of frames without the value or number that they should have
    """

    series: tuple[Series, ...]
    undecoded: int = 0


def measure_object(item: Measurable, found: MarkerOccurrences) -> MeasuredObject:
    """The series of an object.

    Parameters
    ----------
    found : the occurrences of its markers, on one bus; `marker` is the index in `markers_of`
    """
    found, duplicated = without_duplicates(found)
    match item:
        case MarkerPair():
            numbered, undecoded = _numbered(found, item.counter)
            return MeasuredObject(tuple(_interval_series(item, *numbered, duplicated)), undecoded)
        case MarkerChain():
            numbered, undecoded = _numbered(found, item.counter)
            return MeasuredObject(tuple(_chain_series(item, *numbered, duplicated)), undecoded)
        case ReportedValue():
            return _reported_values(item, found, duplicated)
        case ReportedStatistics():
            return _reported_statistics(item, found, duplicated)


def without_duplicates(found: MarkerOccurrences) -> tuple[MarkerOccurrences, int]:
    """Each frame once, and the number of the others: they have the same stamp, marker and payload."""
    is_first = np.ones(len(found), bool)
    order = np.lexsort((found.marker, found.time))
    is_again = (np.diff(found.time[order]) == 0) & (np.diff(found.marker[order]) == 0)
    seen: set[tuple[int, int, bytes]] = set()
    # Only few frames have the stamp of another one; of those the payloads decide.
    for number in np.unique([order[:-1][is_again], order[1:][is_again]]).tolist():
        key = int(found.time[number]), int(found.marker[number]), found.data[number]
        is_first[number] = key not in seen
        seen.add(key)
    return found.where(is_first), int(np.count_nonzero(~is_first))


def _numbered(found: MarkerOccurrences, counter: MarkerCounter | None) -> tuple[tuple[MarkerOccurrences, Numbers | None], int]:
    """The occurrences with their numbers; those without one are left out, and counted."""
    if counter is None:
        return (found, None), 0
    numbers = [counter.decode(data) for data in found.data]
    is_known = np.array([number is not None for number in numbers], bool)
    known = np.array([int(number) % counter.modulus for number in numbers if number is not None], np.int64)
    return (found.where(is_known), known), int(np.count_nonzero(~is_known))


def _interval_series(item: MarkerPair, found: MarkerOccurrences, numbers: Numbers | None, duplicated: int) -> Iterator[Series]:
    is_end = found.marker == 1
    if numbers is None:
        pairs, how = paired_in_order(found.time, found.segment, is_end), "in their order"
    else:
        assert item.counter is not None
        modulus = item.counter.modulus
        pairs, how = paired_by_number(found.time, found.segment, is_end, numbers, modulus), "by the number of the job"
    counts = replace(pairs.counts, duplicated=pairs.counts.duplicated + duplicated)
    between = f"from {item.start} to {item.end}, paired {how}"
    yield _series(item, item.quantity, pairs.ends - pairs.starts, pairs.ends, counts, between)
    distances, times = _distances(pairs)
    if len(distances):
        method = f"from one {item.start} to the next, of intervals with nothing missing between them"
        yield replace(_series(item, JobMetric.START_TO_START, distances, times, counts, method), period=item.period)


def _distances(pairs: Pairs) -> tuple[Numbers, Numbers]:
    later = np.flatnonzero(pairs.follows)
    return pairs.starts[later] - pairs.starts[later - 1], pairs.starts[later]


def _series(
    item: MarkerPair | ReportedValue, quantity: str, values: Numbers, times: Numbers, counts: Counts, method: str
) -> Series:
    return Series(
        kind=item.kind,
        name=item.name,
        quantity=quantity,
        statistics=statistics_or_none(values),
        values=values,
        times=times,
        counts=counts,
        method=method,
    )


def _chain_series(item: MarkerChain, found: MarkerOccurrences, numbers: Numbers | None, duplicated: int) -> Iterator[Series]:
    modulus = None if item.counter is None else item.counter.modulus
    for series in reactions(item.name, found.time, found.segment, found.marker == 1, numbers, modulus):
        counts = replace(series.counts, duplicated=series.counts.duplicated + duplicated)
        yield replace(series, counts=counts, method=f"from {item.stimulus} to {item.response}, {series.method}")


def _reported_values(item: ReportedValue, found: MarkerOccurrences, duplicated: int) -> MeasuredObject:
    values, is_known = _decoded(item.value, found, -_LONGEST if item.quantity in _SIGNED else 0)
    counts = Counts(duplicated=duplicated)
    method = f"values that {item.marker} reports"
    series = _series(item, item.quantity, values, found.time[is_known], counts, method)
    return MeasuredObject((series,), int(np.count_nonzero(~is_known)))


def _decoded(decode: Decoder, found: MarkerOccurrences, least: int) -> tuple[Numbers, Flags]:
    values = [value if value is not None and least <= value <= _LONGEST else None for value in map(decode, found.data)]
    is_known = np.array([value is not None for value in values], bool)
    return np.array([round(value) for value in values if value is not None], np.int64), is_known


def _reported_statistics(item: ReportedStatistics, found: MarkerOccurrences, duplicated: int) -> MeasuredObject:
    parts = [part for data in found.data if (part := _part(item, data)) is not None]
    method = f"{len(parts):,} statistics that {item.marker} reports"
    if item.count is None:
        method += ", without the number of their values: the mean is that of their means, and n the number of reports"
    series = Series(
        kind=item.kind,
        name=item.name,
        quantity=item.quantity,
        statistics=merged(parts) if parts else None,
        counts=Counts(duplicated=duplicated),
        method=method,
    )
    return MeasuredObject((series,), len(found) - len(parts))


def _part(item: ReportedStatistics, data: bytes) -> TimeStatistics | None:
    """One report; None if it is incomplete, contradicts itself, or is of no values."""
    low, mean, high = item.min(data), item.mean(data), item.max(data)
    count = Fraction(1) if item.count is None else item.count(data)
    deviation = None if item.deviation is None else item.deviation(data)
    if low is None or mean is None or high is None or not count or not low <= mean <= high:
        return None
    least = -_LONGEST if item.quantity in _SIGNED else 0
    if not (least <= low and high <= _LONGEST and 0 < count <= _LONGEST and 0 <= (deviation or 0) <= _LONGEST):
        return None
    variance = None if deviation is None or item.count is None else deviation**2
    return TimeStatistics(count=int(count), min=round(low), mean=mean, max=round(high), variance=variance)
