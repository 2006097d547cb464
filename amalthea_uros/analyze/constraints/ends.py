"""Between which ends latencies of chains and distances of events are proved to lie."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import permutations

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.results.chains import LatencyQuantity, LatencyValue
from amalthea_uros.judge.evidence import Ends
from amalthea_uros.judge.limits import SystemLimit
from amalthea_uros.perf.constraints import (
    RepetitionConstraint,
)
from amalthea_uros.timing.basics.quantities import jitter_of
from amalthea_uros.timing.event_models.models import EventModel, PeriodicEvents, can_be_dense, is_strictly_periodic
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import Time, time_text


@dataclass(frozen=True, slots=True)
class LatencyEnds:
    """Between which ends the maximum and the minimum of a latency lie."""

    values: Sequence[LatencyValue]
    minimum: LatencyQuantity
    maximum: LatencyQuantity

    @property
    def of_maximum(self) -> Ends:
        """An exact value, or from a lower bound of all latencies up to an upper bound."""
        lowest, highest = self._find(self.minimum), self._find(self.maximum)
        if highest is not None and highest.value is not None and highest.claim is Claim.EXACT:
            return Ends.exactly(highest.value)
        return Ends(_time(lowest), _time(highest))

    @property
    def of_minimum(self) -> Ends:
        """An exact value, or from a lower bound up to an upper bound of all latencies; no latency is negative."""
        lowest, highest = self._find(self.minimum), self._find(self.maximum)
        if lowest is not None and lowest.value is not None and lowest.claim is Claim.EXACT:
            return Ends.exactly(lowest.value)
        return Ends(_time(lowest) or 0, _time(highest))

    def limited(self, limit: SystemLimit) -> Ends:
        """Between which ends the limited maximum or minimum lies."""
        return self.of_maximum if limit.is_upper else self.of_minimum

    @property
    def spread(self) -> tuple[Time, Time] | None:
        """A lower bound of the minimum and an upper bound of the maximum; None if one of them is unknown."""
        lowest, highest = self.of_minimum.lower, self.of_maximum.upper
        return None if lowest is None or highest is None else (lowest, highest)

    def jitter(self, is_one_run: bool) -> Ends:
        """Maximum minus minimum; exact values are known to occur together if there is only one run."""
        if self.spread is None:
            return Ends()
        greatest, least, upper = self.of_maximum, self.of_minimum, jitter_of(*self.spread)
        is_exact = greatest.lower == greatest.upper and least.lower == least.upper
        return Ends(upper if is_exact and is_one_run else 0, upper)

    def _find(self, quantity: LatencyQuantity) -> LatencyValue | None:
        return next((value for value in self.values if value.quantity is quantity), None)


def _time(value: LatencyValue | None) -> Time | None:
    return value.value if value is not None else None


def spread_of(latencies: Sequence[LatencyEnds]) -> Ends:
    """Between which ends the maximum distance of the responses to one stimulus lies.

    In the case of the greatest latency of a chain, another one takes at most its maximum.
    """
    latest, earliest = [each.of_maximum for each in latencies], [each.of_minimum for each in latencies]
    uppers = [ends.upper for ends in latest if ends.upper is not None]
    lowers = [ends.lower for ends in earliest if ends.lower is not None]
    upper = max(uppers) - min(lowers) if len(uppers) == len(latest) and lowers else None
    apart = [
        one.lower - other.upper for one, other in permutations(latest, 2) if one.lower is not None and other.upper is not None
    ]
    return Ends(max(0, *apart) if apart else 0, upper)


def moved(distance: Ends, by: Time) -> Ends:
    """A distance of activations as one of events that follow them after varying times."""
    lower, upper = distance.lower, distance.upper
    return Ends(None if lower is None else max(0, lower - by), None if upper is None else upper + by)


def repetition_jitter(constraint: RepetitionConstraint, activations: EventModel, moves: Time) -> tuple[Ends, str]:
    """Between which ends the jitter of an event lies that follows strictly periodic activations, or why that is unknown."""
    if not isinstance(activations, PeriodicEvents) or not is_strictly_periodic(activations):
        return Ends(), "its activations are not strictly periodic"
    period, distance = activations.period, max(1, constraint.span) * activations.period
    if constraint.period not in (None, period):
        return (
            Ends(),
            f"the event occurs every {time_text(period)}, not in the stated period, so that no jitter bounds its deviation",
        )
    if distance < (constraint.lower or 0) or (constraint.upper is not None and distance > constraint.upper):
        return Ends(), f"the limits exclude the mean distance of {time_text(distance)}, so that no jitter bounds its deviation"
    # Ideal points between limits can follow the events; those of a stated period cannot.
    lower = max(0, activations.jitter - moves) if constraint.period is not None else 0
    return Ends(lower, activations.jitter + moves), ""


def distance_of(events: EventModel, count: int, is_upper: bool) -> Ends:
    """Between which ends the distance of `count` repetitions lies; event models that are not periodic only bound it."""
    distance = _longest(events, count) if is_upper else events.delta_min(count + 1)
    if can_be_dense(events):
        return Ends(distance, distance)
    return Ends(None, distance) if is_upper else Ends(distance, None)


def _longest(events: EventModel, count: int) -> Time | None:
    """The maximum time from an event to the one `count` after it."""
    if isinstance(events, PeriodicEvents) and is_strictly_periodic(events):
        return count * events.period + events.jitter
    return None if events.max_interarrival is None else count * events.max_interarrival
