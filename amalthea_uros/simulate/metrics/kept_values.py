"""The single values of a run, where their distribution is compared with another one: of chains, and of callbacks of executors."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric
from amalthea_uros.timing.observed.chain_latencies import SAME
from amalthea_uros.timing.observed.job_times import BETWEEN, OWN, own_times, times_between


@dataclass(slots=True)
class KeptValues:
    """Keeps values as they come.

    Attributes
    ----------
    most : so many values of each quantity are kept, the first ones
    units : time units in a picosecond
    """

    most: int
    units: int = 1
    _chains: dict[str, dict[ChainQuantity, list[Numbers]]] = field(default_factory=dict)
    _calls: dict[str, dict[str, list[Numbers]]] = field(default_factory=dict)

    def add_latencies(self, chain: str, quantity: ChainQuantity, values: Numbers) -> None:
        """Keep latencies of a chain."""
        kept = self._chains.setdefault(chain, {}).setdefault(quantity, [])
        kept.append(values[: max(0, self.most - sum(map(len, kept)))])

    def add_calls(self, runnable: str, handle: str, jobs: Numbers) -> None:
        """Keep calls of a callback for a handle: a column for each, in the order of their ends."""
        kept = self._calls.setdefault(runnable, {}).setdefault(handle, [])
        kept.append(jobs[:, : max(0, self.most - sum(each.shape[1] for each in kept))])

    def chains(self) -> Iterator[tuple[str, ChainQuantity, Numbers]]:
        """The latencies of each chain in picoseconds, by quantity."""
        for name, latencies in self._chains.items():
            for quantity in ChainQuantity:
                parts = latencies.get(SAME.get(quantity, quantity), [])
                if parts:
                    yield name, quantity, np.concatenate(parts) // self.units

    def calls(self) -> Iterator[tuple[str, JobMetric, Numbers]]:
        """The times of each callback in picoseconds, by metric; distances only where a single handle calls it."""
        for name, handles in self._calls.items():
            jobs = np.concatenate([each for parts in handles.values() for each in parts], axis=1)
            times = dict(zip(OWN, own_times(jobs), strict=True))
            if len(handles) == 1:
                times |= zip(BETWEEN, times_between(jobs[:, :-1], jobs[:, 1:]), strict=True)
            yield from ((name, metric, values // self.units) for metric, values in times.items())
