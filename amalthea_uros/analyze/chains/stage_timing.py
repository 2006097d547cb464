"""When the jobs of the stages of a chain read and write, at the earliest and at the latest.

If the schedule of the core is known apart from execution times, the schedules of all best and of all worst cases bound every other
schedule. Otherwise releases and response times give the bounds. If releases are unknown, a stage is only a `ChainTask`.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import lcm

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.analyze.chains.boundary_times import (
    BoundaryWindows,
    by_response,
    by_schedule,
    is_inside,
    is_logical,
    kind,
    logical,
)
from amalthea_uros.analyze.chains.bounds import ChainTask
from amalthea_uros.analyze.chains.participation import Participation
from amalthea_uros.analyze.chains.read_write_times import ReadWriteBounds, ReadWriteTimes, TimedStage
from amalthea_uros.analyze.response_times.blocking import Blocking
from amalthea_uros.analyze.response_times.schedule import MAX_JOBS
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Communication
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Counter, Periodic
from amalthea_uros.timing.activation.releases import known_releases, latest_first_release
from amalthea_uros.timing.basics.time_base import LIMIT
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.events import EventOccurrence, JobPhase
from amalthea_uros.timing.dataflow.stages import NEXT_JOB, SAME_JOB, At, Fire, Pass, Read, Stage
from amalthea_uros.timing.demand.model import MAX_TIME_BASE
from amalthea_uros.timing.jobs.counters import first_effect, is_always, max_distance
from amalthea_uros.timing.response import Response
from amalthea_uros.timing.scheduling.scheduled import ScheduledProcess
from amalthea_uros.units import Time


@dataclass(slots=True)
class StageTiming:
    """Finds read and write times of the stages of chains; times are counted in `unit` parts of a picosecond."""

    solution: Solution
    unit: int = field(init=False)
    participation: Participation = field(init=False)
    _blocking: dict[str, Blocking] = field(default_factory=dict)
    _whole_jobs: dict[tuple[str, JobPhase | None, JobPhase | None], ReadWriteBounds] = field(default_factory=dict)

    @property
    def context(self) -> TimingContext:
        """The timing context of the system."""
        return self.solution.context

    def __post_init__(self) -> None:
        self.participation = Participation(self.context)
        unit = lcm(*(self.context.demand_model.time_base(core) for core in self.context.system.cores))
        self.unit = unit if unit <= MAX_TIME_BASE else 1

    def group(self, stages: Sequence[Stage], follower: Stage | None, before: Stage | None = None) -> TimedStage:
        """A stage and those that it triggers, directly or through others.

        Parameters
        ----------
        follower : the first stage that reads from the last of them
        before : the stage that the first of them reads from

        Raises
        ------
        UnknownError : a response time in it is unbounded or unknown.
        """
        timed = self._group(stages, follower)
        if before is not None and timed.read_write is not None and self._sees_only_what_ended(before, stages[0]):
            timed = replace(timed, read_write=timed.read_write.reading_at_release())
        return replace(
            timed,
            stimulus_wait=self._stimulus_wait(stages),
            responds_before_read=_responds_before_read(stages[-1]),
        )

    def exact_times(self, occurrence: EventOccurrence) -> ReadWriteBounds | None:
        """The times of an event in all jobs, at which a stage from it to itself reads; None unless they are known exactly.

        Raises
        ------
        UnknownError : a response time is unbounded or unknown.
        """
        begin, end = (At(occurrence, Communication.IMPLICIT, is_end=is_end) for is_end in (False, True))
        positions = () if occurrence.position is None else (occurrence.position,)
        found = self.group([Stage(occurrence.process, begin, end, positions)], None).read_write
        return found if found is not None and found.is_exact else None

    def after_ends(self, groups: Sequence[Sequence[Stage]]) -> list[Sequence[Stage]]:
        """The groups of stages of a route; if it begins at the end of a job, with the job that certainly answers.

        What the job has triggered itself may have responded before that; then only the next job answers.
        """
        match groups:
            case [[Stage(enter=At(), leave=Pass()) as ending], [Stage(leave=Fire()) as base, *triggered]]:
                if self._responds_before_end(base, triggered):
                    return [[replace(ending, jobs_later=NEXT_JOB)], *groups[1:]]
        return list(groups)

    def _responds_before_end(self, base: Stage, triggered: Sequence[Stage]) -> bool:
        """Whether what a job triggers has certainly responded before the end of the job."""
        left = self._left_after(base)
        if left == 0:
            return False
        # A job that is kept from its core goes on only after the response.
        is_kept_off = all(self._interrupts(stage, base) for stage in triggered)
        return is_kept_off or sum(self._windows(stage).latest(stage.leave) for stage in triggered) < left

    def _left_after(self, base: Stage) -> Time:
        """The minimum demand of a job after it has triggered the next stage."""
        return self._demand_after(base.process, base.leave) if isinstance(base.leave, Fire) else 0

    def _demand_after(self, process: Process, boundary: Fire | Read) -> Time:
        """The minimum demand of a job after something that it does; 0 if that is unknown."""
        model, scheduled = self.context.execution_model(process.name), self.context.scheduled.get(process.name)
        if scheduled is None or boundary.position is None:
            return 0
        before = model.of_position(boundary.position, scheduled.core, including=True)
        everything = model.of_activities(process, process.activities, scheduled.core)
        return (everything.best - before.best) * self.unit // model.time_base(scheduled.core)

    def _stimulus_wait(self, stages: Sequence[Stage]) -> Time | None:
        """The maximum time from a job that triggers to the next one of which the counters of stimuli let the trigger have an effect."""
        if all(is_always(self.participation.counter_of(name)) for stage in stages[1:] for name in stage.process.stimuli):
            return 0
        counter = self.participation.counter(stages)
        if self._why_irregular(stages[0].process):
            return None
        jobs = max(max_distance(counter), first_effect(counter)) - 1
        return jobs * self._max_interarrival(stages[0].process)

    def _group(self, stages: Sequence[Stage], follower: Stage | None) -> TimedStage:
        base, triggered = stages[0], stages[1:]
        for stage in triggered:
            if is_logical(stage.leave):
                raise UnknownError(
                    f"{stage.process.name!r} is triggered, so that it has no period, as LET communication requires"
                )
        max_delay = sum(self._windows(stage).latest(stage.leave) for stage in triggered)
        min_delay = sum(self._windows(stage).earliest(stage.leave) for stage in triggered)
        counter = self.participation.counter(stages)
        preempts_reader = self._preempts_reader(base, follower) and not triggered
        is_visible_at_once = self._is_visible_at_once(stages[-1], follower)
        why_uncertain = self.participation.why_uncertain(stages)
        why_irregular = why_uncertain or self._why_irregular(stages[0].process)
        releases = known_releases(base.process, self.context.system)
        read_write = None if releases is None else self._read_write(base, releases)
        task = self._chain_task(
            base,
            counter,
            response=self._chain_response(base, read_write) + max_delay,
            preempts_reader=preempts_reader,
            is_regular=not why_irregular,
        )
        if why_irregular:
            return TimedStage(task=task, reason=why_irregular, why_irregular=why_irregular, is_certain=not why_uncertain)
        if not counter.is_phase_known:
            return TimedStage(
                task=replace(task, offset=None), reason=f"the phase at which {base.process.name!r} takes part is unknown"
            )
        if releases is None or read_write is None:
            return TimedStage(task=task, reason=f"the release times of {base.process.name!r} are unknown")
        if self._is_too_long(releases, counter):
            return TimedStage(task=task, reason=f"the jobs of {base.process.name!r} that take part are too far apart")
        later = stages[-1].jobs_later
        found = (
            read_write
            if later is None and is_visible_at_once and not (max_delay or min_delay or preempts_reader)
            else replace(
                read_write,
                pessimistic=replace(
                    _later(read_write.pessimistic, max_delay),
                    is_visible_at_once=is_visible_at_once,
                    preempts_reader=preempts_reader,
                    jobs_later=later.most if later is not None else None,
                ),
                optimistic=replace(
                    _later(read_write.optimistic, min_delay), jobs_later=later.least if later is not None else None
                ),
            )
        )
        return TimedStage(task=task, read_write=found.taking_part(counter, releases.period * self.unit))

    def _is_too_long(self, releases: Periodic, counter: Counter) -> bool:
        """Whether two jobs that take part are too far apart in time, or have too many others between them."""
        farthest = max(counter.prescaler, first_effect(counter))
        return farthest > MAX_JOBS or (releases.offset + 4 * farthest * releases.period) * self.unit > LIMIT

    # Processes

    def _response(self, process: Process) -> Response:
        response = self.solution.responses.get(process.name)
        if response is None:
            reason = self.solution.reasons.get(process.name, "it was not analysed")
            raise UnknownError(f"the response time of {process.name!r} is unknown: {reason}")
        return response

    def _worst(self, process: Process) -> Time:
        response = self._response(process)
        if response.worst is not None and self.solution.depends_on_losses(process.name):
            raise UnknownError(f"{process.name!r}, or a process that precedes it, can lose activations")
        if response.worst is None:
            raise UnknownError(f"the response time of {process.name!r} is unbounded: {response.reason}")
        return response.worst * self.unit

    def _windows(self, stage: Stage, period: Time = 0) -> BoundaryWindows:
        self._worst(stage.process)
        return BoundaryWindows(self.solution, stage, self._response(stage.process), self.unit, period)

    def _why_irregular(self, process: Process) -> str:
        """Why there is no maximum time between two jobs of a process; "" if there is one."""
        events = self.solution.event_models.get(process.name)
        if events is not None and events.can_be_suppressed:
            return f"{process.name!r} is activated only if the condition of a stimulus is true"
        if events is None or events.max_interarrival is None:
            return f"the maximum time between two activations of {process.name!r} is unknown"
        return ""

    def _chain_task(self, base: Stage, counter: Counter, response: Time, preempts_reader: bool, is_regular: bool) -> ChainTask:
        releases = known_releases(base.process, self.context.system)
        offset = None if releases is None else (releases.offset + (first_effect(counter) - 1) * releases.period) * self.unit
        return ChainTask(
            name=base.process.name,
            period=self._max_interarrival(base.process) * max_distance(counter),
            is_regular=is_regular,
            response=response,
            offset=offset,
            first_release=self._first_release(base.process, counter),
            preempts_reader=preempts_reader,
        )

    def _first_release(self, process: Process, counter: Counter) -> Time:
        """The latest time at which the first job that takes part is released."""
        before = first_effect(counter) - 1 if counter.is_phase_known else max_distance(counter)
        return latest_first_release(process, self.context.system) * self.unit + before * self._max_interarrival(process)

    def _max_interarrival(self, process: Process) -> Time:
        """The maximum time between two activations; 0 if there is none."""
        events = self.solution.event_models.get(process.name)
        return ((events.max_interarrival if events is not None else None) or 0) * self.unit

    def _chain_response(self, base: Stage, read_write: ReadWriteBounds | None) -> Time:
        """The maximum time from the release of a job until it leaves a stage."""
        worst = self._worst(base.process)
        if isinstance(base.leave, Pass):
            # A job passes the effect on to itself, or else to the next one at the latest.
            return 0 if base.jobs_later == SAME_JOB else self._max_interarrival(base.process)
        if is_logical(base.leave):
            name = base.process.name
            match [self.context.system.stimuli_by_name.get(each) for each in base.process.stimuli]:
                case [Periodic(period=period)] if worst <= period * self.unit:
                    return period * self.unit
                case [Periodic()]:
                    raise UnknownError(f"{name!r} does not always end within its period, as LET communication requires")
            raise UnknownError(f"{name!r} has no period, as LET communication requires")
        if read_write is None:
            return self._windows(base).latest(base.leave)
        return int((read_write.pessimistic.writes - read_write.pessimistic.releases).max())

    def _preempts_reader(self, base: Stage, follower: Stage | None) -> bool:
        """Whether the jobs of a stage preempt those of the next one, so that these cannot read before they have written."""
        if follower is None or isinstance(base.leave, Fire) or is_logical(base.leave) or is_logical(follower.enter):
            return False
        if base.process.name == follower.process.name:
            return False  # a job cannot read its own future output
        # A reader that reads later than at its start may read just when the writer is released.
        is_at_start = isinstance(follower.enter, Read) and follower.enter.communication is Communication.IMPLICIT
        # The activation of a job that is kept off until then is no answer.
        return is_at_start and kind(follower.leave) is not JobPhase.ACTIVATION and self._takes_core(base, follower)

    def _takes_core(self, one: Stage, other: Stage) -> bool:
        """Whether the process of a stage, as long as it is ready, keeps that of another one from starting."""
        both = self._scheduled(one, other)
        return both is not None and self._blocking_on(both[0].core).prevents_start(*both)

    def _interrupts(self, one: Stage, other: Stage) -> bool:
        """Whether the process of a stage, once it is ready, preempts that of another one at once and keeps it off until its end."""
        both = self._scheduled(one, other)
        return both is not None and self._blocking_on(both[0].core).interrupts(*both)

    def _scheduled(self, one: Stage, other: Stage) -> tuple[ScheduledProcess, ScheduledProcess] | None:
        if one.process.name in self.context.waiting:
            return None  # while it waits, it keeps nobody off
        first, then = self.context.scheduled.get(one.process.name), self.context.scheduled.get(other.process.name)
        return None if first is None or then is None else (first, then)

    def _sees_only_what_ended(self, writer: Stage, reader: Stage) -> bool:
        """Whether a job that reads sees only what was written up to its release.

        Proof, for a reader that preempts the writer at once and delays it, and whose jobs end before the next one is released:

        1. From its release on the job of the reader is ready, because the one before it has ended. Until it ends, the writer does not
           execute.
        2. A job of the writer that has not written at that release writes while it executes, or when it ends, which is right after
           it has executed. Both come after the end of the reader, and so after its read.
        3. A job that has written by then has done so at the latest at the release.
        4. An explicit read counts only if the job executes after it: in which order a read at the end of a job and an access of the job
           that executes next occur, if both are at one instant, is unknown.

        So the latest read counts as if it were at the release, although the reader may get the core later. Under logical execution
        time the writer publishes without executing; a reader reads at its release anyway.
        """
        if is_logical(writer.leave) or is_logical(reader.enter) or self.context.decisions:
            return False
        if writer.jobs_later is not None or isinstance(writer.leave, Pass) or not isinstance(reader.enter, Read):
            return False
        if is_inside(reader.enter) and not self._demand_after(reader.process, reader.enter):
            return False
        releases = known_releases(reader.process, self.context.system)
        if releases is None or self.context.has_loops_or_waits(self.context.scheduled[reader.process.name].core):
            return False
        return self._interrupts(reader, writer) and self._worst(reader.process) <= releases.period * self.unit

    def _is_visible_at_once(self, writer: Stage, reader: Stage | None) -> bool:
        """Whether a read at the instant of a write certainly comes after it.

        Nobody states in which order two accesses inside of jobs occur at one instant, unless the writer has kept the reader off
        since its release. The end of a job comes before the start of another one.
        """
        if reader is None or writer.jobs_later is not None or not any(map(is_inside, (writer.leave, reader.enter))):
            return True
        return self._takes_core(writer, reader) and self._windows(writer).earliest(writer.leave) > 0

    def _blocking_on(self, core: str) -> Blocking:
        if core not in self._blocking:
            here = [item for item in self.context.on_core(core) if item.server is None]
            self._blocking[core] = Blocking.of(here, self.solution)
        return self._blocking[core]

    # Read and write times

    def _read_write(self, stage: Stage, releases: Periodic) -> ReadWriteBounds:
        """The times of all jobs of a process."""
        if is_logical(stage.enter) and is_logical(stage.leave):
            return logical(releases, self.unit)
        if is_inside(stage.enter) or is_inside(stage.leave):
            return self._bounds(stage, releases)
        # Many chains pass the same processes from the start to the end of their jobs.
        key = (stage.process.name, kind(stage.enter), kind(stage.leave))
        if key not in self._whole_jobs:
            self._whole_jobs[key] = self._bounds(stage, releases)
        return self._whole_jobs[key]

    def _bounds(self, stage: Stage, releases: Periodic) -> ReadWriteBounds:
        found = by_schedule(stage, self.solution, self.unit)
        return by_response(self._windows(stage, releases.period * self.unit), releases) if found is None else found


def _responds_before_read(stage: Stage) -> bool:
    """Whether the event at the end of a chain comes before its job reads."""
    if not isinstance(stage.enter, Read) or not isinstance(stage.leave, At):
        return False
    read, event = kind(stage.enter), kind(stage.leave)
    if event is JobPhase.ACTIVATION:
        return read is not JobPhase.ACTIVATION
    return event is JobPhase.START and read is JobPhase.BEFORE


def _later(times: ReadWriteTimes, delay: Time) -> ReadWriteTimes:
    return replace(times, writes=times.writes + delay) if delay else times
