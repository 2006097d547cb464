"""Requirements on processes and functions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from amalthea_uros.perf.constraints import Bound, Requirement, Severity, TimeLimit, TimeMetric
from amalthea_uros.spec import requirements as spec
from amalthea_uros.uros.chains import Member
from amalthea_uros.uros.notes import Notes

_METRICS = {
    "response_time": TimeMetric.RESPONSE_TIME,
    "net_execution_time": TimeMetric.NET_EXECUTION_TIME,
    "gross_execution_time": TimeMetric.GROSS_EXECUTION_TIME,
    "start_delay": TimeMetric.START_DELAY,
    "start_to_start": TimeMetric.START_TO_START,
    "end_to_end": TimeMetric.END_TO_END,
}


def requirements(sections: Iterable[spec.Requirement], members: Mapping[str, Member], notes: Notes) -> Iterator[Requirement]:
    """The requirements of the file, one for each limit."""
    for section in sections:
        member = members.get(section.process)
        if member is None:
            notes.unknown("process or function", section.process, members, section.location("process"))
            continue
        yield from _limits(section, member)


def _limits(section: spec.Requirement, member: Member) -> Iterator[Requirement]:
    for key, metric in _METRICS.items():
        limits: spec.Limits | None = getattr(section, key)
        if limits is None:
            continue
        for bound, value in ((Bound.UPPER, limits.max), (Bound.LOWER, limits.min)):
            if value is not None:
                # The same name may be given to several limits of one requirement.
                name = section.name or f"{section.process}_{key}"
                yield Requirement(
                    name=name if bound is Bound.UPPER else f"{name}_least",
                    process=member.process if member.runnable is None else None,
                    runnable=member.runnable,
                    limit=TimeLimit(metric=metric, value=value, bound=bound),
                    severity=Severity(section.severity) if section.severity else None,
                    origin=limits.location(),
                )
