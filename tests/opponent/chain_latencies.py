"""Latencies of a chain in a play, by the definitions of Guenzel, Chen, Ueter, Chen (ECRTS 2023).

Each job reads once and writes once. The forward job chain of a job continues with the first job that reads at or after a write, the
backward one with the last job that wrote at or before a read.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from opponent.player import Job
from opponent.systems import PlainSystem


@dataclass(frozen=True, slots=True)
class Stage:
    """When the jobs of a process of the chain begin, read, write and end, in order; whether they end by their periods."""

    begins: list[int]
    reads: list[int]
    writes: list[int]
    ends: list[int]
    is_in_time: bool


def chain_latencies(
    system: PlainSystem, jobs: list[list[Job]], begin: int, end: int, *, by_periods: bool
) -> Iterator[tuple[str, int]]:
    """All values of each quantity, of job chains within a span of time.

    `by_periods`: the chain begins with the release of the first job and ends with the period of the last one, as some understand
    LET; else with the execution of both.
    """
    stages = list(_stages(system, jobs, by_periods=by_periods))
    first, last = stages[0], stages[-1]
    if not all(stage.is_in_time for stage in stages):
        return
    for number in range(1, len(first.begins)):
        arrived = _forward(stages, number)
        if arrived is None or last.ends[arrived] >= end:
            break
        if first.begins[number - 1] >= begin:
            yield "max_reaction_time", last.ends[arrived] - first.begins[number - 1]
            yield "max_reduced_reaction_time", last.ends[arrived] - first.begins[number]
            yield "min_first_to_first", last.ends[arrived] - first.begins[number]
    for number in range(len(last.ends) - 1):
        source = _backward(stages, number)
        if source is not None and begin <= first.begins[source] and last.ends[number + 1] < end:
            yield "max_data_age", last.ends[number + 1] - first.begins[source]
            yield "max_reduced_data_age", last.ends[number] - first.begins[source]
            yield "min_last_to_last", last.ends[number] - first.begins[source]


def _stages(system: PlainSystem, jobs: list[list[Job]], *, by_periods: bool) -> Iterator[Stage]:
    """The processes of the chain in its order."""
    index = {process["name"]: index for index, process in enumerate(system["processes"])}
    communication = system["chain"]["communication"]
    for position, name in enumerate(system["chain"]["processes"]):
        of_process = jobs[index[name]]
        begins, ends = [job.start or 0 for job in of_process], [job.end or 0 for job in of_process]
        releases = [job.release.time for job in of_process]
        if communication == "LET":
            period = system["processes"][index[name]]["arrival"]["periodic"]["period"]
            due = [release + period for release in releases]
            is_in_time = all(e <= d for e, d in zip(ends, due, strict=True))
            yield Stage(*((releases, releases, due, due) if by_periods else (begins, releases, due, ends)), is_in_time)
        elif communication == "implicit":
            yield Stage(begins, begins, ends, ends, True)
        else:
            reads = [job.accesses.get(("read", f"L{position - 1}"), job.start or 0) for job in of_process]
            writes = [job.accesses.get(("write", f"L{position}"), job.end or 0) for job in of_process]
            yield Stage(begins, reads, writes, ends, True)


def _forward(stages: list[Stage], number: int) -> int | None:
    """The job of the last process that is the first one reached by a job of the first process."""
    for before, after in pairwise(stages):
        number = bisect_left(after.reads, before.writes[number])
        if number == len(after.reads):
            return None
    return number


def _backward(stages: list[Stage], number: int) -> int | None:
    """The job of the first process that a job of the last one is based on."""
    for after, before in pairwise(reversed(stages)):
        number = bisect_right(before.writes, after.reads[number]) - 1
        if number < 0:
            return None
    return number
