"""End-to-end latencies of a route of a chain in a run, with their distributions."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.simulate.kernel.layout import RESPONSE, Observation
from amalthea_uros.simulate.metrics.distributions import MetricDistributions
from amalthea_uros.simulate.observations import ChainObservation, MetricObservation, RouteObservation
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.timing.observed.chain_latencies import MEASURED, SAME, ObservedRouteLatencies

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence


@dataclass(slots=True)
class RouteMetrics:
    """The latencies of a route.

    Attributes
    ----------
    base : time units in a picosecond
    keep : takes the values, too
    """

    base: int
    keep: Callable[[ChainQuantity, Numbers], None] | None = None
    _found: dict[ChainQuantity, MetricDistributions] = field(init=False)
    _latencies: ObservedRouteLatencies = field(init=False)

    def __post_init__(self) -> None:
        self._found = {quantity: MetricDistributions(size=1, base=self.base, with_histograms=(0,)) for quantity in MEASURED}
        self._latencies = ObservedRouteLatencies(self._note)

    def add(self, rows: Numbers) -> None:
        """Take observations in: a row for each, with a column for each of `Observation`, in the order of time."""
        is_response = rows[:, Observation.KIND] == RESPONSE
        self._latencies.add(is_response, rows[:, Observation.TIME], rows[:, Observation.STAMP])

    def observation(self, text: str, end: int) -> RouteObservation:
        """What was observed up to the end of the run, in time units."""
        found = self._latencies
        waiting = found.unanswered
        return RouteObservation(
            text=text,
            quantities=_quantities(self._found),
            stimuli=found.stimuli,
            responses=found.responses,
            unanswered=found.stimuli - 1 - found.answered,
            longest_unanswered=Fraction(end - int(waiting[0]), self.base) if len(waiting) else Fraction(0),
            not_evaluated=found.not_evaluated,
        )

    def _note(self, quantity: ChainQuantity, values: Numbers, stimuli: Numbers, times: Numbers) -> None:
        self._found[quantity].add(values[None, :], stimuli, times)
        if self.keep is not None:
            self.keep(quantity, values)

    def merge_into(self, merged: Mapping[ChainQuantity, MetricDistributions]) -> None:
        """Add the latencies to those of other routes."""
        for quantity, found in self._found.items():
            merged[quantity].merge(found)


def add_rows(rows: Numbers, routes: Sequence[RouteMetrics]) -> None:
    """Take a chunk of rows in, of all routes, in the order of time."""
    for number in np.unique(rows[:, Observation.ROUTE]).tolist():
        routes[number].add(rows[rows[:, Observation.ROUTE] == number])


def chain_observation(name: str, routes: Sequence[tuple[str, RouteMetrics]], end: int, reason: str = "") -> ChainObservation:
    """What was observed of a chain up to the end of a run.

    Parameters
    ----------
    routes : with the texts that describe them, which need not differ; the values of all of them together are those of the chain
    end : in time units
    """
    merged: dict[ChainQuantity, MetricDistributions] = {}
    for _, route in routes:
        merged = merged or {
            quantity: MetricDistributions(size=1, base=route.base, with_histograms=(0,)) for quantity in MEASURED
        }
        route.merge_into(merged)
    return ChainObservation(
        name=name,
        quantities=_quantities(merged),
        routes=tuple(route.observation(text, end) for text, route in routes),
        reason=reason,
    )


def _quantities(found: Mapping[ChainQuantity, MetricDistributions]) -> dict[ChainQuantity, MetricObservation]:
    """What was observed of each quantity."""
    observations: dict[ChainQuantity, MetricObservation] = {}
    for quantity in ChainQuantity:
        distributions = found.get(SAME.get(quantity, quantity))
        observation = None if distributions is None else distributions.observation(0)
        if observation is not None:
            observations[quantity] = observation
    return observations
