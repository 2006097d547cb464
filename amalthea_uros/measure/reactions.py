"""Latencies of chains from the times of their stimuli and responses; `timing.route_latencies` defines them.

Where the events have the number of the stimulus, each response shows the stimulus with its number. Where they have none, each
response is taken to show the latest stimulus before it: no chain is faster, so the times are the shortest that are possible.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np

from amalthea_uros._internal.arrays import Flags, Numbers
from amalthea_uros.measure.pairing import counted_on, lost_numbers
from amalthea_uros.measure.series import Counts, MeasuredKind, Series, statistics_of
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.timing.observed.chain_latencies import SAME, ObservedRouteLatencies

#: What can be said where it is not known which stimulus a response shows.
_BY_TIME = (ChainQuantity.REDUCED_REACTION_TIME, ChainQuantity.REDUCED_DATA_AGE)
#: All of them, the usual one first.
BY_NUMBER = tuple(dict.fromkeys((*_BY_TIME, *ChainQuantity)))
#: The values that begin at the stimulus whose time is noted with them.
_FROM_STIMULUS = (*_BY_TIME, ChainQuantity.DATA_AGE, ChainQuantity.LAST_TO_FIRST)


class LatencyLists:
    """The latencies of a chain, in the order in which they are complete."""

    def __init__(self) -> None:
        self._values: dict[ChainQuantity, list[Numbers]] = {}
        self._times: dict[ChainQuantity, list[Numbers]] = {}

    def note(self, quantity: ChainQuantity, values: Numbers, _stimuli: Numbers, starts: Numbers) -> None:
        """Take values in."""
        self._values.setdefault(quantity, []).append(values)
        self._times.setdefault(quantity, []).append(starts + values)

    def series(self, name: str, counts: Counts, method: str, quantities: tuple[ChainQuantity, ...]) -> Iterator[Series]:
        """Those of the quantities that have a value; if none has one, the first of them without."""
        if not any(len(part) for parts in self._values.values() for part in parts):
            yield Series(
                kind=MeasuredKind.CHAIN, name=name, quantity=quantities[0], statistics=None, counts=counts, method=method
            )
        for quantity in quantities:
            noted = SAME.get(quantity, quantity)
            values = np.concatenate([np.empty(0, np.int64), *self._values.get(noted, [])])
            if len(values):
                yield Series(
                    kind=MeasuredKind.CHAIN,
                    name=name,
                    quantity=quantity,
                    statistics=statistics_of(values),
                    values=values,
                    times=np.concatenate(self._times[noted]) if noted in _FROM_STIMULUS else None,
                    counts=counts,
                    method=method,
                )


def reactions(
    name: str, time: Numbers, segment: Numbers, is_response: Flags, counter: Numbers | None, modulus: int | None
) -> Iterator[Series]:
    """The latencies of a chain; nothing is measured across a gap.

    Parameters
    ----------
    time, segment, is_response : of the events, in the order of the log
    counter : number of the stimulus of each event, from 0 to `modulus` - 1; None if the events have none
    """
    lost = duplicated = 0
    segment = segment.astype(np.int64)
    number: Numbers | None = None
    if counter is not None and modulus is not None:
        number, run = counted_on(counter, modulus)
        lost = lost_numbers(number[~is_response], run[~is_response])
        is_new = (np.diff(segment) != 0) | (np.diff(run) != 0)
        segment = np.cumsum(np.concatenate([[False], is_new])[: len(segment)] | is_after_loss(number, is_response))
    # A step back ends what can be compared.
    is_back = np.concatenate([[False], (time[1:] < time[:-1]) & (segment[1:] == segment[:-1])])[: len(time)]
    segment = segment + np.cumsum(is_back)
    found, unanswered = LatencyLists(), 0
    borders = [0, *(np.flatnonzero(np.diff(segment)) + 1).tolist(), len(segment)]
    for first, end in pairwise(borders if len(segment) else []):
        here = slice(first, end)
        latencies = ObservedRouteLatencies(found.note)
        kept, stamps, repeated = _stamped(is_response[here], None if number is None else number[here])
        duplicated += repeated
        latencies.add(is_response[here][kept], time[here][kept], stamps)
        unanswered += latencies.stimuli - 1 - latencies.answered
    counts = Counts(incomplete=unanswered, lost=lost, duplicated=duplicated, reordered=int(np.count_nonzero(is_back)))
    if number is None:
        method = "each response with the latest stimulus before it (the least possible)"
        yield from (replace(series, is_least=True) for series in found.series(name, counts, method, _BY_TIME))
    else:
        yield from found.series(name, counts, "by the number of the stimulus", BY_NUMBER)


def is_after_loss(number: Numbers, is_response: Flags) -> Flags:
    """Which events are stimuli directly after lost ones: how long events waited before them is not known."""
    stimuli = np.flatnonzero(~is_response)
    newest = np.maximum.accumulate(number[stimuli])
    is_after = np.zeros(len(number), bool)
    is_after[stimuli[1:]] = number[stimuli[1:]] > newest[:-1] + 1
    return is_after


def _stamped(is_response: Flags, number: Numbers | None) -> tuple[Numbers, Numbers, int]:
    """The events to evaluate, the stimulus of each, and how many stimuli are left out because their number was there before.

    Stimuli are counted in their order, whatever numbers are missing.
    """
    if number is None:
        return np.arange(len(is_response)), np.cumsum(~is_response) - 1, 0
    stimuli = np.flatnonzero(~is_response)
    first = np.unique(number[stimuli], return_index=True)[1]
    is_kept = is_response.copy()
    # Stimuli that overtook each other keep the order of the log; those that come late are left out.
    firsts = stimuli[np.sort(first)]
    rising = np.maximum.accumulate(number[firsts]) == number[firsts]
    firsts = firsts[rising]
    is_kept[firsts] = True
    kept = np.flatnonzero(is_kept)
    known = number[firsts]
    # Which stimulus, in order, each response shows; none if it was lost, or comes only after the response.
    place = np.searchsorted(known, number[kept])
    is_known = (place < len(known)) & (known[np.minimum(place, len(known) - 1)] == number[kept]) if len(known) else place < 0
    before = np.cumsum(~is_response[kept])
    stamps = np.where(is_known & (place < before), place, -1)
    return kept, stamps, len(stimuli) - len(firsts)
