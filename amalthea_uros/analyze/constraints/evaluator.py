"""What is proved of the times that constraints on chains and events limit.

The constraints have the semantics of TADL2 (TIMMO-2-USE, deliverable D11), from which AMALTHEA adopted them: a reaction constraint
looks from each stimulus forward to the first response caused by it, an age constraint from each response back to the last stimulus
that caused it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import TypeAlias

from amalthea_uros._internal.failures import failure
from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.analyze.chains.evaluator import ChainEvaluator
from amalthea_uros.analyze.constraints.ends import LatencyEnds, distance_of, moved, repetition_jitter, spread_of
from amalthea_uros.analyze.constraints.events import EventWindows, exact_delays, holds_across, holds_in_each_job
from amalthea_uros.analyze.constraints.requirements import report_implausible
from amalthea_uros.analyze.results.chains import ChainResult, LatencyQuantity
from amalthea_uros.analyze.results.processes import RequirementResult
from amalthea_uros.errors import UnknownError
from amalthea_uros.judge.evidence import Ends
from amalthea_uros.judge.limits import NO_LIMIT, EventConstraint, SystemLimit, limits_of, without_number
from amalthea_uros.judge.verdict import Judgement, prove, prove_kept, unknown
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
from amalthea_uros.perf.events import LabelChange, LabelEvent
from amalthea_uros.timing.activation.releases import known_releases
from amalthea_uros.timing.dataflow.links import LinkKind
from amalthea_uros.timing.dataflow.routes import Route, corresponding, routes
from amalthea_uros.timing.dataflow.runnable_order import are_activated_together, has_counted_effect, order_scope
from amalthea_uros.timing.jobs.counters import is_always
from amalthea_uros.units import Time

_REACTION = (LatencyQuantity.MIN_FIRST_TO_FIRST, LatencyQuantity.MAX_REDUCED_REACTION_TIME)
_AGE = (LatencyQuantity.MIN_LAST_TO_LAST, LatencyQuantity.MAX_REDUCED_DATA_AGE)
#: A limit, and the verdict on it.
_Judged: TypeAlias = tuple[SystemLimit, Judgement]


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
            limits = limits_of(constraint)
            try:
                found = [RequirementResult.of(limit, judgement) for limit, judgement in self._one(constraint, limits)]
                for result in found:
                    report_implausible(result, constraint, self.evaluation.context.notes)
                # What limits nothing is not met.
                yield from found or _unknown(constraint, limits, NO_LIMIT)
            except UnknownError as error:
                yield from _unknown(constraint, limits, str(error))
            except Exception as error:
                # An error of this program leaves one constraint unknown, not all.
                reason = f"the evaluation failed: {failure(error)}"
                message = f"the constraint {constraint.name!r} is unknown: {reason}"
                self.evaluation.context.notes.error("CHN006", message, constraint)
                yield from _unknown(constraint, limits, reason)

    def _one(self, constraint: EventConstraint, limits: Sequence[SystemLimit]) -> Iterator[_Judged]:
        match constraint:
            case LatencyConstraint():
                yield from self._latency(constraint, limits)
            case DelayConstraint():
                yield from self._delay(constraint, limits)
            case RepetitionConstraint():
                yield from self._repetition(constraint, limits)
            case EventSynchronization(events=events):
                yield from _proved(limits, lambda _: self.windows.spread(events))
            case ChainSynchronization():
                yield from self._chain_synchronization(constraint, limits)
            case DataAgeConstraint():
                yield from self._data_age(constraint, limits)
            case OrderConstraint():
                yield from self._order(constraint)

    # Chains

    def _latency(self, constraint: LatencyConstraint, limits: Sequence[SystemLimit]) -> Iterator[_Judged]:
        chain = self.chains.get(constraint.chain)
        if chain is None:
            raise UnknownError(f"the chain {constraint.chain!r} is not defined in the model")
        latencies = LatencyEnds(chain.values, *(_AGE if constraint.kind is LatencyKind.AGE else _REACTION))
        for limit in limits:
            if limit.is_jitter:
                is_one_run = len(chain.routes) == 1 and self.evaluation.is_one_run(
                    self.evaluation.context.system.chains[chain.name]
                )
                judgement = prove(limit, latencies.jitter(is_one_run), chain.reason)
                yield limit, replace(judgement, spread=latencies.spread)
            else:
                ends = latencies.limited(limit)
                # Without a bound, what keeps the chain from being exact is the cause.
                is_unbounded = limit.is_upper and ends.upper is None
                cause = chain.reason or (chain.why.removeprefix("bounds: ") if is_unbounded else "")
                yield limit, prove(limit, ends, cause)

    def _delay(self, constraint: DelayConstraint, limits: Sequence[SystemLimit]) -> Iterator[_Judged]:
        source, target = self.windows.event(constraint.source), self.windows.event(constraint.target)
        exact = exact_delays(constraint, self.windows) if constraint.matching is Matching.REACTION else None
        if exact is not None:
            yield from _proved(limits, lambda limit: Ends.exactly(exact[1] if limit.is_upper else exact[0]))
            return
        found = corresponding(source, target, self.evaluation.context.dataflow)
        self._require_all_sources(constraint.source, found)
        if constraint.matching is not Matching.REACTION:
            self._require_one_to_one(constraint, found)
        latencies = LatencyEnds(self.evaluation.worst(found), *_REACTION)
        if constraint.matching is Matching.REACTION:
            greatest, least = self._to_any_target(constraint, latencies)
            yield from _proved(limits, lambda limit: greatest if limit.is_upper else least)
        else:
            yield from _proved(limits, latencies.limited)

    def _to_any_target(self, constraint: DelayConstraint, latencies: LatencyEnds) -> tuple[Ends, Ends]:
        """Between which ends the greatest and the least reaction lie, given those to the targets that the sources cause.

        Any target within the limits will do. So another one can come earlier, unless targets are farther apart than that; and one below
        the lower limit is ignored, and how much later the next one comes is unknown.
        """
        greatest, least = latencies.of_maximum, latencies.of_minimum
        if greatest.upper is None or greatest.upper >= self._least_distance(constraint.target):
            greatest = Ends(None, greatest.upper)
        if (least.lower or 0) < (constraint.lower or 0):
            greatest = Ends(greatest.lower, None)
        return greatest, Ends(least.lower, None)

    def _least_distance(self, event: str) -> Time:
        """The minimum time between two occurrences of an event; 0 if it is unknown."""
        try:
            occurrence = self.windows.occurrence(event)
            early, late = self.windows.of(occurrence)
        except UnknownError:
            return 0
        activations = self.evaluation.solution.event_models.get(occurrence.process.name)
        return 0 if activations is None else max(0, activations.delta_min(2) - (late - early))

    def _require_all_sources(self, source: str, found: Iterable[Route]) -> None:
        """Refuse a source that also occurs in jobs that a counter lets take no part in what follows."""
        for route in found:
            counter = self.evaluation.groups(route)[0][0].counter
            is_apart = route.occurrences[0].position is None and (counter is None or not is_always(counter))
            if is_apart or any(link.write is not None and has_counted_effect(link.write) for link in route.links):
                raise UnknownError(
                    f"{source!r} occurs in each job, but a counter lets only some jobs take part in what follows"
                )

    def _require_one_to_one(self, constraint: DelayConstraint, found: Sequence[Route]) -> None:
        """Refuse events whose occurrences need not correspond one to one."""
        links = {link.kind for route in found for link in route.links}
        later = any(
            stage.jobs_later is not None for route in found for group in self.evaluation.groups(route) for stage in group
        )
        if later or not links <= {LinkKind.JOB, LinkKind.TRIGGER}:
            raise UnknownError(
                "data between the events can be overwritten or read again, so their occurrences do not correspond one to one"
            )
        source, target = (self.windows.occurrence(name).process.name for name in (constraint.source, constraint.target))
        context = self.evaluation.context
        if not are_activated_together(source, target, context.system, context.dataflow.events):
            raise UnknownError(f"it is not certain that each job of {source!r} activates {target!r} exactly once")

    def _chain_synchronization(self, constraint: ChainSynchronization, limits: Sequence[SystemLimit]) -> Iterator[_Judged]:
        found = [self.chains.get(name) for name in constraint.chains]
        system = self.evaluation.context.system
        chains = [system.chains[name] for name in constraint.chains if name in system.chains]
        if None in found or len(chains) < 2:
            raise UnknownError("it needs at least two chains that are defined in the model")
        is_start = constraint.end is ChainEnd.STIMULUS
        ends = [chain.stimulus if is_start else chain.response for chain in chains]
        if not is_start and len({chain.stimulus for chain in chains}) == 1:
            spread = spread_of([LatencyEnds(each.values, *_REACTION) for each in found if each is not None])
        else:
            spread = self.windows.spread([end for end in ends if end is not None])
        yield from _proved(limits, lambda _: spread)

    def _data_age(self, constraint: DataAgeConstraint, limits: Sequence[SystemLimit]) -> Iterator[_Judged]:
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
        for name in sorted(readers):
            found = routes([written, replace(reading, process=name)], self.evaluation.context.dataflow)
            latencies = LatencyEnds(self.evaluation.worst(found), *_AGE)
            here = (replace(limit, object=f"{constraint.label} in {name}") for limit in limits)
            yield from _proved([_in_time(limit, cycle) for limit in here], latencies.limited)

    # Events

    def _repetition(self, constraint: RepetitionConstraint, limits: Sequence[SystemLimit]) -> Iterator[_Judged]:
        occurrence = self.windows.occurrence(constraint.event)
        activations = self.evaluation.solution.event_models.get(occurrence.process.name)
        if activations is None:
            raise UnknownError(f"the activation pattern of {occurrence.process.name!r} is unknown")
        early, late = self.windows.of(occurrence)
        moves, span = late - early, max(1, constraint.span)
        for limit in limits:
            if limit.is_jitter:
                yield limit, prove(limit, *repetition_jitter(constraint, activations, moves))
            else:
                yield limit, prove(limit, moved(distance_of(activations, span, limit.is_upper), moves))

    # Order

    def _order(self, constraint: OrderConstraint) -> Iterator[_Judged]:
        context = self.evaluation.context
        scope = order_scope(constraint, context.system, context.dataflow.events)
        if scope.reason:
            raise UnknownError(scope.reason)
        for process in scope.alone:
            yield _of_order(constraint, process, partial(holds_in_each_job, process, constraint, context))
        if scope.together:
            holds = partial(holds_across, scope, constraint, self.windows)
            yield _of_order(constraint, ", ".join(scope.processes), holds)


def _proved(limits: Iterable[SystemLimit], of: Callable[[SystemLimit], Ends]) -> Iterator[_Judged]:
    """The verdicts on limits by the ends of what they limit."""
    return ((limit, prove(limit, of(limit))) for limit in limits)


def _of_order(constraint: OrderConstraint, what: str, holds: Callable[[], bool]) -> _Judged:
    """The verdict on an order of runnables, which has no number."""
    limit = without_number(constraint, what)
    try:
        return limit, prove_kept(holds())
    except UnknownError as error:
        return limit, unknown(str(error))


def _unknown(constraint: EventConstraint, limits: Sequence[SystemLimit], reason: str) -> Iterator[RequirementResult]:
    """The results of a constraint that cannot be evaluated."""
    return (RequirementResult.of(limit, unknown(reason)) for limit in limits or [without_number(constraint)])


def _in_time(limit: SystemLimit, period: Time | None) -> SystemLimit:
    """A limit in cycles of the writer as one of a time."""
    if limit.is_time or limit.limit is None:
        return limit
    if period is None:
        raise UnknownError("a limit in cycles needs a writer with a known period")
    return replace(limit, quantity="data age", limit=int(limit.limit) * period, is_time=True)
