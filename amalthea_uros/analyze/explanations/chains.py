"""What the maximum latency of a chain consists of: the jobs of its worst case, or the terms of its bound."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import accumulate, pairwise

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.chains import bounds, job_chains
from amalthea_uros.analyze.chains.evaluator import ChainEvaluator
from amalthea_uros.analyze.chains.job_chains import JobPath, worst_path
from amalthea_uros.analyze.chains.read_write_times import TimedStage
from amalthea_uros.analyze.chains.route_latencies import RouteLatencies
from amalthea_uros.analyze.chains.stage_timing import StageTiming
from amalthea_uros.analyze.explanations.hop_causes import HopReasons, cause
from amalthea_uros.analyze.phases.cases import PhaseCases
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import LatencyQuantity, LatencyValue
from amalthea_uros.analyze.results.explanations import CauseKind, ChainExplanation, LatencyCause, ProcessHop
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.constraints import LatencyConstraint
from amalthea_uros.perf.events import EventChain
from amalthea_uros.timing.activation.releases import known_releases, unknown_phases
from amalthea_uros.timing.dataflow.routes import Route, route_text
from amalthea_uros.timing.dataflow.stages import Stage
from amalthea_uros.timing.jobs.counters import ALWAYS
from amalthea_uros.units import Time


def explain_chain(
    analysis: Analysis, name: str, quantity: LatencyQuantity = LatencyQuantity.MAX_REDUCED_REACTION_TIME
) -> ChainExplanation:
    """Explain a maximum latency of a chain."""
    # A process can have the same name.
    limits = {
        each.name
        for each in analysis.solution.context.system.constraints.constraints
        if isinstance(each, LatencyConstraint) and each.chain == name
    }
    verdicts = tuple(each for each in analysis.requirements if each.object == name and each.name in limits)
    return replace(_explained(analysis, name, quantity), requirements=verdicts)


def _explained(analysis: Analysis, name: str, quantity: LatencyQuantity) -> ChainExplanation:
    result = analysis.chains[name]
    value = result.value(quantity)
    if result.crosses_messages:
        unbounded = f"the {quantity.replace('_', ' ')} of chains over wires and executors is not bounded"
        reason = "" if value is not None else result.reason or unbounded
        return ChainExplanation(chain=result, quantity=quantity, value=value, route=result.routes[0], reason=reason)
    if value is None or value.value is None:
        reason = result.reason or "no method gives this value"
        return ChainExplanation(chain=result, quantity=quantity, reason=reason)
    context = analysis.solution.context
    for evaluator in _evaluators(context.system.chains[name], analysis):
        for route in evaluator.routes(context.system.chains[name]):
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
        if cases := PhaseCases.of(solution, occurrences):
            yield from (ChainEvaluator(each) for _, each in cases.solutions(cases.of_chain(chain)))
    yield evaluation


@dataclass(frozen=True, slots=True)
class _RouteExplanation:
    """The explanation of a value by one route of a chain.

    Until its place in the whole is known, the times of a hop are in time units and counted from its read.
    """

    evaluator: ChainEvaluator
    route: Route
    quantity: LatencyQuantity
    value: LatencyValue

    @property
    def timing(self) -> StageTiming:
        return self.evaluator.timing

    def hops(self) -> tuple[tuple[ProcessHop, ...], Time] | None:
        """The hops, and the time until the output is overwritten; None if they do not add up to the value."""
        try:
            latencies = self.evaluator.latencies(self.route)
        except UnknownError:
            return None
        if not any(self._is_value(found) for found in latencies.values()):
            return None
        steps, overwritten = self._steps(latencies)
        total = sum(step.wait + step.run for step in steps) + overwritten
        if not steps or self._picoseconds(total) != self.value.value:
            return None
        return self._placed(steps), self._picoseconds(total) - self._picoseconds(total - overwritten)

    def _is_value(self, found: LatencyValue) -> bool:
        # The value of all phases is that of one of them, and its method is named after that.
        same = (found.quantity, found.value) == (self.quantity, self.value.value)
        return same and self.value.method.startswith(found.method)

    def _steps(self, latencies: RouteLatencies) -> tuple[list[ProcessHop], Time]:
        groups = self.evaluator.groups(self.route)
        if self.value.source != job_chains.SOURCE:
            return self._of_bound([timed for part in latencies.parts for timed in part], groups), 0
        found: list[ProcessHop] = []
        overwritten = 0
        for number, part in enumerate(latencies.parts):
            here, groups = groups[: len(part)], groups[len(part) :]
            path = worst_path(part, self._of_part(number, len(latencies.parts)))
            if path is None:
                return [], 0
            steps = self._of_jobs(path, here, part)
            late = (*cause(CauseKind.JUST_MISSED, overwritten), *steps[0].wait_causes)
            found += [replace(steps[0], wait=steps[0].wait + overwritten, wait_causes=late), *steps[1:]]
            overwritten = path.overwritten
        return found, overwritten

    def _of_part(self, number: int, count: int) -> LatencyQuantity:
        """The quantity of the part of the chain on one controller: data from another one arrive just after a read at worst."""
        if self.quantity.is_reaction:
            return self.quantity if number == 0 else LatencyQuantity.MAX_REACTION_TIME
        return self.quantity if number == count - 1 else LatencyQuantity.MAX_DATA_AGE

    # By job chains

    def _of_jobs(self, path: JobPath, groups: Sequence[Sequence[Stage]], part: Sequence[TimedStage]) -> list[ProcessHop]:
        found: list[ProcessHop] = []
        previous = path.begin
        for job, times, group, timed in zip(path.jobs, path.times, groups, part, strict=True):
            release = int(times.releases[job])
            # A writer that preempts its reader has written before that reads, however early it could.
            read = max(int(times.reads[job]), previous)
            # What passes on to a later job of the same process can do so before the bound of the read.
            write = max(int(times.writes[job]), read)
            name = group[0].process.name
            number = self._number(group[0], release)
            start = self._start(name, number)
            step, *triggered = self._with_triggered(
                ProcessHop(
                    process=name,
                    wait=read - previous,
                    run=write - read,
                    job=number,
                    release=release - read,
                    start=None if start is None else start - read,
                    period=timed.task.period,
                    one_in=(group[0].counter or ALWAYS).prescaler,
                ),
                group,
            )
            reasons = HopReasons(self.timing, group[0], timed, number)
            wait, run, executed = reasons.of_job(previous, release, read, read + step.run)
            if not found and step.wait:
                wait = cause(CauseKind.JUST_MISSED, step.wait)
            found += [replace(step, wait_causes=wait, run_causes=run, executions=executed), *triggered]
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
        found = self.timing.solution.schedule(scheduled.core)
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

    def _with_triggered(self, step: ProcessHop, group: Sequence[Stage]) -> list[ProcessHop]:
        """A step, and those of the processes that it triggers, which add the same time to every job."""
        parts = [self.timing.group(group[:count], None).task.response for count in range(1, len(group) + 1)]
        delays = [more - less for less, more in pairwise(parts)]
        if step.run < sum(delays):
            return [step]
        triggered = [
            ProcessHop(process=stage.process.name, wait=0, run=delay, run_causes=cause(CauseKind.TRIGGERED, delay))
            for stage, delay in zip(group[1:], delays, strict=True)
        ]
        return [replace(step, run=step.run - sum(delays)), *triggered]

    # By a bound

    def _of_bound(self, timed: Sequence[TimedStage], groups: Sequence[Sequence[Stage]]) -> list[ProcessHop]:
        table = bounds.REDUCED_DATA_AGE if self.quantity is LatencyQuantity.MAX_REDUCED_DATA_AGE else bounds.REACTION_TIME
        of_method = next((table[source] for source in table if self.value.source.startswith(source)), None)
        if of_method is None:
            return []
        found: list[ProcessHop] = []
        for term, group, each in zip(of_method([each.task for each in timed]) or (), groups, timed, strict=True):
            is_reduced = self.quantity is LatencyQuantity.MAX_REDUCED_REACTION_TIME and not found
            step, *triggered = self._with_triggered(
                ProcessHop(
                    process=group[0].process.name,
                    wait=0 if is_reduced else term.wait,
                    run=term.run,
                    period=each.task.period if each.task.is_regular else None,
                    one_in=(group[0].counter or ALWAYS).prescaler,
                ),
                group,
            )
            waits = CauseKind.FULL_PERIOD if step.wait == each.task.period else CauseKind.NEXT_JOB
            runs = CauseKind.LOGICAL if each.is_logical else CauseKind.RESPONSE
            found += [replace(step, wait_causes=cause(waits, step.wait), run_causes=cause(runs, step.run)), *triggered]
        return found

    # Times

    def _picoseconds(self, time: Time) -> Time:
        return -(-time // self.timing.unit)

    def _placed(self, steps: Sequence[ProcessHop]) -> tuple[ProcessHop, ...]:
        """The hops in picoseconds; as all times are rounded from the beginning, waits and runs still add up."""
        found = []
        now, origin = 0, self._picoseconds(steps[0].wait)

        def placed(time: Time) -> Time:
            return self._picoseconds(time) - origin

        for step in steps:
            read, write = now + step.wait, now + step.wait + step.run
            found.append(
                replace(
                    step,
                    release=None if step.release is None else placed(read + step.release),
                    start=None if step.start is None else placed(read + step.start),
                    read=placed(read),
                    write=placed(write),
                    wait=placed(read) - placed(now),
                    run=placed(write) - placed(read),
                    core=self._core(step.process),
                    period=None if step.period is None else self._picoseconds(step.period),
                    wait_causes=self._rounded(step.wait_causes, now),
                    run_causes=self._rounded(step.run_causes, read),
                    executions=tuple(
                        replace(each, begin=placed(read + each.begin), end=placed(read + each.end)) for each in step.executions
                    ),
                )
            )
            now = write
        return tuple(found)

    def _core(self, process: str) -> str | None:
        scheduled = self.evaluator.context.scheduled.get(process)
        return None if scheduled is None else scheduled.core

    def _rounded(self, causes: Sequence[LatencyCause], begin: Time) -> tuple[LatencyCause, ...]:
        """Causes in picoseconds, which add up to the time from the beginning of the first to the end of the last one."""
        ends = [self._picoseconds(end) for end in accumulate((each.time for each in causes), initial=begin)]
        return tuple(replace(each, time=end - start) for each, (start, end) in zip(causes, pairwise(ends), strict=True))
