"""What was observed of the deadlines, requirements and constraints of a system."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Protocol

from amalthea_uros._internal.by_name import Results
from amalthea_uros.judge.evidence import ObservedProcess, ObservedValues
from amalthea_uros.judge.limits import EventConstraint, SystemLimit, deadline_limit, stated_limits, without_number
from amalthea_uros.judge.verdict import in_doubt, not_observed, observe, observe_process
from amalthea_uros.perf.constraints import LatencyConstraint, LatencyKind, Requirement
from amalthea_uros.perf.events import EventChain
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.limited_values import LimitedQuantity, limited_values, limited_values_of_runnable, observed_values
from amalthea_uros.simulate.not_simulated import LIMITED_PROCESS_LEFT_OUT
from amalthea_uros.simulate.results import ChainObservation, ProcessObservation, RequirementObservation, RunnableObservation
from amalthea_uros.timing.activation.releases import activation_period
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.timing.dataflow.chains import UnfoldError, forks, unfold
from amalthea_uros.units import Time


class ConstraintObservers(Protocol):
    """What has observed the constraints."""

    def quantities(self, constraint: EventConstraint) -> Sequence[LimitedQuantity]:
        """What was observed of a constraint; nothing if it limits nothing, or cannot be observed."""

    def reason(self, constraint: EventConstraint) -> str:
        """Why nothing was observed of a constraint."""


#: Why nothing is observed of an executor that loops, and of its callbacks.
LOOPING = "it is an executor that loops, whose iterations are not simulated; analyze the model"
_IN_LOOP = "it is part of an executor that loops, whose iterations are not simulated; analyze the model"


def judge_process(process: ProcessObservation, model: Process, doubt: str = "", left_out: str = "") -> ProcessObservation:
    """The observations of a process with the verdict on its deadline and on lost activations.

    Parameters
    ----------
    doubt : why what was observed is no behaviour of the system; "" if it is one
    left_out : why it is not simulated as it is, so that nothing was observed, with a deadline or without; "" if it is
    """
    if left_out:
        return replace(process, verdict=not_observed(left_out).verdict, reason=left_out)
    limit = None if process.deadline is None else deadline_limit(model, process.deadline, process.is_implicit)
    response = replace(observed_values(process.response_time, "no job ended"), pending=process.longest_unfinished)
    found = observe_process(limit, ObservedProcess(response=response, lost_activations=process.lost_activations))
    if found is None:
        return process
    found = in_doubt(found, doubt)
    return replace(process, verdict=found.verdict, reason=found.reason)


def judge_requirements(
    system: System,
    processes: Results[ProcessObservation],
    chains: Results[ChainObservation],
    duration: Time,
    runnables: Results[RunnableObservation],
    observers: ConstraintObservers,
    doubts: Mapping[str, str] = MappingProxyType({}),
) -> Iterator[RequirementObservation]:
    """The verdicts on all requirements, then on all constraints.

    Parameters
    ----------
    doubts : why what was observed is no behaviour of the system, by the names of requirements and constraints
    """
    for item, limits in stated_limits(system):
        if isinstance(item, Requirement):
            values = _of_requirement(item, system, processes, duration, runnables)
            quantities: Sequence[LimitedQuantity] = [LimitedQuantity(limit, values) for limit in limits]
        elif isinstance(item, LatencyConstraint):
            quantities = [LimitedQuantity(limit, _of_chain(limit, item, chains, system)) for limit in limits]
        else:
            quantities = observers.quantities(item)
        doubt = doubts.get(item.name, "")
        yield from (RequirementObservation.of(limit, in_doubt(observe(limit, values), doubt)) for limit, values in quantities)
        if not quantities and not isinstance(item, Requirement):
            reason = not_observed(observers.reason(item))
            yield from (RequirementObservation.of(limit, reason) for limit in limits or [without_number(item)])


def _is_of_loop(requirement: Requirement, system: System) -> bool:
    """Whether a requirement limits rounds of an executor that loops, or one of its callbacks."""
    runnables = {
        name for executor in system.executors for handle in executor.handles for name in (handle.runnable, handle.take)
    }
    return requirement.process in system.executor_of_task or (
        requirement.runnable is not None and requirement.runnable in runnables
    )


def _of_requirement(
    requirement: Requirement,
    system: System,
    processes: Results[ProcessObservation],
    duration: Time,
    runnables: Results[RunnableObservation],
) -> ObservedValues:
    limit = requirement.limit
    process = next((each for each in processes if each.name == requirement.process), None)
    runnable = next((each for each in runnables if each.name == requirement.runnable), None)
    if _is_of_loop(requirement, system):
        return ObservedValues(reason=_IN_LOOP)
    if process is not None:
        model = system.processes.get(process.name)
        return limited_values(limit, process, duration, None if model is None else activation_period(model, system))
    if runnable is not None:
        return limited_values_of_runnable(limit, runnable)
    if requirement.process in system.processes:
        return ObservedValues(reason=LIMITED_PROCESS_LEFT_OUT)
    kind = "process" if requirement.runnable is None else "runnable"
    return ObservedValues(reason=f"the {kind} that it limits is not defined, or was left out when reading")


def _of_chain(
    limit: SystemLimit, constraint: LatencyConstraint, chains: Results[ChainObservation], system: System
) -> ObservedValues:
    """What a latency constraint limits; the ways through a fork are observed one by one, although only some of them decide."""
    chain = system.chains.get(constraint.chain)
    if constraint.kind is LatencyKind.REACTION and chain is not None and _decide_some(chain, limit, system):
        return ObservedValues(reason="only some of the ways through the chain decide, and each of them is observed by itself")
    return _of_latency(limit, constraint, chains)


def _decide_some(chain: EventChain, limit: SystemLimit, system: System) -> bool:
    """Whether the longest way through a chain, or the shortest one for a lower limit, does not decide on a reaction."""
    try:
        found = list(forks(unfold(chain, system)[0]))
    except UnfoldError:
        return False
    is_earlier = any(fork.needed < len(fork.branches) for fork in found)
    is_later = any(fork.needed > 1 for fork in found)
    return is_earlier or is_later if limit.is_jitter else is_earlier if limit.is_upper else is_later


def _of_latency(limit: SystemLimit, constraint: LatencyConstraint, chains: Results[ChainObservation]) -> ObservedValues:
    """What a latency constraint limits: data age at each response, or reaction at each stimulus, also if there is none."""
    chain = next((each for each in chains if each.name == constraint.chain), None)
    if chain is None:
        return ObservedValues(reason=f"the chain {constraint.chain!r} is not defined in the model")
    is_age = constraint.kind is LatencyKind.AGE
    quantity = ChainQuantity.REDUCED_DATA_AGE if is_age else ChainQuantity.REDUCED_REACTION_TIME
    values = observed_values(chain.quantities.get(quantity), chain.reason or "there was no response to a stimulus")
    if chain.not_evaluated:
        reason = f"{chain.not_evaluated:,} latencies are longer than those that can be observed"
        values = replace(values, is_complete=False, reason=reason)
    values = values if is_age else replace(values, pending=chain.longest_unanswered)
    return values.jitter() if limit.is_jitter else values
