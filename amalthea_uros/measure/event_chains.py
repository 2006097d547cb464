"""Latencies of chains from the steps that a trace has of them.

A chain begins with the activation of the job that makes its first step, or with its start if that is known of the chain; if the trace
does not have that, with the step. Where the chain of a model begins later in that job, the measured latencies are longer than those of
the model. It ends with the last step.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros._internal.arrays import Flags, Numbers
from amalthea_uros.measure.reactions import BY_NUMBER, LatencyLists, is_after_loss
from amalthea_uros.measure.series import Counts, Series
from amalthea_uros.timing.observed.chain_latencies import ObservedRouteLatencies
from amalthea_uros.trace.table import NO_NOTE, EventKind, EventTable

if TYPE_CHECKING:
    from numpy.typing import NDArray


#: Numbers of jobs have fewer bits.
_BITS = 40
#: The events of a job with which a chain can begin, in words.
BEGINS = {EventKind.ACTIVATE: "activation", EventKind.START: "start"}


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
    starts : of chains that do not begin with the activation of a job: with which event they do; None: they are not measured
    ambiguous : the chains with several routes, which are not measured
    """

    starts: Mapping[str, EventKind | None] = field(default_factory=dict)
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
            begin = self.starts.get(name, EventKind.ACTIVATE)
            if begin is None:
                continue
            found = self._ends(steps[:, steps[1] == number], begin)
            if found.has_several_routes:
                self.ambiguous.append(name)
            else:
                yield from (replace(each, begin=BEGINS[begin]) for each in _latencies(name, found, begin))

    def _ends(self, steps: Numbers, begin: EventKind) -> _ChainEnds:
        time, _, stimulus, step, segment, job = steps
        is_first, is_last = step == 0, step == step.max()
        begun, is_known = self._begun(begin, job)
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
    found, unanswered = LatencyLists(), 0
    order = np.argsort(steps.segment, kind="stable")
    for here in np.split(order, np.flatnonzero(np.diff(steps.segment[order])) + 1):
        is_response, stimulus = steps.is_response[here], steps.stimulus[here]
        latencies = ObservedRouteLatencies(found.note)
        latencies.add(is_response, steps.time[here], _in_order(is_response, stimulus))
        unanswered += latencies.stimuli - 1 - latencies.answered
    method = f"from the {BEGINS[begin]} of the job with the first step to the last step, by the number of the stimulus"
    yield from found.series(name, Counts(incomplete=unanswered), method, BY_NUMBER)


def _in_order(is_response: Flags, stimulus: Numbers) -> Numbers:
    """Of each event the place of its stimulus among those of this part of the trace; -1 if that is not in it."""
    known = np.sort(stimulus[~is_response])
    if not len(known):
        return np.full(len(stimulus), -1)
    place = np.searchsorted(known, stimulus)
    return np.where(known[np.minimum(place, len(known) - 1)] == stimulus, place, -1)


def _job(process: NDArray[np.int32], instance: Numbers) -> Numbers:
    return process.astype(np.int64) << _BITS | instance
