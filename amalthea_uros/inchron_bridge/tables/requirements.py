"""Limits as requirements of a project."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from amalthea_uros.errors import UnknownError
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.comments import keep_whole
from amalthea_uros.inchron_bridge.basics.exporting import Exporting
from amalthea_uros.inchron_bridge.basics.values import NO_LIMIT, time
from amalthea_uros.inchron_bridge.tables.chains import build_synchronized, join_items, trace_event
from amalthea_uros.perf import constraints as perf

#: The key of a limit in the comment of the requirement that stands for it.
LIMIT = "limit"

#: The requirements of a process on a time that every job has.
OF_PROCESS = {
    perf.TimeMetric.RESPONSE_TIME: "requirement.ResponseTimeRequirement",
    perf.TimeMetric.NET_EXECUTION_TIME: "requirement.NetExecTimeRequirement",
}
#: Failures of an operating system that a number of zero forbids.
_FAILURES = {perf.CountMetric.LOST_ACTIVATIONS: "ActivationLimitViolation"}

#: Matching of a delay: only this one is what the requirement of a project checks.
CHAIN_REQUIREMENT = "requirement.EventChainTimingRequirement"


def build_requirements(context: Exporting) -> None:
    """Make the requirements; limits that cannot be one are kept in the comment of the model."""
    constraints = context.system.constraints
    result: dict[str, tuple[Any, ...]] = {
        "constraints": constraints.constraints,
        "requirements": constraints.requirements,
        "data_ages": constraints.data_ages,
        "orders": constraints.orders,
        "data_groups": constraints.data_groups,
    }
    for limit in (each for several in result.values() for each in several):
        try:
            made = _BUILD[type(limit)](limit, context)
        except (UnknownError, KeyError) as error:
            reason = f"{error}; " if isinstance(error, UnknownError) else ""
            context.lost(limit, f"a {type(limit).__name__}", f"{reason}only amuros reads it, in a comment")
            made = ProjectObject("requirement.GroupOfRequirements", name=limit.name)
            made["evaluate"] = False
        several = made if isinstance(made, list) else [made]
        if len(several) > 1 or not _is_plain(limit, several[0]):
            keep_whole(several[0], LIMIT, limit)
        if len(several) > 1:
            join_items(several)
        for each in several:
            context.model.add("requirements", each)


def _is_plain(limit: Any, made: ProjectObject) -> bool:
    """Whether the requirement alone says everything of the limit."""
    match limit:
        case perf.LatencyConstraint():
            return made.kind == CHAIN_REQUIREMENT and made["evaluate"] and limit.jitter is None and limit.minimum != 0
        case perf.Requirement(severity=None, process=str(), limit=perf.TimeLimit(bound=perf.Bound.UPPER)):
            return made.kind in OF_PROCESS.values()
    return False


def _interval(lower: int | None, upper: int | None, context: Exporting, holder: str) -> ProjectObject:
    made = ProjectObject("TimeInterval", upperLimit=time(NO_LIMIT, "ps") if upper is None else context.time(upper, holder))
    if lower is not None:
        made["lowerLimit"] = context.time(lower, holder)
    return made


def _latency(limit: perf.LatencyConstraint, context: Exporting) -> list[ProjectObject]:
    """A requirement on each graph of the chain."""
    graphs = context.graphs.get(limit.chain)
    if graphs is None:
        raise UnknownError("there is no event chain for it")
    is_limit = limit.minimum is not None or limit.maximum is not None
    if not is_limit:
        context.changed(limit, "a limit without a minimum or a maximum", "as a requirement that is not evaluated")
    return [
        ProjectObject(
            CHAIN_REQUIREMENT,
            name=f"{limit.name}_{number + 1}" if number else limit.name,
            eventChain=graph,
            start=[graph["initialNode"]["first"]],
            end=[node["first"] for node in graph["terminalNodes"]],
            interval=_interval(limit.minimum, limit.maximum, context, limit.name) if is_limit else None,
            evaluate=None if is_limit else False,
            strategy="FirstLast" if limit.kind is perf.LatencyKind.AGE else "FirstFirst",
        )
        for number, graph in enumerate(graphs)
    ]


def _event(name: str, context: Exporting) -> ProjectObject:
    result, process = trace_event(context.system.events_by_name.get(name), context)
    if process is not None:
        raise UnknownError(f"the event {name!r} is restricted to a process")
    return result


def _delay(limit: perf.DelayConstraint, context: Exporting) -> ProjectObject:
    return ProjectObject(
        "requirement.EventTimingRequirement",
        name=limit.name,
        start=_event(limit.source, context),
        end=_event(limit.target, context),
        interval=_interval(limit.lower, limit.upper, context, limit.name),
    )


def _repetition(limit: perf.RepetitionConstraint, context: Exporting) -> ProjectObject:
    if limit.span != 1:
        raise UnknownError(f"it spans {limit.span} repetitions")
    jitter = limit.jitter or 0
    lower = None if limit.lower is None else max(0, limit.lower - jitter)
    upper = None if limit.upper is None else limit.upper + jitter
    return ProjectObject(
        "requirement.PeriodicEventRequirement",
        name=limit.name,
        event=_event(limit.event, context),
        interval=_interval(lower, upper, context, limit.name),
    )


def _chain_synchronization(limit: perf.ChainSynchronization, context: Exporting) -> ProjectObject:
    """The time from the first of the last events to the last of them."""
    graph = build_synchronized(limit, context)
    if not limit.every_occurrence:
        context.changed(limit, "chains that have to end together once", "without a limit on how often one of them ends")
    ends = [node["first"] for node in graph["terminalNodes"]]
    return ProjectObject(
        CHAIN_REQUIREMENT,
        name=limit.name,
        eventChain=graph,
        start=ends,
        orSemanticsStart=True,
        end=ends,
        interval=_interval(None, limit.tolerance, context, limit.name),
    )


def _data_age(limit: perf.DataAgeConstraint, context: Exporting) -> ProjectObject:
    write, read = (context.trace_event("DataObject", limit.label, event) for event in ("write", "read"))
    if write is None or read is None or limit.latest is None:
        raise UnknownError("it has no latest time, or no label")
    interval = _interval(limit.earliest, limit.latest, context, limit.name)
    return ProjectObject(
        "requirement.EventTimingRequirement", name=limit.name, start=write, end=read, trigger=read, interval=interval
    )


def _requirement(requirement: perf.Requirement, context: Exporting) -> ProjectObject:
    name, limit = requirement.name, requirement.limit
    process = context.find("Process", requirement.process)
    match limit:
        case perf.TimeLimit(metric=metric, value=value, bound=bound):
            lower, upper = (None, value) if bound is perf.Bound.UPPER else (value, None)
            interval = _interval(lower, upper, context, name)
            if process is not None and metric in OF_PROCESS:
                return ProjectObject(OF_PROCESS[metric], name=name, process=process, interval=interval)
            entry, leave = (context.trace_event("Function", requirement.runnable, event) for event in ("Entry", "Exit"))
            if entry is not None and leave is not None and metric is perf.TimeMetric.RESPONSE_TIME:
                return ProjectObject("requirement.EventTimingRequirement", name=name, start=entry, end=leave, interval=interval)
        case perf.LoadLimit(metric=perf.LoadMetric.LOAD, value=value, bound=bound, core=core) if core is not None:
            operator = "le" if bound is perf.Bound.UPPER else "ge"
            resource = context.need("CpuCore", core, name)
            return ProjectObject(
                "requirement.LoadRequirement", name=name, loadResource=resource, limit=value, relationalOperator=operator
            )
        case perf.CountLimit(metric=metric, value=0, bound=perf.Bound.UPPER) if metric in _FAILURES and process is not None:
            others = [each for each in context.model.walk() if each.kind == "Process" and each is not process]
            return ProjectObject(
                "requirement.RtosFailureRequirement", name=name, enabledRtosFailures=[_FAILURES[metric]], blacklist=others
            )
    raise UnknownError(f"there is no requirement on the {limit.metric}")


_BUILD: dict[type[Any], Callable[[Any, Exporting], ProjectObject | list[ProjectObject]]] = {
    perf.LatencyConstraint: _latency,
    perf.DelayConstraint: _delay,
    perf.RepetitionConstraint: _repetition,
    perf.ChainSynchronization: _chain_synchronization,
    perf.DataAgeConstraint: _data_age,
    perf.Requirement: _requirement,
}
