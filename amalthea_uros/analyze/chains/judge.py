"""Timing constraints on chains and events, judged by what was computed.

Their meaning is that of TADL2 (TIMMO-2-USE, deliverable D11), which AMALTHEA took over: a reaction constraint looks from each stimulus
forward to the first response that it has caused, an age constraint from each response back to the last stimulus that has caused it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from amalthea_uros.analyze.arrivals import Arrivals, Periodic
from amalthea_uros.analyze.chains.evaluate import Evaluation
from amalthea_uros.analyze.chains.order import in_order
from amalthea_uros.analyze.chains.places import Place
from amalthea_uros.analyze.chains.quantities import Quantity, Value
from amalthea_uros.analyze.chains.resolve import Carrier
from amalthea_uros.analyze.chains.result import ChainResult
from amalthea_uros.analyze.chains.spots import Spot, UnresolvedError, When
from amalthea_uros.analyze.chains.timing import UntimedError
from amalthea_uros.analyze.core import known_releases
from amalthea_uros.analyze.result import RequirementResult, Verdict
from amalthea_uros.perf.constraints import (
    ChainEnd,
    ChainSynchronization,
    DataAgeConstraint,
    DelayConstraint,
    EventSynchronization,
    LatencyConstraint,
    LatencyKind,
    Matching,
    OrderConstraint,
    RepetitionConstraint,
)
from amalthea_uros.perf.events import Event, EventSet, LabelChange, LabelEvent
from amalthea_uros.perf.named import Named
from amalthea_uros.perf.software import AccessKind, Call, LabelAccess
from amalthea_uros.units import Time

_REACTION = (Quantity.MIN_FIRST_TO_FIRST, Quantity.MAX_REDUCED_REACTION_TIME)
_AGE = (Quantity.MIN_LAST_TO_LAST, Quantity.MAX_REDUCED_DATA_AGE)


class _UnknownError(Exception):
    """A constraint cannot be judged; the text says why."""


@dataclass(frozen=True, slots=True)
class Judge:
    """Judges the constraints of a system."""

    evaluation: Evaluation
    chains: Mapping[str, ChainResult]

    def all(self) -> Iterator[RequirementResult]:
        """All constraints, those with two limits as two."""
        constraints = self.evaluation.known.system.constraints
        for constraint in (*constraints.constraints, *constraints.data_ages, *constraints.orders):
            try:
                yield from self._one(constraint)
            except (_UnknownError, UnresolvedError, UntimedError) as error:
                yield RequirementResult(
                    name=constraint.name,
                    object="",
                    quantity=type(constraint).__name__,
                    is_upper=True,
                    limit=None,
                    value=None,
                    verdict=Verdict.UNKNOWN,
                    reason=str(error),
                )

    def _one(self, constraint: Named) -> Iterator[RequirementResult]:
        match constraint:
            case LatencyConstraint():
                yield from self._latency(constraint)
            case DelayConstraint():
                yield from self._delay(constraint)
            case RepetitionConstraint():
                yield from self._repetition(constraint)
            case EventSynchronization(events=events, tolerance=tolerance):
                yield self._upper(constraint, ", ".join(events), "spread", tolerance, self._spread(events))
            case ChainSynchronization():
                yield self._chain_synchronization(constraint)
            case DataAgeConstraint():
                yield from self._data_age(constraint)
            case OrderConstraint():
                yield from self._order(constraint)

    # Chains

    def _latency(self, constraint: LatencyConstraint) -> Iterator[RequirementResult]:
        chain = self.chains.get(constraint.chain)
        if chain is None:
            raise _UnknownError(f"the chain {constraint.chain!r} is not part of the model")
        least, most = _AGE if constraint.kind is LatencyKind.AGE else _REACTION
        kind = str(constraint.kind)
        if constraint.maximum is not None:
            value = _time(chain.value(most))
            yield self._upper(constraint, chain.name, kind, constraint.maximum, value, chain.reason)
        if constraint.minimum is not None:
            value = _time(chain.value(least))
            yield self._lower(constraint, chain.name, kind, constraint.minimum, value, chain.reason)

    def _delay(self, constraint: DelayConstraint) -> Iterator[RequirementResult]:
        source, target = self._event(constraint.source), self._event(constraint.target)
        if constraint.matching is not Matching.REACTION:
            hops = {hop.carrier for route in self.evaluation.resolver.routes([source, target]) for hop in route.hops}
            if not hops <= {Carrier.JOB, Carrier.TRIGGER}:
                raise _UnknownError(
                    "where data are overwritten or read again, occurrences do not belong to each other one by one"
                )
        values = {value.quantity: value for value in self.evaluation.pair(source, target)}
        least, most = _REACTION
        what = f"{constraint.source} to {constraint.target}"
        if constraint.upper is not None:
            yield self._upper(constraint, what, "delay", constraint.upper, _time(values.get(most)))
        if constraint.lower is not None:
            yield self._lower(constraint, what, "delay", constraint.lower, _time(values.get(least)))

    def _chain_synchronization(self, constraint: ChainSynchronization) -> RequirementResult:
        found = [self.chains.get(name) for name in constraint.chains]
        system = self.evaluation.known.system
        chains = [system.chains[name] for name in constraint.chains if name in system.chains]
        if None in found or len(chains) < 2:
            raise _UnknownError("it needs two chains of the model")
        is_start = constraint.end is ChainEnd.STIMULUS
        ends = [chain.stimulus if is_start else chain.response for chain in chains]
        value: Time | None
        if not is_start and len({chain.stimulus for chain in chains}) == 1:
            # From the same stimulus: as much as one may be late and the other one early.
            latest = [_time(each.value(_REACTION[1])) for each in found if each is not None]
            earliest = [_time(each.value(_REACTION[0])) for each in found if each is not None]
            value = _difference(latest, earliest)
        else:
            value = self._spread([end for end in ends if end is not None])
        return self._upper(
            constraint, ", ".join(constraint.chains), f"spread at the {constraint.end}", constraint.tolerance, value
        )

    def _data_age(self, constraint: DataAgeConstraint) -> Iterator[RequirementResult]:
        """From each write of the runnable to the reads that still see it."""
        written = LabelEvent(name="write", label=constraint.label, change=LabelChange.WRITE, runnable=constraint.runnable)
        (spot, *_) = self.evaluation.resolver.spots.of(written)
        readers = {
            place.process.name
            for process in self.evaluation.known.system.processes
            for place in self.evaluation.resolver.spots.places(process)
            if _reads(place, constraint.label) and process != spot.process.name
        }
        releases = known_releases(spot.process, self.evaluation.known.system)
        cycle = releases.period if releases is not None else None
        latest = _cycles(constraint.latest, constraint.latest_cycle, cycle)
        earliest = _cycles(constraint.earliest, constraint.earliest_cycle, cycle)
        for name in sorted(readers):
            read = LabelEvent(name="read", label=constraint.label, change=LabelChange.READ, process=name)
            values = {value.quantity: value for value in self.evaluation.pair(written, read)}
            what = f"{constraint.label} in {name}"
            if latest is not None:
                yield self._upper(constraint, what, "age", latest, _time(values.get(_AGE[1])))
            if earliest is not None:
                yield self._lower(constraint, what, "age", earliest, _time(values.get(_AGE[0])))

    # Events

    def _event(self, name: str) -> Event:
        event = self.evaluation.known.system.events_by_name.get(name)
        if event is None or isinstance(event, EventSet):
            raise _UnknownError(f"there is no single event {name!r} in the model")
        return event

    def _repetition(self, constraint: RepetitionConstraint) -> Iterator[RequirementResult]:
        spot = self._spot(constraint.event)
        arrivals = self.evaluation.known.arrivals.get(spot.process.name)
        if arrivals is None:
            raise _UnknownError(f"the arrivals of {spot.process.name!r} are not known")
        early, late = self._window(spot)
        span = max(1, constraint.span)
        if constraint.upper is not None:
            longest = _longest(arrivals, span)
            value = None if longest is None else longest + late - early
            yield self._upper(constraint, constraint.event, "repetition", constraint.upper, value)
        if constraint.lower is not None:
            value = max(0, arrivals.span(span + 1) - (late - early))
            yield self._lower(constraint, constraint.event, "repetition", constraint.lower, value)
        if constraint.jitter is not None:
            own = arrivals.jitter if isinstance(arrivals, Periodic) and not arrivals.sporadic else None
            value = None if own is None else own + late - early
            yield self._upper(constraint, constraint.event, "jitter", constraint.jitter, value)

    def _spot(self, name: str) -> Spot:
        spots = self.evaluation.resolver.spots.of(self._event(name))
        if len(spots) > 1:
            raise _UnknownError(f"the event {name!r} occurs in several places")
        if any(counter.prescaler > 1 for counter in (spots[0].place.counters if spots[0].place else ())):
            raise _UnknownError(f"the event {name!r} occurs in some jobs only")
        return spots[0]

    def _window(self, spot: Spot) -> tuple[Time, Time]:
        """How long behind the activation an event occurs, at the earliest and at the latest."""
        response = self.evaluation.responses.get(spot.process.name)
        if response is None or response.worst is None:
            raise _UnknownError(f"the response time of {spot.process.name!r} is not known, or has no bound")
        known = self.evaluation.known
        least = known.costs[spot.process.name].best // known.demands.grains(known.placed[spot.process.name].core)
        match spot.when:
            case When.ACTIVATION:
                return 0, 0
            case When.START:
                return 0, response.worst - least
            case When.END:
                return response.best, response.worst
        return 0, response.worst

    def _spread(self, events: Sequence[str]) -> Time:
        """How far apart events of processes of the same period can occur."""
        windows = []
        periods = set()
        for name in events:
            spot = self._spot(name)
            releases = known_releases(spot.process, self.evaluation.known.system)
            if releases is None:
                raise _UnknownError(f"the releases of {spot.process.name!r} are not known")
            periods.add(releases.period)
            early, late = self._window(spot)
            offset = releases.offset % releases.period
            windows.append((offset + early, offset + late))
        if not windows:
            raise _UnknownError("it names no events")
        if len(periods) > 1:
            raise _UnknownError("its events have different periods, so that not each of them has a partner")
        return max(late for _, late in windows) - min(early for early, _ in windows)

    # Order

    def _order(self, constraint: OrderConstraint) -> Iterator[RequirementResult]:
        wanted = [name for group in constraint.groups for name in group]
        for process in constraint.processes or tuple(self.evaluation.known.system.processes):
            called = [
                place.activity.runnable
                for place in self.evaluation.resolver.spots.places(process)
                if isinstance(place.activity, Call) and len(place.outer) == 1
            ]
            if not any(name in called for name in wanted):
                continue
            holds = in_order(called, constraint)
            yield RequirementResult(
                name=constraint.name,
                object=process,
                quantity="order of runnables",
                is_upper=True,
                limit=None,
                value=None,
                verdict=Verdict.MET if holds else Verdict.MISSED,
            )

    # Results

    def _upper(
        self, constraint: Named, what: str, quantity: str, limit: Time, value: Time | None, reason: str = ""
    ) -> RequirementResult:
        verdict = Verdict.UNKNOWN if value is None else Verdict.MET if value <= limit else Verdict.MISSED
        return RequirementResult(
            name=constraint.name,
            object=what,
            quantity=quantity,
            is_upper=True,
            limit=limit,
            value=value,
            verdict=verdict,
            reason=reason if value is None else "",
        )

    def _lower(
        self, constraint: Named, what: str, quantity: str, limit: Time, value: Time | None, reason: str = ""
    ) -> RequirementResult:
        # Nothing is faster than at once.
        value = 0 if value is None and not reason else value
        verdict = Verdict.UNKNOWN if value is None else Verdict.MET if value >= limit else Verdict.MISSED
        return RequirementResult(
            name=constraint.name,
            object=what,
            quantity=quantity,
            is_upper=False,
            limit=limit,
            value=value,
            verdict=verdict,
            reason=reason if value is None else "",
        )


def _time(value: Value | None) -> Time | None:
    return value.value if value is not None else None


def _difference(latest: Sequence[Time | None], earliest: Sequence[Time | None]) -> Time | None:
    if None in latest or None in earliest:
        return None
    return max(time for time in latest if time is not None) - min(time for time in earliest if time is not None)


def _cycles(time: Time | None, cycles: int | None, period: Time | None) -> Time | None:
    if time is not None or cycles is None:
        return time
    if period is None:
        raise _UnknownError("activations are no time where the period of the writer is not known")
    return cycles * period


def _longest(arrivals: Arrivals, count: int) -> Time | None:
    """The longest time that so many steps from one arrival to the next can take."""
    if isinstance(arrivals, Periodic) and not arrivals.sporadic:
        return count * arrivals.period + arrivals.jitter
    return None if arrivals.gap is None else count * arrivals.gap


def _reads(place: Place, label: str) -> bool:
    access = place.activity
    return isinstance(access, LabelAccess) and access.label == label and access.kind is AccessKind.READ
