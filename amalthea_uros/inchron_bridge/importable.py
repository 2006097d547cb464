"""A system with what INCHRON's importer would leave out of its model in the form that the importer converts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.inchron_bridge.tables.stimuli import substitute
from amalthea_uros.perf import stimuli as perf
from amalthea_uros.perf.constraints import Bound, Requirement, TimeLimit, TimeMetric
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.os import Policy
from amalthea_uros.perf.system import System
from amalthea_uros.units import Time

#: Policies that do not look at deadlines, so that a further one changes nothing but what is checked.
_WITHOUT_DEADLINES = (Policy.FIXED_PRIORITY_PREEMPTIVE, Policy.OSEK)


def importable(
    system: System, iterations: Mapping[str, tuple[Time, Time]], *, with_deadlines: bool
) -> tuple[System, tuple[Finding, ...]]:
    """The system, with findings about what is in another form.

    Parameters
    ----------
    iterations : the shortest and the longest time between two iterations of executors, by the stimuli that stand for them
    with_deadlines : whether allocations of tasks can have deadlines, which models of AMALTHEA 1.2.0 cannot
    """
    findings: list[Finding] = []
    stimuli = tuple(_converted(stimulus, iterations, findings) for stimulus in system.stimuli.stimuli)
    mapping = system.mapping
    if with_deadlines:
        limits = _limits(system)
        dynamic = {each.name for each in system.schedulers.values() if each.policy not in _WITHOUT_DEADLINES}
        tasks = tuple(each if each.scheduler in dynamic else _with_deadline(each, limits, findings) for each in mapping.tasks)
        mapping = replace(mapping, tasks=tasks)
    return replace(system, stimuli=replace(system.stimuli, stimuli=stimuli), mapping=mapping), tuple(findings)


def _converted(stimulus: perf.Stimulus, iterations: Mapping[str, tuple[Time, Time]], findings: list[Finding]) -> perf.Stimulus:
    """A stimulus of a class that is converted, if there is one that comes close."""
    closest, what, how = substitute(stimulus, iterations)
    if closest is not None:
        findings.append(_changed(stimulus.name, what, how))
        return closest
    if isinstance(stimulus, perf.ArrivalCurve | perf.VariableRate | perf.EventTriggered | perf.Custom):
        message = f"{stimulus.name}: {what} is not converted by INCHRON's importer, so that nothing is activated there"
        findings.append(Finding("BLD003", Severity.WARNING, message, stimulus.origin, "", stimulus.name))
    return stimulus


def _limits(system: System) -> dict[str, Time]:
    """The least limit on the response time of each process."""
    result: dict[str, Time] = {}
    for requirement in system.constraints.requirements:
        match requirement:
            case Requirement(
                process=str(process), limit=TimeLimit(metric=TimeMetric.RESPONSE_TIME, bound=Bound.UPPER, value=value)
            ):
                result[process] = min(value, result.get(process, value))
    return result


def _with_deadline(allocation: TaskAllocation, limits: Mapping[str, Time], findings: list[Finding]) -> TaskAllocation:
    """An allocation with a deadline, which is converted, where a requirement is not."""
    limit = limits.get(allocation.task)
    if limit is None or allocation.deadline is not None:
        return allocation
    findings.append(_changed(allocation.task, "a limit on its response time", "also as the deadline of its allocation"))
    return replace(allocation, deadline=limit)


def _changed(name: str, what: str, how: str) -> Finding:
    return Finding("BLD002", Severity.INFO, f"{name}: {what}, written {how} for INCHRON's importer", None, "", name)
