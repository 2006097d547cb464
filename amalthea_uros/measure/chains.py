"""Latencies of chains, from markers in a log or from the steps that a trace has; `timing.observed.chain_latencies` defines them.

Where the markers have the number of the stimulus, each response shows the stimulus with its number. Where they have none, each
response is taken to show the latest stimulus before it: no chain is faster, so the times are the shortest that are possible.

In a trace, a chain begins with the activation of the job that makes its first step, or with its start if that is known of the chain; if
the trace does not have that, with the step. Where the chain of a model begins later in that job, the measured latencies are longer than
those of the model. It ends with the last step.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros._internal.arrays import Flags, Numbers
from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.measure.begins import BEGINS, ChainBegin, begin_name
from amalthea_uros.measure.pairing import counted_on, lost_numbers
from amalthea_uros.measure.series import Counts, MeasuredKind, Series, statistics_of
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.timing.observed.chain_latencies import SAME, ObservedRouteLatencies
from amalthea_uros.trace.table import NO_NOTE, EventKind, EventTable

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: What can be said where it is not known which stimulus a response shows.
_BY_TIME = (ChainQuantity.REDUCED_REACTION_TIME, ChainQuantity.REDUCED_DATA_AGE)
#: All of them, the usual one first.
BY_NUMBER = tuple(dict.fromkeys((*_BY_TIME, *ChainQuantity)))
#: The values that begin at the stimulus whose time is noted with them.
_FROM_STIMULUS = (*_BY_TIME, ChainQuantity.DATA_AGE, ChainQuantity.LAST_TO_FIRST)


class LatencyLists:
    """The latencies of a chain, in the order in which they are complete.

    Attributes
    ----------
    unanswered : number of stimuli without a response
    """

    def __init__(self) -> None:
        self.unanswered = 0
        self._values: dict[ChainQuantity, list[Numbers]] = {}
        self._times: dict[ChainQuantity, list[Numbers]] = {}

    def add(self, is_response: Flags, time: Numbers, stamps: Numbers) -> None:
        """Take a part of the events in that nothing is missing in; `stamps` says which stimulus each shows."""
        latencies = ObservedRouteLatencies(self._note)
        latencies.add(is_response, time, stamps)
        self.unanswered += latencies.stimuli - 1 - latencies.answered

    def _note(self, quantity: ChainQuantity, values: Numbers, _stimuli: Numbers, starts: Numbers) -> None:
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
    found = LatencyLists()
    borders = [0, *(np.flatnonzero(np.diff(segment)) + 1).tolist(), len(segment)]
    for first, end in pairwise(borders if len(segment) else []):
        here = slice(first, end)
        kept, stamps, repeated = _stamped(is_response[here], None if number is None else number[here])
        duplicated += repeated
        found.add(is_response[here][kept], time[here][kept], stamps)
    counts = Counts(incomplete=found.unanswered, lost=lost, duplicated=duplicated, reordered=int(np.count_nonzero(is_back)))
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


# Latencies of chains from the steps that a trace has of them.


#: Numbers of jobs have fewer bits.
_BITS = 40


@dataclass(frozen=True, slots=True)
class _ChainEnds:
    """The first and the last steps of a chain, in the order of time; `stimulus` is the number of the stimulus."""

    time: Numbers
    stimulus: Numbers
    segment: Numbers
    is_response: Flags

    @property
    def has_several_routes(self) -> bool:
        """Whether stimuli of several routes have the same numbers, so that it is not known which of them a response shows."""
        first = self.stimulus[~self.is_response]
        return len(np.unique(first)) < len(first)


@dataclass(slots=True)
class ChainSteps:
    """Collects the steps of all chains of a trace.

    Attributes
    ----------
    starts : of chains that do not begin as usual: with which event they do, or why they are not measured
    usual : with which event the others do
    ambiguous : the chains with several routes, which are not measured
    """

    starts: Mapping[str, ChainBegin] = field(default_factory=dict)
    usual: EventKind = EventKind.ACTIVATE
    gaps: int = 0
    ambiguous: list[str] = field(default_factory=list)
    _steps: list[Numbers] = field(default_factory=list)
    _begins: dict[EventKind, list[Numbers]] = field(default_factory=lambda: {kind: [] for kind in BEGINS})

    def add(self, table: EventTable) -> None:
        """Take events in."""
        segment = self.gaps + np.cumsum(table.kind == EventKind.GAP)
        self.gaps += int(np.count_nonzero(table.kind == EventKind.GAP))
        is_step = (table.kind == EventKind.CHAIN_STEP) & (table.note != NO_NOTE)
        if is_step.any():
            job = _job(table.source, table.source_instance)
            columns = (table.time, table.target.astype(np.int64), table.target_instance, table.note, segment, job)
            self._steps.append(np.array([column[is_step] for column in columns]))
        for kind, found in self._begins.items():
            here = table.kind == kind
            found.append(np.array([_job(table.target[here], table.target_instance[here]), table.time[here]]))

    def series(self, names: Sequence[str]) -> Iterator[Series]:
        """The latencies of each chain, by the number of the stimulus."""
        if not self._steps:
            return
        steps = np.concatenate(self._steps, axis=1)
        for number in np.unique(steps[1]).tolist():
            name = names[number]
            begin = self.starts.get(name, self.usual)
            if isinstance(begin, str):
                continue
            found = self._ends(steps[:, steps[1] == number], begin)
            if found.has_several_routes:
                self.ambiguous.append(name)
            else:
                yield from (replace(each, begin=begin_name(begin)) for each in _latencies(name, found, begin))

    def _ends(self, steps: Numbers, begin: EventKind) -> _ChainEnds:
        time, _, stimulus, step, segment, job = steps
        is_first, is_last = step == 0, step == step.max()
        begun, is_known = (time, np.zeros(len(job), bool)) if begin not in BEGINS else self._begun(begin, job)
        if is_known[is_first].any():
            # A step without it is at the edge of the trace, or events are missing: the chain began earlier.
            is_first &= is_known
        else:
            begun = time
        times = np.concatenate([begun[is_first], time[is_last]])
        is_response = np.repeat([False, True], [np.count_nonzero(is_first), np.count_nonzero(is_last)])
        order = np.lexsort((is_response, times))
        stimuli, segments = (np.concatenate([column[is_first], column[is_last]])[order] for column in (stimulus, segment))
        return _ChainEnds(
            times[order], stimuli, segments + np.cumsum(is_after_loss(stimuli, is_response[order])), is_response[order]
        )

    def _begun(self, kind: EventKind, jobs: Numbers) -> tuple[Numbers, Flags]:
        """When jobs were activated or started, and whether the trace says it."""
        known, times = np.concatenate(self._begins[kind], axis=1)
        if not len(known):
            return jobs, np.zeros(len(jobs), bool)
        order = np.argsort(known, kind="stable")
        found = order[np.minimum(np.searchsorted(known, jobs, sorter=order), len(order) - 1)]
        return times[found], known[found] == jobs


def _latencies(name: str, steps: _ChainEnds, begin: EventKind) -> Iterator[Series]:
    found = LatencyLists()
    order = np.argsort(steps.segment, kind="stable")
    for here in np.split(order, np.flatnonzero(np.diff(steps.segment[order])) + 1):
        is_response, stimulus = steps.is_response[here], steps.stimulus[here]
        found.add(is_response, steps.time[here], _in_order(is_response, stimulus))
    first = f"{begin_name(begin)}{' of the job with the first step' if begin in BEGINS else ''}"
    method = f"from the {first} to the last step, by the number of the stimulus"
    yield from found.series(name, Counts(incomplete=found.unanswered), method, BY_NUMBER)


def _in_order(is_response: Flags, stimulus: Numbers) -> Numbers:
    """Of each event the place of its stimulus among those of this part of the trace; -1 if that is not in it."""
    known = np.sort(stimulus[~is_response])
    if not len(known):
        return np.full(len(stimulus), -1)
    place = np.searchsorted(known, stimulus)
    return np.where(known[np.minimum(place, len(known) - 1)] == stimulus, place, -1)


def _job(process: NDArray[np.int32], instance: Numbers) -> Numbers:
    return process.astype(np.int64) << _BITS | instance
