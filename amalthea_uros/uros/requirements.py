"""Requirements on processes and runnables: those of the description, and deadlines in executors with loops."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.constraints import Bound, JitterLimit, Limit, Requirement, RequirementSeverity, TimeLimit, TimeMetric
from amalthea_uros.spec import requirements as spec
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.chain_members import ChainElement

_METRICS = {
    "response_time": TimeMetric.RESPONSE_TIME,
    "net_execution_time": TimeMetric.NET_EXECUTION_TIME,
    "gross_execution_time": TimeMetric.GROSS_EXECUTION_TIME,
    "start_delay": TimeMetric.START_DELAY,
    "start_to_start": TimeMetric.START_TO_START,
    "end_to_end": TimeMetric.END_TO_END,
}


def requirements(
    sections: Iterable[spec.RequirementSection], elements: Mapping[str, ChainElement], notes: Notes
) -> Iterator[Requirement]:
    """The requirements of the description, one for each limit."""
    for section in sections:
        element = elements.get(section.process)
        if element is None:
            notes.undefined("process or runnable", section.process, elements, section.location("process"))
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
