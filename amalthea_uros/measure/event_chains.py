"""Latencies of chains from the steps that a trace has of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.measure.reactions import LatencyLists
from amalthea_uros.measure.series import Counts, Series
from amalthea_uros.timing.chain_quantity import ChainQuantity
from amalthea_uros.timing.route_latencies import RouteLatencies
from amalthea_uros.trace.table import NO_NOTE, EventKind, EventTable

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Numbers = NDArray[np.int64]


@dataclass(slots=True)
class ChainSteps:
    """Collects the steps of all chains of a trace."""

    gaps: int = 0
    _columns: list[Numbers] = field(default_factory=list)

    def add(self, table: EventTable) -> None:
        """Take events in."""
        segment = self.gaps + np.cumsum(table.kind == EventKind.GAP)
        self.gaps += int(np.count_nonzero(table.kind == EventKind.GAP))
        is_step = (table.kind == EventKind.CHAIN_STEP) & (table.note != NO_NOTE)
        if is_step.any():
            columns = (table.time, table.target.astype(np.int64), table.target_instance, table.note, segment)
            self._columns.append(np.array([column[is_step] for column in columns]))

    def series(self, names: list[str]) -> Iterator[Series]:
        """The latencies of each chain: from its first step to its last one, by the number of the stimulus."""
        if not self._columns:
            return
        time, chain, stimulus, step, segment = np.concatenate(self._columns, axis=1)
        for number in np.unique(chain).tolist():
            here = chain == number
            last = int(step[here].max())
            is_end = here & ((step == 0) | (step == last)) if last else here
            found, unanswered = LatencyLists(), 0
            for part in np.unique(segment[is_end]).tolist():
                rows = is_end & (segment == part)
                latencies = RouteLatencies(found.note)
                is_response = (step[rows] == last) if last else np.zeros(int(rows.sum()), bool)
                latencies.add(is_response, time[rows], _in_order(is_response, stimulus[rows]))
                unanswered += latencies.stimuli - 1 - latencies.answered
            counts = Counts(incomplete=unanswered)
            yield from found.series(names[number], counts, "from the steps of the chain", tuple(ChainQuantity))


def _in_order(is_response: NDArray[np.bool_], stimulus: Numbers) -> Numbers:
    """Of each event its stimulus, counted from the first one of a part of the trace; -1 if that is not in it."""
    first = int(stimulus[~is_response].min()) if (~is_response).any() else int(stimulus.max()) + 1
    return np.maximum(stimulus - first, -1)
