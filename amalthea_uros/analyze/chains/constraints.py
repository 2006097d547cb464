"""Verdicts on timing constraints of chains and events.

The constraints have the semantics of TADL2 (TIMMO-2-USE, deliverable D11), from which AMALTHEA adopted them: a reaction constraint
looks from each stimulus forward to the first response caused by it, an age constraint from each response back to the last stimulus
that caused it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import permutations

import numpy as np

from amalthea_uros._internal.failures import failure
from amalthea_uros.analyze.chains.evaluator import ChainEvaluator
from amalthea_uros.analyze.chains.event_windows import EventWindows, UnknownError
from amalthea_uros.analyze.chains.stage_timing import UnboundedStageError
from amalthea_uros.analyze.implausible_limits import note_implausible
from amalthea_uros.analyze.results import ChainResult, Claim, Quantity, RequirementResult, Value
from amalthea_uros.analyze.verdicts import Ends, Verdict, decide, undecided
from amalthea_uros.perf.activities import Call
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
from amalthea_uros.perf.events import EventChain, LabelChange, LabelEvent
from amalthea_uros.perf.named import Named
from amalthea_uros.timing.dataflow.events import UnresolvedError
from amalthea_uros.timing.dataflow.links import LinkKind
from amalthea_uros.timing.dataflow.routes import routes
from amalthea_uros.timing.event_models import EventModel, Periodic, can_be_dense, is_strictly_periodic
from amalthea_uros.timing.jitter import jitter_name, jitter_of
from amalthea_uros.timing.releases import known_releases
from amalthea_uros.timing.runnable_order import satisfies_order
from amalthea_uros.units import Time, time_text

_REACTION = (Quantity.MIN_FIRST_TO_FIRST, Quantity.MAX_REDUCED_REACTION_TIME)
_AGE = (Quantity.MIN_LAST_TO_LAST, Quantity.MAX_REDUCED_DATA_AGE)


@dataclass(slots=True)
class ConstraintEvaluator:
    """Evaluates the constraints of a system."""

    evaluation: ChainEvaluator
    chains: Mapping[str, ChainResult]
    windows: EventWindows = field(init=False)

    def __post_init__(self) -> None:
        self.windows = EventWindows(self.evaluation)

    def all(self) -> Iterator[RequirementResult]:
        """The verdict on each limit of each constraint."""
        constraints = self.evaluation.context.system.constraints
        for constraint in (*constraints.constraints, *constraints.data_ages, *constraints.orders):
            try:
                found = list(self._one(constraint))
                for result in found:
                    note_implausible(result, constraint, self.evaluation.context.notes)
                # What limits nothing is not met.
                yield from found or [_unknown(constraint, "it states no limit, or nothing in the model is limited by it")]
            except (UnknownError, UnresolvedError, UnboundedStageError) as error:
                yield _unknown(constraint, str(error))
            except Exception as error:
                # An error of this program leaves one constraint unknown, not all.
                reason = f"the evaluation failed: {failure(error)}"
                message = f"the constraint {constraint.name!r} is unknown: {reason}"
                self.evaluation.context.notes.error("CHN006", message, constraint)
                yield _unknown(constraint, reason)

    def _one(self, constraint: Named) -> Iterator[RequirementResult]:
        match constraint:
            case LatencyConstraint():
                yield from self._latency(constraint)
            case DelayConstraint():
                yield from self._delay(constraint)
            case RepetitionConstraint():
                yield from self._repetition(constraint)
            case EventSynchronization(events=events, tolerance=tolerance):
                yield _result(constraint, ", ".join(events), "spread", tolerance, self.windows.spread(events))
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
            raise UnknownError(f"the chain {constraint.chain!r} is not defined in the model")
        minimum, maximum = _AGE if constraint.kind is LatencyKind.AGE else _REACTION
        kind = "data age" if constraint.kind is LatencyKind.AGE else "reaction"
        ends = _Latencies(chain.values, minimum, maximum)
        if constraint.maximum is not None:
            # Without a bound, what keeps the chain from being exact is the cause.
            cause = chain.reason or (chain.why.removeprefix("bounds: ") if ends.of_maximum.upper is None else "")
            yield _result(constraint, chain.name, kind, constraint.maximum, ends.of_maximum, cause)
        if constraint.minimum is not None:
            yield _result(constraint, chain.name, kind, constraint.minimum, ends.of_minimum, chain.reason, is_upper=False)
        if constraint.jitter is not None:
            jitter = ends.jitter(self._is_one_run(self.evaluation.context.system.chains[chain.name]))
            found = _result(constraint, chain.name, jitter_name(kind), constraint.jitter, jitter, chain.reason)
            yield replace(found, spread=ends.spread)

    def _is_one_run(self, chain: EventChain) -> bool:
        """Whether jobs that a chain passes can only run in one way: with known phases, and best cases that are the worst ones."""
        if self.evaluation.occurrences(chain):
            return False
        for stage in self.evaluation.stages(chain):
            name = stage.process.name
            core = self.evaluation.context.scheduled[name].core
            found = self.evaluation.timing.schedules.of(core, with_slices=False)
            if found is None or name not in found.tasks or not np.array_equal(found.best[name].ends, found.worst[name].ends):
                return False
        return True

    def _delay(self, constraint: DelayConstraint) -> Iterator[RequirementResult]:
        source, target = self.windows.event(constraint.source), self.windows.event(constraint.target)
        if constraint.matching is not Matching.REACTION:
            found = routes([source, target], self.evaluation.context.dataflow)
            links = {link.kind for route in found for link in route.links}
            later = any(
                stage.jobs_later is not None for route in found for group in self.evaluation.groups(route) for stage in group
            )
            if later or not links <= {LinkKind.JOB, LinkKind.TRIGGER}:
                raise UnknownError(
                    "data between the events can be overwritten or read again, so their occurrences do not correspond one to one"
                )
        ends = _Latencies(self.evaluation.pair(source, target), *_REACTION)
        what = f"{constraint.source} to {constraint.target}"
        if constraint.upper is not None:
            yield _result(constraint, what, "delay", constraint.upper, ends.of_maximum)
        if constraint.lower is not None:
            yield _result(constraint, what, "delay", constraint.lower, ends.of_minimum, is_upper=False)

    def _chain_synchronization(self, constraint: ChainSynchronization) -> RequirementResult:
        found = [self.chains.get(name) for name in constraint.chains]
        system = self.evaluation.context.system
        chains = [system.chains[name] for name in constraint.chains if name in system.chains]
        if None in found or len(chains) < 2:
            raise UnknownError("it needs at least two chains that are defined in the model")
        is_start = constraint.end is ChainEnd.STIMULUS
        ends = [chain.stimulus if is_start else chain.response for chain in chains]
        if not is_start and len({chain.stimulus for chain in chains}) == 1:
            spread = _spread([_Latencies(each.values, *_REACTION) for each in found if each is not None])
        else:
            spread = self.windows.spread([end for end in ends if end is not None])
        return _result(
            constraint, ", ".join(constraint.chains), f"spread at the {constraint.end}", constraint.tolerance, spread
        )

    def _data_age(self, constraint: DataAgeConstraint) -> Iterator[RequirementResult]:
        """The age of the data written by the runnable at each read of another process."""
        written = LabelEvent(name="write", label=constraint.label, change=LabelChange.WRITE, runnable=constraint.runnable)
        (occurrence, *others) = self.evaluation.context.dataflow.events.of(written)
        if any(other.process.name != occurrence.process.name for other in others):
            raise UnknownError(f"{constraint.runnable!r} writes in several processes, whose cycles and readers differ")
        reading = LabelEvent(name="read", label=constraint.label, change=LabelChange.READ)
        readers = {
            position.process.name
            for position in self.evaluation.context.dataflow.events.raising(reading)
            if position.process.name != occurrence.process.name
        }
        releases = known_releases(occurrence.process, self.evaluation.context.system)
        cycle = releases.period if releases is not None else None
        latest = _cycles(constraint.latest, constraint.latest_cycle, cycle)
        earliest = _cycles(constraint.earliest, constraint.earliest_cycle, cycle)
        for name in sorted(readers):
            ends = _Latencies(self.evaluation.pair(written, replace(reading, process=name)), *_AGE)
            what = f"{constraint.label} in {name}"
            if latest is not None:
                yield _result(constraint, what, "data age", latest, ends.of_maximum)
            if earliest is not None:
                yield _result(constraint, what, "data age", earliest, ends.of_minimum, is_upper=False)

    # Events

    def _repetition(self, constraint: RepetitionConstraint) -> Iterator[RequirementResult]:
        occurrence = self.windows.occurrence(constraint.event)
        activations = self.evaluation.solution.event_models.get(occurrence.process.name)
        if activations is None:
            raise UnknownError(f"the activation pattern of {occurrence.process.name!r} is unknown")
        early, late = self.windows.of(occurrence)
        moves, span = late - early, max(1, constraint.span)
        if constraint.upper is not None:
            longest = Ends(None, _longest(activations, span))
            if can_be_dense(activations):
                # Other event models only bound the activations.
                longest = Ends(longest.upper, longest.upper)
            yield _result(constraint, constraint.event, "repetition", constraint.upper, _moved(longest, moves))
        if constraint.lower is not None:
            shortest = activations.delta_min(span + 1)
            ends = Ends(shortest, shortest if can_be_dense(activations) else None)
            yield _result(constraint, constraint.event, "repetition", constraint.lower, _moved(ends, moves), is_upper=False)
        if constraint.jitter is not None:
            jitter, reason = _jitter(constraint, activations, moves)
            yield _result(constraint, constraint.event, "jitter", constraint.jitter, jitter, reason)

    # Order

    def _order(self, constraint: OrderConstraint) -> Iterator[RequirementResult]:
        wanted = [name for group in constraint.groups for name in group]
        for process in constraint.processes or tuple(self.evaluation.context.system.processes):
            called = [
                position.activity.runnable
                for position in self.evaluation.context.dataflow.events.positions(process)
                if isinstance(position.activity, Call) and len(position.outer) == 1
            ]
            if not any(name in called for name in wanted):
                continue
            holds = satisfies_order(called, constraint)
            yield RequirementResult(
                name=constraint.name,
                object=process,
                quantity="order of runnables",
                is_upper=True,
                limit=None,
                verdict=Verdict.MET if holds else Verdict.MISSED,
            )


@dataclass(frozen=True, slots=True)
class _Latencies:
    """Between which ends the maximum and the minimum of a latency lie."""

    values: Sequence[Value]
    minimum: Quantity
    maximum: Quantity

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

    def _find(self, quantity: Quantity) -> Value | None:
        return next((value for value in self.values if value.quantity is quantity), None)


def _result(
    constraint: Named, what: str, quantity: str, limit: Time, ends: Ends, reason: str = "", is_upper: bool = True
) -> RequirementResult:
    verdict = decide(ends, limit, is_upper)
    return RequirementResult(
        name=constraint.name,
        object=what,
        quantity=quantity,
        is_upper=is_upper,
        limit=limit,
        lower=ends.lower,
        upper=ends.upper,
        verdict=verdict,
        reason=(reason or undecided(ends, is_upper)) if verdict is Verdict.UNKNOWN else "",
    )


def _unknown(constraint: Named, reason: str) -> RequirementResult:
    """The result of a constraint that cannot be evaluated."""
    return RequirementResult(
        name=constraint.name,
        object="",
        quantity=type(constraint).__name__,
        is_upper=True,
        limit=None,
        verdict=Verdict.UNKNOWN,
        reason=reason,
    )


def _time(value: Value | None) -> Time | None:
    return value.value if value is not None else None


def _spread(latencies: Sequence[_Latencies]) -> Ends:
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


def _moved(distance: Ends, by: Time) -> Ends:
    """A distance of activations as one of events that follow them after varying times."""
    lower, upper = distance.lower, distance.upper
    return Ends(None if lower is None else max(0, lower - by), None if upper is None else upper + by)


def _jitter(constraint: RepetitionConstraint, activations: EventModel, moves: Time) -> tuple[Ends, str]:
    """Between which ends the jitter of an event lies that follows strictly periodic activations, or why that is unknown."""
    if not isinstance(activations, Periodic) or not is_strictly_periodic(activations):
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


def _cycles(time: Time | None, cycles: int | None, period: Time | None) -> Time | None:
    if time is not None or cycles is None:
        return time
    if period is None:
        raise UnknownError("a limit in cycles needs a writer with a known period")
    return cycles * period


def _longest(events: EventModel, count: int) -> Time | None:
    """The maximum time from an event to the one `count` after it."""
    if isinstance(events, Periodic) and is_strictly_periodic(events):
        return count * events.period + events.jitter
    return None if events.max_interarrival is None else count * events.max_interarrival
