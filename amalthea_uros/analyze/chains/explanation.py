"""What the maximum latency of a chain consists of: the jobs of its worst case, or the terms of its bound."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from amalthea_uros.analyze.chains import job_chains
from amalthea_uros.analyze.chains.bounds import terms
from amalthea_uros.analyze.chains.evaluator import ChainEvaluator, route_text
from amalthea_uros.analyze.chains.job_chains import JobBudget, backward, forward
from amalthea_uros.analyze.chains.read_write_times import ReadWriteTimes, reach
from amalthea_uros.analyze.chains.route_latencies import RouteLatencies
from amalthea_uros.analyze.chains.stage_timing import StageTiming, UnboundedStageError
from amalthea_uros.analyze.chains.timed_stage import TimedStage
from amalthea_uros.analyze.phases import Phases
from amalthea_uros.analyze.results import Analysis, ChainResult, Quantity, Value
from amalthea_uros.perf.events import EventChain
from amalthea_uros.timing.dataflow.chains import UnfoldError, sequences, unfold
from amalthea_uros.timing.dataflow.events import UnresolvedError
from amalthea_uros.timing.dataflow.routes import Route, routes
from amalthea_uros.timing.dataflow.stages import Stage
from amalthea_uros.timing.phases import unknown_phases
from amalthea_uros.timing.releases import known_releases
from amalthea_uros.units import Time

_REACTIONS = (Quantity.MAX_REACTION_TIME, Quantity.MAX_REDUCED_REACTION_TIME)


@dataclass(frozen=True, slots=True, kw_only=True)
class Hop:
    """The contribution of a process to a latency; times are relative to the first read.

    Attributes
    ----------
    job : its number, counted from 1 at the start of the system; None if the value is not based on single jobs
    release, start : of the job; None if they are unknown
    read, write : when it reads, and when its output is visible
    wait, run : from the previous output (or the beginning) to the read, and from the read to the output
    """

    process: str
    job: int | None
    release: Time | None
    start: Time | None
    read: Time
    write: Time
    wait: Time
    run: Time


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainExplanation:
    """A maximum latency of a chain.

    Attributes
    ----------
    value : that is explained; None if there is none, for the `reason`
    route : the events and the links between them
    hops : their waits and runs, with `overwritten`, add up to the value; empty for the `reason`
    overwritten : for data age, the time from the last output until the next one
    """

    chain: ChainResult
    quantity: Quantity
    value: Value | None = None
    route: str = ""
    hops: tuple[Hop, ...] = ()
    overwritten: Time = 0
    reason: str = ""


class _Step(NamedTuple):
    """A hop in time units, before its place in the whole is known: release and start are counted back from the read."""

    process: str
    wait: Time
    run: Time
    job: int | None = None
    release: Time | None = None
    start: Time | None = None


def explain_chain(analysis: Analysis, name: str, quantity: Quantity = Quantity.MAX_REDUCED_REACTION_TIME) -> ChainExplanation:
    """Explain a maximum latency of a chain."""
    result = analysis.chains[name]
    value = result.value(quantity)
    if value is None or value.value is None:
        reason = result.reason or "no method gives this value"
        return ChainExplanation(chain=result, quantity=quantity, reason=reason)
    context = analysis.solution.context
    for evaluator in _evaluators(context.system.chains[name], analysis):
        for route in _routes(context.system.chains[name], evaluator):
            found = _RouteExplanation(evaluator, route, quantity, value).hops()
            if found is not None:
                hops, overwritten = found
                text = route_text(route)
                return ChainExplanation(
                    chain=result, quantity=quantity, value=value, route=text, hops=hops, overwritten=overwritten
                )
    return ChainExplanation(chain=result, quantity=quantity, value=value, reason="its method does not tell single hops")


def _evaluators(chain: EventChain, analysis: Analysis) -> Iterator[ChainEvaluator]:
    """The system as it can have been analysed: for each phase of everything, for each phase of what the chain passes, for none."""
    solution = analysis.solution
    evaluation = ChainEvaluator(solution)
    for occurrences in (unknown_phases(solution.context.system), evaluation.occurrences(chain)):
        if phases := Phases.of(solution, occurrences):
            yield from (ChainEvaluator(each) for _, each in phases.solutions(phases.cases.of_chain(chain)))
    yield evaluation


def _routes(chain: EventChain, evaluator: ChainEvaluator) -> list[Route]:
    context = evaluator.context
    try:
        ways = sequences(unfold(chain, context.system)[0])
        events = context.system.events_by_name
        return [route for way in ways for route in routes([events[name] for name in way], context.dataflow)]
    except (UnfoldError, UnresolvedError):
        return []


@dataclass(frozen=True, slots=True)
class _RouteExplanation:
    """The explanation of a value by one route of a chain."""

    evaluator: ChainEvaluator
    route: Route
    quantity: Quantity
    value: Value

    @property
    def timing(self) -> StageTiming:
        return self.evaluator.timing

    def hops(self) -> tuple[tuple[Hop, ...], Time] | None:
        """The hops, and the time until the output is overwritten; None if they do not add up to the value."""
        try:
            latencies = self.evaluator.latencies(self.route)
        except UnboundedStageError:
            return None
        if not any(self._is_value(found) for found in latencies.values()):
            return None
        steps, overwritten = self._steps(latencies)
        total = sum(step.wait + step.run for step in steps) + overwritten
        if not steps or self._picoseconds(total) != self.value.value:
            return None
        return self._placed(steps), self._picoseconds(total) - self._picoseconds(total - overwritten)

    def _is_value(self, found: Value) -> bool:
        # The value of all phases is that of one of them, and its method is named after that.
        same = (found.quantity, found.value) == (self.quantity, self.value.value)
        return same and self.value.method.startswith(found.method)

    def _steps(self, latencies: RouteLatencies) -> tuple[list[_Step], Time]:
        groups = self.evaluator.groups(self.route)
        if self.value.source != job_chains.SOURCE:
            return self._of_bound([timed for part in latencies.parts for timed in part], groups), 0
        found: list[_Step] = []
        overwritten = 0
        for number, part in enumerate(latencies.parts):
            here, groups = groups[: len(part)], groups[len(part) :]
            path = _worst_path(part, self._of_part(number, len(latencies.parts)))
            if path is None:
                return [], 0
            steps = self._of_jobs(path, here)
            found += [steps[0]._replace(wait=steps[0].wait + overwritten), *steps[1:]]
            overwritten = path.overwritten
        return found, overwritten

    def _of_part(self, number: int, count: int) -> Quantity:
        """The quantity of the part of the chain on one controller: data from another one arrive just after a read at worst."""
        if self.quantity in _REACTIONS:
            return self.quantity if number == 0 else Quantity.MAX_REACTION_TIME
        return self.quantity if number == count - 1 else Quantity.MAX_DATA_AGE

    # By job chains

    def _of_jobs(self, path: _Path, groups: Sequence[Sequence[Stage]]) -> list[_Step]:
        found = []
        previous = path.begin
        for job, times, group in zip(path.jobs, path.times, groups, strict=True):
            release, write = int(times.releases[job]), int(times.writes[job])
            # A writer that preempts its reader has written before that reads, however early it could.
            read = max(int(times.reads[job]), previous)
            name = group[0].process.name
            number = self._number(group[0], release)
            start = self._start(name, number)
            found += self._with_triggered(
                _Step(
                    name,
                    wait=read - previous,
                    run=write - read,
                    job=number,
                    release=read - release,
                    start=None if start is None else read - start,
                ),
                group,
            )
            previous = write
        return found

    def _number(self, stage: Stage, release: Time) -> int:
        """The number of a job by its release."""
        stimulus = known_releases(stage.process, self.evaluator.context.system)
        assert stimulus is not None
        return (release // self.timing.unit - stimulus.offset) // stimulus.period + 1

    def _start(self, process: str, number: int) -> Time | None:
        """When a job starts; None if that varies or is unknown."""
        scheduled = self.evaluator.context.scheduled[process]
        found = self.timing.schedules.of(scheduled.core, with_slices=False)
        if found is None:
            return None
        earliest, latest = found.best[process].begins, found.worst[process].begins
        per_cycle = found.cycle // found.tasks[process].period
        cycles = max(0, -(-(number - len(latest)) // per_cycle))
        job = number - 1 - cycles * per_cycle
        if earliest[job] != latest[job]:
            return None
        start = int(latest[job]) + cycles * found.cycle
        return start * self.timing.unit // self.evaluator.context.time_base(process)

    def _with_triggered(self, step: _Step, group: Sequence[Stage]) -> list[_Step]:
        """A step, and those of the processes that it triggers, which add the same time to every job."""
        parts = [self.timing.group(group[:count], None).task.response for count in range(1, len(group) + 1)]
        delays = [more - less for less, more in pairwise(parts)]
        if step.run < sum(delays):
            return [step]
        triggered = [_Step(stage.process.name, 0, delay) for stage, delay in zip(group[1:], delays, strict=True)]
        return [step._replace(run=step.run - sum(delays)), *triggered]

    # By a bound

    def _of_bound(self, timed: Sequence[TimedStage], groups: Sequence[Sequence[Stage]]) -> list[_Step]:
        table = terms.REDUCED_DATA_AGE if self.quantity is Quantity.MAX_REDUCED_DATA_AGE else terms.REACTION_TIME
        of_method = next((table[source] for source in table if self.value.source.startswith(source)), None)
        if of_method is None:
            return []
        found: list[_Step] = []
        for term, group in zip(of_method([each.task for each in timed]), groups, strict=True):
            is_reduced = self.quantity is Quantity.MAX_REDUCED_REACTION_TIME and not found
            step = _Step(group[0].process.name, wait=0 if is_reduced else term.wait, run=term.run)
            found += self._with_triggered(step, group)
        return found

    # Times

    def _picoseconds(self, time: Time) -> Time:
        return -(-time // self.timing.unit)

    def _placed(self, steps: Sequence[_Step]) -> tuple[Hop, ...]:
        """The hops in picoseconds; as all times are rounded from the beginning, waits and runs still add up."""
        found = []
        now, origin = 0, self._picoseconds(steps[0].wait)
        for step in steps:
            read, write = now + step.wait, now + step.wait + step.run
            found.append(
                Hop(
                    process=step.process,
                    job=step.job,
                    release=None if step.release is None else self._picoseconds(read - step.release) - origin,
                    start=None if step.start is None else self._picoseconds(read - step.start) - origin,
                    read=self._picoseconds(read) - origin,
                    write=self._picoseconds(write) - origin,
                    wait=self._picoseconds(read) - self._picoseconds(now),
                    run=self._picoseconds(write) - self._picoseconds(read),
                )
            )
            now = write
        return tuple(found)


class _Path(NamedTuple):
    """A job of each task, and when the latency begins."""

    times: Sequence[ReadWriteTimes]
    jobs: Sequence[int]
    begin: Time
    overwritten: Time


def _worst_path(part: Sequence[TimedStage], quantity: Quantity) -> _Path | None:
    """The job chain with the greatest latency; None if there are no job chains."""
    bounds = [timed.read_write for timed in part if timed.read_write is not None]
    chain = [each.pessimistic for each in bounds]
    if len(bounds) < len(part):
        return None
    found = JobBudget().build(chain, max(each.steady_state_start for each in bounds))
    if found is None:
        return None
    until = int(max(found.ends.max(), found.next_writes.max())) + 2 * reach(chain)
    times = [task.extended(until) for task in chain]
    if quantity in _REACTIONS:
        begins = found.previous_reads if quantity is Quantity.MAX_REACTION_TIME else found.reads
        worst = int((found.ends - begins).argmax())
        jobs = [int(np.searchsorted(times[0].reads, found.reads[worst]))]
        for writer, reader in pairwise(times):
            jobs.append(int(forward([writer, reader], np.array(jobs[-1:], dtype=np.int64))[0]))
        return _Path(times, jobs, int(begins[worst]), 0)
    ends = found.next_writes if quantity is Quantity.MAX_DATA_AGE else found.writes
    worst = int((ends - found.starts).argmax())
    jobs = [int(np.searchsorted(times[-1].writes, found.writes[worst]))]
    for writer, reader in list(pairwise(times))[::-1]:
        jobs.insert(0, int(backward([writer, reader], np.array(jobs[:1], dtype=np.int64))[0]))
    return _Path(times, jobs, int(found.starts[worst]), int(ends[worst] - found.writes[worst]))
