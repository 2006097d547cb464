"""Verdicts on timing constraints of chains and events.

The constraints have the semantics of TADL2 (TIMMO-2-USE, deliverable D11), from which AMALTHEA adopted them: a reaction constraint
looks from each stimulus forward to the first response caused by it, an age constraint from each response back to the last stimulus
that caused it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from amalthea_uros._internal.failures import failure
from amalthea_uros.analyze.chains.evaluator import ChainEvaluator
from amalthea_uros.analyze.chains.event_windows import EventWindows, UnknownError
from amalthea_uros.analyze.chains.runnable_order import satisfies_order
from amalthea_uros.analyze.chains.stage_timing import UnboundedStageError
from amalthea_uros.analyze.results import ChainResult, Quantity, RequirementResult, Value, Verdict
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
from amalthea_uros.perf.named import Named
from amalthea_uros.perf.software import AccessKind, Call, LabelAccess
from amalthea_uros.timing.dataflow.events import UnresolvedError
from amalthea_uros.timing.dataflow.links import LinkKind
from amalthea_uros.timing.dataflow.positions import ActivityPosition
from amalthea_uros.timing.dataflow.routes import routes
from amalthea_uros.timing.event_models import EventModel, Periodic, is_strictly_periodic
from amalthea_uros.timing.releases import known_releases
from amalthea_uros.units import Time

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
                yield from self._one(constraint)
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
        kind = str(constraint.kind)
        if constraint.maximum is not None:
            value = _time(chain.value(maximum))
            yield _result(constraint, chain.name, kind, constraint.maximum, value, chain.reason)
        if constraint.minimum is not None:
            value = _time(chain.value(minimum))
            yield _result(constraint, chain.name, kind, constraint.minimum, value, chain.reason, is_upper=False)

    def _delay(self, constraint: DelayConstraint) -> Iterator[RequirementResult]:
        source, target = self.windows.event(constraint.source), self.windows.event(constraint.target)
        if constraint.matching is not Matching.REACTION:
            links = {link.kind for route in routes([source, target], self.evaluation.context.dataflow) for link in route.links}
            if not links <= {LinkKind.JOB, LinkKind.TRIGGER}:
                raise UnknownError(
                    "data between the events can be overwritten or read again, so their occurrences do not correspond one to one"
                )
        values = {value.quantity: value for value in self.evaluation.pair(source, target)}
        minimum, maximum = _REACTION
        what = f"{constraint.source} to {constraint.target}"
        if constraint.upper is not None:
            yield _result(constraint, what, "delay", constraint.upper, _time(values.get(maximum)))
        if constraint.lower is not None:
            yield _result(constraint, what, "delay", constraint.lower, _time(values.get(minimum)), is_upper=False)

    def _chain_synchronization(self, constraint: ChainSynchronization) -> RequirementResult:
        found = [self.chains.get(name) for name in constraint.chains]
        system = self.evaluation.context.system
        chains = [system.chains[name] for name in constraint.chains if name in system.chains]
        if None in found or len(chains) < 2:
            raise UnknownError("it needs at least two chains that are defined in the model")
        is_start = constraint.end is ChainEnd.STIMULUS
        ends = [chain.stimulus if is_start else chain.response for chain in chains]
        value: Time | None
        if not is_start and len({chain.stimulus for chain in chains}) == 1:
            # From the same stimulus: the latest response of one chain minus the earliest of another.
            latest = [_time(each.value(_REACTION[1])) for each in found if each is not None]
            earliest = [_time(each.value(_REACTION[0])) for each in found if each is not None]
            value = _difference(latest, earliest)
        else:
            value = self.windows.spread([end for end in ends if end is not None])
        return _result(constraint, ", ".join(constraint.chains), f"spread at the {constraint.end}", constraint.tolerance, value)

    def _data_age(self, constraint: DataAgeConstraint) -> Iterator[RequirementResult]:
        """The age of the data written by the runnable at each read of them."""
        written = LabelEvent(name="write", label=constraint.label, change=LabelChange.WRITE, runnable=constraint.runnable)
        (occurrence, *_) = self.evaluation.context.dataflow.events.of(written)
        readers = {
            position.process.name
            for process in self.evaluation.context.system.processes
            for position in self.evaluation.context.dataflow.events.positions(process)
            if _reads(position, constraint.label) and process != occurrence.process.name
        }
        releases = known_releases(occurrence.process, self.evaluation.context.system)
        cycle = releases.period if releases is not None else None
        latest = _cycles(constraint.latest, constraint.latest_cycle, cycle)
        earliest = _cycles(constraint.earliest, constraint.earliest_cycle, cycle)
        for name in sorted(readers):
            read = LabelEvent(name="read", label=constraint.label, change=LabelChange.READ, process=name)
            values = {value.quantity: value for value in self.evaluation.pair(written, read)}
            what = f"{constraint.label} in {name}"
            if latest is not None:
                yield _result(constraint, what, "age", latest, _time(values.get(_AGE[1])))
            if earliest is not None:
                yield _result(constraint, what, "age", earliest, _time(values.get(_AGE[0])), is_upper=False)

    # Events

    def _repetition(self, constraint: RepetitionConstraint) -> Iterator[RequirementResult]:
        occurrence = self.windows.occurrence(constraint.event)
        activations = self.evaluation.solution.event_models.get(occurrence.process.name)
        if activations is None:
            raise UnknownError(f"the activation pattern of {occurrence.process.name!r} is unknown")
        early, late = self.windows.of(occurrence)
        span = max(1, constraint.span)
        if constraint.upper is not None:
            longest = _longest(activations, span)
            value = None if longest is None else longest + late - early
            yield _result(constraint, constraint.event, "repetition", constraint.upper, value)
        if constraint.lower is not None:
            value = max(0, activations.delta_min(span + 1) - (late - early))
            yield _result(constraint, constraint.event, "repetition", constraint.lower, value, is_upper=False)
        if constraint.jitter is not None:
            own = activations.jitter if isinstance(activations, Periodic) and is_strictly_periodic(activations) else None
            value = None if own is None else own + late - early
            yield _result(constraint, constraint.event, "jitter", constraint.jitter, value)

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
                value=None,
                verdict=Verdict.MET if holds else Verdict.MISSED,
            )


def _unknown(constraint: Named, reason: str) -> RequirementResult:
    return RequirementResult(
        name=constraint.name,
        object="",
        quantity=type(constraint).__name__,
        is_upper=True,
        limit=None,
        value=None,
        verdict=Verdict.UNKNOWN,
        reason=reason,
    )


def _result(
    constraint: Named, what: str, quantity: str, limit: Time, value: Time | None, reason: str = "", is_upper: bool = True
) -> RequirementResult:
    if not is_upper and value is None and not reason:
        value = 0  # no latency is negative
    holds = value is not None and (value <= limit if is_upper else value >= limit)
    return RequirementResult(
        name=constraint.name,
        object=what,
        quantity=quantity,
        is_upper=is_upper,
        limit=limit,
        value=value,
        verdict=Verdict.UNKNOWN if value is None else Verdict.MET if holds else Verdict.MISSED,
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
        raise UnknownError("a limit in cycles needs a writer with a known period")
    return cycles * period


def _longest(events: EventModel, count: int) -> Time | None:
    """The maximum time from an event to the one `count` after it."""
    if isinstance(events, Periodic) and is_strictly_periodic(events):
        return count * events.period + events.jitter
    return None if events.max_interarrival is None else count * events.max_interarrival


def _reads(position: ActivityPosition, label: str) -> bool:
    access = position.activity
    return isinstance(access, LabelAccess) and access.label == label and access.kind is AccessKind.READ
