"""Verdicts on deadlines, requirements and constraints by what was observed.

That a limit was kept in a run is no proof that it always is: the verdict is *observed as kept*, never *met*. That it was missed is one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Protocol, TypeAlias

from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.plural import counted
from amalthea_uros.perf.constraints import (
    Bound,
    Constraint,
    DataAgeConstraint,
    JitterLimit,
    LatencyConstraint,
    LatencyKind,
    OrderConstraint,
    Requirement,
    TimeLimit,
)
from amalthea_uros.perf.named import Named
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.limited_values import (
    LimitedQuantity,
    LimitedValues,
    limited_values,
    limited_values_of_runnable,
)
from amalthea_uros.simulate.results import (
    ChainObservation,
    ObservedVerdict,
    ProcessObservation,
    RequirementObservation,
    RunnableObservation,
)
from amalthea_uros.timing.chain_quantity import ChainQuantity
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.deadlines import implicit_deadline
from amalthea_uros.timing.jitter import jitter_name
from amalthea_uros.timing.releases import activation_period, response_time_limits
from amalthea_uros.units import Time, time_text

#: A constraint that is about occurrences.
ObservedConstraint: TypeAlias = Constraint | DataAgeConstraint | OrderConstraint


class ConstraintObservers(Protocol):
    """What has observed the constraints."""

    def quantities(self, constraint: ObservedConstraint) -> Sequence[LimitedQuantity]:
        """What was observed of a constraint; nothing if it limits nothing, or cannot be observed."""

    def reason(self, constraint: ObservedConstraint) -> str:
        """Why nothing was observed of a constraint."""


@dataclass(frozen=True, slots=True)
class Deadline:
    """A deadline relative to the activation; `is_implicit` if it is the period."""

    value: Time
    is_implicit: bool


def deadline_of(process: str, context: TimingContext) -> Deadline | None:
    """The deadline of a process: of its allocation, or its strictest response-time limit, or its period."""
    allocated = [each.deadline for each in context.system.mapping.tasks if each.task == process and each.deadline is not None]
    stated = min(allocated) if allocated else response_time_limits(context.system).get(process)
    if stated is not None:
        return Deadline(stated, is_implicit=False)
    events = context.stated_activations(process)
    period = None if events is None else implicit_deadline(events)
    return None if period is None else Deadline(period, is_implicit=True)


def judge_process(process: ProcessObservation) -> ProcessObservation:
    """The observations of a process with the verdict on its deadline and on lost activations."""
    if process.lost_activations:
        reason = f"{counted(process.lost_activations, 'activation')} lost"
        return replace(process, verdict=ObservedVerdict.MISSED, reason=reason)
    if process.deadline is None:
        return process
    if process.longest_unfinished > process.deadline:
        reason = f"a job had not ended {time_text(process.longest_unfinished)} after its activation"
        return replace(process, verdict=ObservedVerdict.MISSED, reason=reason)
    if process.margin is None:
        return replace(process, verdict=ObservedVerdict.NOT_OBSERVED, reason="no job ended")
    return replace(process, verdict=ObservedVerdict.OK if process.margin >= 0 else ObservedVerdict.MISSED)


def judge_requirements(
    system: System,
    processes: Results[ProcessObservation],
    chains: Results[ChainObservation],
    duration: Time,
    runnables: Results[RunnableObservation],
    observers: ConstraintObservers,
) -> Iterator[RequirementObservation]:
    """The verdicts on all requirements, then on all constraints."""
    constraints = system.constraints
    for requirement in constraints.requirements:
        yield _requirement(requirement, system, processes, duration, runnables)
    for constraint in (*constraints.constraints, *constraints.data_ages, *constraints.orders):
        if isinstance(constraint, LatencyConstraint):
            yield from _latency(constraint, chains)
            continue
        quantities = observers.quantities(constraint)
        yield from (_constraint(constraint.name, quantity) for quantity in quantities)
        if not quantities:
            yield _not_observed(constraint, type(constraint).__name__, observers.reason(constraint))


def _is_of_loop(requirement: Requirement, system: System) -> bool:
    """Whether a requirement limits rounds of an executor that loops, or one of its callbacks."""
    runnables = {
        name for executor in system.executors for handle in executor.handles for name in (handle.runnable, handle.take)
    }
    return requirement.process in system.executor_of_task or (
        requirement.runnable is not None and requirement.runnable in runnables
    )


def _requirement(
    requirement: Requirement,
    system: System,
    processes: Results[ProcessObservation],
    duration: Time,
    runnables: Results[RunnableObservation],
) -> RequirementObservation:
    limit = requirement.limit
    process = next((each for each in processes if each.name == requirement.process), None)
    runnable = next((each for each in runnables if each.name == requirement.runnable), None)
    if _is_of_loop(requirement, system):
        values = LimitedValues(reason="it is part of an executor that loops, whose rounds are not played; analyze the model")
    elif process is not None:
        model = system.processes.get(process.name)
        values = limited_values(limit, process, duration, None if model is None else activation_period(model, system))
    elif runnable is not None:
        values = limited_values_of_runnable(limit, runnable)
    elif requirement.process in system.processes:
        values = LimitedValues(reason="the process that it limits is not simulated")
    else:
        kind = "process" if requirement.runnable is None else "runnable"
        values = LimitedValues(reason=f"the {kind} that it limits is not defined, or was left out when reading")
    return _judged(
        RequirementObservation(
            name=requirement.name,
            object=requirement.process or requirement.runnable or "",
            quantity=jitter_name(limit.metric) if isinstance(limit, JitterLimit) else str(limit.metric),
            is_upper=limit.bound is Bound.UPPER,
            # As the number is written: the nearest number in base 2 can be on the other side of an equal value.
            limit=Fraction(str(limit.value)),
            is_time=isinstance(limit, TimeLimit | JitterLimit),
            verdict=ObservedVerdict.NOT_OBSERVED,
        ),
        values,
    )


def _constraint(name: str, found: LimitedQuantity) -> RequirementObservation:
    """The verdict on a constraint of occurrences."""
    values = found.values
    judged = RequirementObservation(
        name=name,
        object=found.object,
        quantity=found.quantity,
        is_upper=found.is_upper,
        limit=None if found.limit is None else Fraction(found.limit),
        is_time=found.is_time,
        verdict=ObservedVerdict.NOT_OBSERVED,
    )
    if found.limit is not None:
        judged = _judged(judged, values)
    elif values.high is not None:
        judged = replace(judged, verdict=ObservedVerdict.OK)
    else:
        judged = replace(judged, reason=values.reason)
    if not found.violation:
        return judged
    return replace(judged, verdict=ObservedVerdict.MISSED, reason=found.violation, at=found.violated_at)


def _latency(constraint: LatencyConstraint, chains: Results[ChainObservation]) -> Iterator[RequirementObservation]:
    is_age = constraint.kind is LatencyKind.AGE
    kind = "data age" if is_age else "reaction"
    chain = next((each for each in chains if each.name == constraint.chain), None)
    limits = (
        (constraint.maximum, kind, True),
        (constraint.minimum, kind, False),
        (constraint.jitter, jitter_name(kind), True),
    )
    stated = [(limit, quantity, is_upper) for limit, quantity, is_upper in limits if limit is not None]
    if chain is None:
        yield _not_observed(constraint, kind, f"the chain {constraint.chain!r} is not defined in the model")
    elif not stated:
        yield _not_observed(constraint, kind, "it states no limit")
    else:
        values = _latencies(chain, is_age)
        for limit, quantity, is_upper in stated:
            found = RequirementObservation(
                name=constraint.name,
                object=chain.name,
                quantity=quantity,
                is_upper=is_upper,
                limit=Fraction(limit),
                verdict=ObservedVerdict.NOT_OBSERVED,
            )
            yield _judged(found, values if quantity == kind else values.jitter())


def _latencies(chain: ChainObservation, is_age: bool) -> LimitedValues:
    """What a latency constraint limits: data age at each response, or reaction at each stimulus, also if there is none."""
    quantity = ChainQuantity.REDUCED_DATA_AGE if is_age else ChainQuantity.REDUCED_REACTION_TIME
    values = LimitedValues.of(chain.quantities.get(quantity), chain.reason or "there was no response to a stimulus")
    if chain.not_evaluated:
        reason = f"{chain.not_evaluated:,} latencies are longer than those that can be observed"
        values = replace(values, is_complete=False, reason=reason)
    return values if is_age else replace(values, pending=chain.longest_unanswered)


def _judged(found: RequirementObservation, values: LimitedValues) -> RequirementObservation:
    """A limit compared with observed values."""
    if found.is_upper and found.limit is not None and values.pending > found.limit:
        longest = max(values.pending, values.high or Fraction(0))
        reason = "" if longest == values.high else "not ended at the end of the run"
        at = values.high_at if longest == values.high else None
        return replace(found, value=longest, verdict=ObservedVerdict.MISSED, reason=reason, at=at)
    value, at = (values.high, values.high_at) if found.is_upper else (values.low, values.low_at)
    compared = replace(found, value=value, at=at)
    if compared.margin is None:
        return replace(compared, reason=values.reason)
    if compared.margin < 0:
        return replace(compared, verdict=ObservedVerdict.MISSED)
    return replace(compared, verdict=ObservedVerdict.OK) if values.is_complete else replace(compared, reason=values.reason)


def _not_observed(constraint: Named, quantity: str, reason: str) -> RequirementObservation:
    return RequirementObservation(
        name=constraint.name,
        object="",
        quantity=quantity,
        is_upper=True,
        limit=None,
        verdict=ObservedVerdict.NOT_OBSERVED,
        reason=reason,
    )
