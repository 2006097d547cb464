"""The demands of a description on a system: chains with limits of their latencies, and requirements on processes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from collections.abc import Mapping as AbstractMapping
from dataclasses import replace

from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.constraints import Bound, JitterLimit, Limit, Requirement, RequirementSeverity, TimeLimit, TimeMetric
from amalthea_uros.perf.events import Events
from amalthea_uros.perf.system import System
from amalthea_uros.spec import requirements as spec
from amalthea_uros.spec.description import Description
from amalthea_uros.timing.dataflow.links import Dataflow
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.chain_members import ChainElement, ChainMembers
from amalthea_uros.uros.chains import ChainBuilder

_METRICS = {
    "response_time": TimeMetric.RESPONSE_TIME,
    "net_execution_time": TimeMetric.NET_EXECUTION_TIME,
    "gross_execution_time": TimeMetric.GROSS_EXECUTION_TIME,
    "start_delay": TimeMetric.START_DELAY,
    "start_to_start": TimeMetric.START_TO_START,
    "end_to_end": TimeMetric.END_TO_END,
}


def with_demands(system: System, members: ChainMembers, description: Description, problems: Notes) -> System:
    """A system with the chains and requirements of a description, besides those that it has."""
    known = {each.name: each for each in system.events.events}
    chains = ChainBuilder(members.elements, members.topics, Dataflow(system), problems, events=known)
    limits = chains.add_all(description.chains)
    demanded = tuple(_requirements(description.requirements, members.elements, problems))
    constraints = system.constraints
    return replace(
        system,
        events=Events(events=tuple(chains.events.values()), chains=(*system.events.chains, *chains.chains.values())),
        constraints=replace(
            constraints,
            constraints=(*constraints.constraints, *limits),
            requirements=(*constraints.requirements, *demanded),
        ),
    )


def _requirements(
    sections: Iterable[spec.RequirementSection], elements: AbstractMapping[str, ChainElement], problems: Notes
) -> Iterator[Requirement]:
    """The requirements of the description, one for each limit."""
    for section in sections:
        element = elements.get(section.process)
        if element is None:
            problems.undefined("process or runnable", section.process, elements, section.location("process"))
            continue
        yield from _limits(section, element)


def _limits(section: spec.RequirementSection, element: ChainElement) -> Iterator[Requirement]:
    for name, limit, origin in _stated(section):
        yield Requirement(
            name=name,
            process=element.process if element.runnable is None else None,
            runnable=element.runnable,
            limit=limit,
            severity=RequirementSeverity(section.severity) if section.severity else None,
            origin=origin,
        )


def _stated(section: spec.RequirementSection) -> Iterator[tuple[str, Limit, Location | None]]:
    """Each limit with its name, which all limits of one requirement can share, and where it is stated."""
    for key, metric in _METRICS.items():
        limits: spec.LimitsSection | None = getattr(section, key)
        if limits is None:
            continue
        name = section.name or f"{section.process}_{key}"
        if limits.max is not None:
            yield name, TimeLimit(metric=metric, value=limits.max), limits.location()
        if limits.min is not None:
            yield f"{name}_least", TimeLimit(metric=metric, value=limits.min, bound=Bound.LOWER), limits.location()
    if section.jitter is not None:
        name = section.name or f"{section.process}_{section.jitter.of}_jitter"
        yield name, JitterLimit(metric=_METRICS[section.jitter.of], value=section.jitter.max), section.jitter.location()
