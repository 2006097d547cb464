"""Why the parts of a latency take their time: the next release, other jobs, the execution itself, or what a bound assumes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.chains.boundary_times import is_logical
from amalthea_uros.analyze.chains.read_write_times import TimedStage
from amalthea_uros.analyze.chains.stage_timing import StageTiming
from amalthea_uros.analyze.response_times.core_schedule import CoreSchedule
from amalthea_uros.analyze.results.explanations import CauseKind, Execution, LatencyCause
from amalthea_uros.timing.dataflow.stages import Stage
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers


def cause(kind: CauseKind, time: Time) -> tuple[LatencyCause, ...]:
    """A single cause; none if it takes no time."""
    return (LatencyCause(kind=kind, time=time),) if time > 0 else ()


def of_executions(
    found: Iterable[Execution], process: str, length: Time, others: CauseKind, rest: CauseKind
) -> tuple[LatencyCause, ...]:
    """The causes of an interval in which a job of a process is pending.

    Parameters
    ----------
    found : what its core executes in the interval
    others : what the executions of other processes are
    rest : why the interval is longer than that
    """
    times: dict[str, Time] = {}
    jobs: dict[str, set[int]] = {}
    for each in found:
        times[each.process] = times.get(each.process, 0) + each.end - each.begin
        jobs.setdefault(each.process, set()).add(each.job)
    own = times.pop(process, 0)
    interfering = [
        LatencyCause(kind=others, time=time, process=name, jobs=len(jobs[name]))
        for name, time in sorted(times.items(), key=lambda item: -item[1])
    ]
    remaining = length - own - sum(times.values())
    return (*interfering, *cause(CauseKind.EXECUTION, own), *cause(rest, remaining))


@dataclass(frozen=True, slots=True)
class HopReasons:
    """Why a job of the worst case waits and runs; times are those of the chain.

    Attributes
    ----------
    number : of the job
    """

    timing: StageTiming
    stage: Stage
    timed: TimedStage
    number: int

    def of_job(
        self, previous: Time, release: Time, read: Time, write: Time
    ) -> tuple[tuple[LatencyCause, ...], tuple[LatencyCause, ...], tuple[Execution, ...]]:
        """The causes of its wait and of its run, and what is executed from its release, with times relative to the read."""
        # Before its release, it waits for that; after it, for other jobs.
        name, pending = self.stage.process.name, min(max(previous, release), read)
        waits = cause(CauseKind.NEXT_JOB, pending - previous)
        if self.timed.is_logical:
            return waits, cause(CauseKind.LOGICAL, write - read), ()
        before, after = self._executed(pending, read), self._executed(read, write)
        if before is None or after is None:
            run, response = cause(self._rest(CauseKind.RESPONSE), write - read), self.timing.solution.responses.get(name)
            if response is not None and response.worst is not None and response.worst * self.timing.unit == write - read:
                terms = tuple((term, value) for term, value in response.terms.items() if value)
                run = tuple(replace(each, terms=terms) for each in run)
            return (*waits, *cause(CauseKind.READ_DELAY, read - pending)), run, ()
        own = [each for each in after if (each.process, each.job) == (name, self.number)]
        # What is executed after the job says nothing about an output at the end of the period.
        last = max((each.end for each in own), default=read)
        during = [each for each in after if each.begin < last]
        return (
            (*waits, *of_executions(before, name, read - pending, CauseKind.INTERFERENCE, CauseKind.READ_DELAY)),
            of_executions(during, name, write - read, CauseKind.PREEMPTION, self._rest(CauseKind.RESPONSE)),
            tuple(replace(each, begin=each.begin - read, end=each.end - read) for each in (*before, *during)),
        )

    def _rest(self, otherwise: CauseKind) -> CauseKind:
        return CauseKind.LOGICAL if is_logical(self.stage.leave) else otherwise

    def _executed(self, begin: Time, end: Time) -> list[Execution] | None:
        """What the core executes in an interval; None if that is not the same in each run with these reads and writes."""
        core, timing = self.timing.context.scheduled[self.stage.process.name].core, self.timing
        schedule = timing.solution.schedule(core, with_slices=True) if self.timed.is_exact else None
        factor, rest = divmod(timing.unit, timing.context.demand_model.time_base(core))
        if schedule is None or rest:
            return None
        found = executions(core, schedule, -(-begin // factor), -(-end // factor))
        return [replace(each, begin=each.begin * factor, end=each.end * factor) for each in found]


def executions(core: str, schedule: CoreSchedule, begin: Time, end: Time) -> list[Execution]:
    """What a core executes from one time to another one in the worst case, in order; in the time base of the core."""
    # In the steady state, each cycle is like the one that is covered last.
    skipped = max(0, (begin - schedule.steady_state_start) // schedule.cycle)
    shift = skipped * schedule.cycle
    found = [
        Execution(
            core=core,
            process=name,
            job=job + 1 + skipped * (schedule.cycle // schedule.tasks[name].period),
            begin=max(first + shift, begin),
            end=min(last + shift, end),
        )
        for name in schedule.tasks
        for job, first, last in _slices(schedule, name, begin - shift, end - shift)
    ]
    return sorted(found, key=lambda each: (each.begin, each.process))


def _slices(schedule: CoreSchedule, name: str, begin: Time, end: Time) -> Iterator[tuple[int, Time, Time]]:
    """The execution slices of a task in an interval, each with the number of its job counted from 0."""
    jobs, per_cycle = schedule.worst[name], schedule.cycle // schedule.tasks[name].period
    slices = jobs.execution_slices
    repeated = slices[slices[:, 0] >= len(jobs.releases) - per_cycle]
    rounds = max(0, -(-(end - schedule.until) // schedule.cycle))
    further: list[Numbers] = [
        repeated + np.array((per_cycle, schedule.cycle, schedule.cycle)) * number for number in range(1, rounds + 1)
    ]
    every = np.concatenate((slices, *further))
    inside = np.minimum(every[:, 2], end) > np.maximum(every[:, 1], begin)
    yield from every[inside].tolist()
