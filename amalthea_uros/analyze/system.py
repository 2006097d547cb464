"""The response times, loads and verdicts of a whole system."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

from amalthea_uros.analyze import fixed_priority, non_preemptive, schedule
from amalthea_uros.analyze.arrivals import Arrivals, finer
from amalthea_uros.analyze.blocking import blocking_times, has_sections, last_region, preemption
from amalthea_uros.analyze.cost import Cost
from amalthea_uros.analyze.demand import Demands, UnknownDemandError
from amalthea_uros.analyze.notes import Notes
from amalthea_uros.analyze.placement import Placed, Placement, UnplacedError
from amalthea_uros.analyze.propagation import Propagation, UnknownArrivalsError
from amalthea_uros.analyze.requirements import judge, upper_response_limits
from amalthea_uros.analyze.result import Analysis, ProcessorResult, ProcessResult, Verdict
from amalthea_uros.analyze.task import Claim, Response, Task
from amalthea_uros.perf import stimuli as perf
from amalthea_uros.perf.software import Preemption
from amalthea_uros.perf.software import Task as TaskProcess
from amalthea_uros.perf.system import System
from amalthea_uros.units import Frequency, Time

#: Rounds of propagation; irregularity that still grows then will not stop.
MOST_ROUNDS = 100


def analyze(system: System, frequencies: Mapping[str, Frequency] | None = None, scale: Fraction = Fraction(1)) -> Analysis:
    """The analysis of a system.

    Parameters
    ----------
    frequencies : of cores, instead of what the system says
    scale : factor on all execution times, as if clocks were slower by it
    """
    work = _Analysis(system, dict(frequencies or {}), scale)
    if scale != 1:
        work.notes.assume(f"all execution times are multiplied by {float(scale):g}")
    work.place()
    work.respond()
    work.note_left_out()
    return work.result()


@dataclass(slots=True)
class _Analysis:
    system: System
    frequencies: dict[str, Frequency]
    scale: Fraction
    notes: Notes = field(default_factory=Notes)
    placed: dict[str, Placed] = field(default_factory=dict)
    costs: dict[str, Cost] = field(default_factory=dict)
    arrivals: dict[str, Arrivals] = field(default_factory=dict)
    responses: dict[str, Response] = field(default_factory=dict)
    reasons: dict[str, str] = field(default_factory=dict)

    @property
    def demands(self) -> Demands:
        """The demand of processes."""
        return Demands(self.system, self.notes, self.frequencies, self.scale)

    def give_up(self, name: str, reason: str) -> None:
        """Note that the response time of a process is not known."""
        self.reasons.setdefault(name, reason)

    # Who runs where, and what it costs

    def place(self) -> None:
        """Find core, priority and cost of each process."""
        placement, demands = Placement(self.system, self.notes), self.demands
        for allocation in self.system.mapping.tasks:
            try:
                placed = placement.task(allocation)
                if placed.process.name in self.placed:
                    self.give_up(placed.process.name, "it is allocated more than once")
                self.placed[placed.process.name] = placed
            except UnplacedError as error:
                self.give_up(allocation.task, str(error))
        for isr in self.system.mapping.isrs:
            try:
                self.placed[isr.isr] = placement.isr(isr.isr, isr.controller, isr.priority)
            except UnplacedError as error:
                self.give_up(isr.isr, str(error))
        for name in self.system.processes:
            if name not in self.placed:
                self.give_up(name, "it is not allocated to a scheduler")
        for name, placed in self.placed.items():
            try:
                self.costs[name] = demands.cost(placed.process, placed.core)
            except UnknownDemandError as error:
                self.notes.warning("ANA004", f"the demand of {name!r} is not known: {error}", placed.process)
                self.give_up(name, str(error))

    # Response times

    def respond(self) -> None:
        """Compute all response times, as often as they change the arrivals of others."""
        least = {name: cost.best // self.demands.grains(self.placed[name].core) for name, cost in self.costs.items()}
        propagation = Propagation(self.system, least)
        for _ in range(MOST_ROUNDS):
            before = dict(self.responses)
            self._find_arrivals(propagation)
            for core in self.system.cores:
                self._respond_on(core)
            if self.responses == before:
                return
        for name in self.responses:
            self.give_up(name, "response times and arrivals do not settle")
        self.responses.clear()

    def _find_arrivals(self, propagation: Propagation) -> None:
        self.arrivals = {}
        for name, placed in self.placed.items():
            try:
                self.arrivals[name] = propagation.arrivals(placed.process, self.responses)
            except UnknownArrivalsError as error:
                self.notes.warning("ANA005", f"the arrivals of {name!r} are not known: {error}", placed.process)
                self.give_up(name, str(error))

    def _respond_on(self, core: str) -> None:
        """The response times on one core; a process of which too little is known makes those below it unknown."""
        here = sorted((p for p in self.placed.values() if p.core == core), key=lambda p: p.rank, reverse=True)
        usable: list[Placed] = []
        for placed in here:
            name = placed.process.name
            if name in self.reasons and not (name in self.costs and name in self.arrivals):
                for below in here[len(usable) + 1 :]:
                    self.give_up(below.process.name, f"too little is known of {name!r}, which comes before it")
                break
            usable.append(placed)
        exact = self._exactly(usable) if len(usable) == len(here) else None
        found = exact or self._bounded(usable, here)
        grains = self.demands.grains(core)
        for placed, response in zip(usable, found, strict=True):
            self.responses[placed.process.name] = in_picoseconds(response, grains)

    def _exactly(self, here: Sequence[Placed]) -> list[Response] | None:
        """By the schedule, where all releases are known and nobody waits for lower priorities."""
        released = [self._released(placed, rank) for rank, placed in enumerate(reversed(here))]
        known = [task for task in released if task is not None]
        if len(known) < len(released) or not known or len({placed.rank for placed in here}) < len(here):
            return None
        found = schedule.response_times(known)
        if found is not None:
            self.notes.assume("periodic tasks are released at their offsets; where none is stated, at 0")
        return None if found is None else found[::-1]

    def _released(self, placed: Placed, rank: int) -> schedule.Released | None:
        process = placed.process
        stimuli = [self.system.stimuli_by_name.get(name) for name in process.stimuli]
        if isinstance(process, TaskProcess) and process.preemption is not Preemption.PREEMPTIVE:
            return None
        match stimuli:
            case [perf.Periodic(jitter=None, condition=None, period=period, offset=offset)] if period > 0 <= offset:
                if has_sections(placed, self.demands):
                    return None
                grains = self.demands.grains(placed.core)
                return schedule.Released(
                    name=process.name,
                    period=period * grains,
                    offset=offset * grains,
                    cost=self.costs[process.name],
                    priority=rank,
                )
        return None

    def _bounded(self, usable: Sequence[Placed], here: Sequence[Placed]) -> list[Response]:
        """By busy windows; who comes lower may block, if its demand is known."""
        ranks = sorted({placed.rank for placed in usable})
        tasks = [
            Task(
                name=placed.process.name,
                arrivals=finer(self.arrivals[placed.process.name], self.demands.grains(placed.core)),
                cost=self.costs[placed.process.name],
                priority=ranks.index(placed.rank),
            )
            for placed in usable
        ]
        known = [placed for placed in here if placed.process.name in self.costs]
        blocking = blocking_times(known, self.demands, self.notes)
        self.notes.assume("where not all releases on a core are known, all of them may come together at the worst moment")
        self.notes.assume("best cases there hold once all tasks have been released")
        found = fixed_priority.response_times(tasks, [blocking[task.name] for task in tasks])
        for index, placed in enumerate(usable):
            if preemption(placed) is not Preemption.PREEMPTIVE:
                found[index] = self._to_the_last_region(index, usable, tasks, blocking)
        # The methods are exact for arrivals that do not know of each other; offsets may keep the worst moment from coming.
        return [replace(response, claim=Claim.BOUND) for response in found]

    def _to_the_last_region(
        self, index: int, here: Sequence[Placed], tasks: Sequence[Task], blocking: Mapping[str, Time]
    ) -> Response:
        """The response time of a task that is not interrupted in its last region, or only by some."""
        placed, task = here[index], tasks[index]
        is_cooperative = preemption(placed) is Preemption.COOPERATIVE
        if is_cooperative:
            self.notes.assume("cooperative tasks are interrupted by preemptive ones at once, by others between runnables")
        higher = [other for other in tasks if other is not task and other.priority >= task.priority]
        always = [
            tasks[number]
            for number, other in enumerate(here)
            if tasks[number].priority > task.priority
            and (other.is_isr or (is_cooperative and preemption(other) is not Preemption.COOPERATIVE))
        ]
        last = last_region(placed, self.demands)
        return non_preemptive.response_time(task, higher, blocking[task.name], 1, last, always)

    # What is left out

    def note_left_out(self) -> None:
        """Note what the system has and the analysis does not take into account."""
        costs = {overhead.name: overhead for overhead in self.system.os.overheads}
        for operating_system in self.system.os.systems:
            if operating_system.overhead in costs:
                message = f"the overheads of {operating_system.name!r} are not taken into account"
                self.notes.warning("ANA006", message, costs[operating_system.overhead])
        for scheduler in self.system.schedulers.values():
            if scheduler.overhead:
                message = f"the cost of scheduling decisions of {scheduler.name!r} is not taken into account"
                self.notes.warning("ANA006", message, scheduler)
        for name, response in self.responses.items():
            process = self.placed[name].process
            if not isinstance(process, TaskProcess) or response.worst is None:
                continue
            jobs = self.arrivals[name].most(response.worst)
            if jobs > process.activation_limit:
                limit = process.activation_limit
                message = f"{name!r} can be activated {jobs} times before it ends; more than {limit} at a time are lost"
                self.notes.warning("ANA007", message, process)

    # Results

    def result(self) -> Analysis:
        """Everything together, processes in the order of the model."""
        limits = upper_response_limits(self.system)
        processes = tuple(self._process(name, limits) for name in self.system.processes)
        if any(constraint for constraint in self.system.events.chains):
            self.notes.assume("event chains and their latencies are not judged here")
        return Analysis(
            processors=tuple(self._processors()),
            processes=processes,
            requirements=tuple(judge(self.system, {process.name: process for process in processes})),
            assumptions=tuple(self.notes.assumptions),
            findings=tuple(self.notes.found),
        )

    def _process(self, name: str, limits: Mapping[str, Time]) -> ProcessResult:
        placed, cost = self.placed.get(name), self.costs.get(name)
        response = self.responses.get(name)
        deadline = placed.deadline if placed is not None and placed.deadline is not None else limits.get(name)
        process = self.system.processes[name]
        grains = self.demands.grains(placed.core) if placed else 1
        return ProcessResult(
            name=name,
            is_isr=not isinstance(process, TaskProcess),
            processor=placed.core if placed else None,
            priority=placed.priority if placed else None,
            preemption=str(process.preemption) if isinstance(process, TaskProcess) else str(Preemption.PREEMPTIVE),
            bcet=cost.best // grains if cost else None,
            acet=cost.mean / grains if cost else None,
            wcet=-(-cost.worst // grains) if cost else None,
            response=response,
            deadline=deadline,
            verdict=_verdict(response, deadline),
            reason=(response.reason if response is not None else self.reasons.get(name, "")),
        )

    def _processors(self) -> Iterator[ProcessorResult]:
        for core in self.system.cores:
            here = [name for name, placed in self.placed.items() if placed.core == core]
            known = [name for name in here if name in self.costs and name in self.arrivals]
            rates = {name: self.arrivals[name].rate / self.demands.grains(core) for name in known}
            is_known = len(known) == len(here)
            yield ProcessorResult(
                name=core,
                frequency=self.demands.frequency(core),
                best=_sum(self.costs[n].mean_best * rates[n] for n in known) if is_known else None,
                mean=_sum(self.costs[n].mean * rates[n] for n in known) if is_known else None,
                worst=_sum(self.costs[n].mean_worst * rates[n] for n in known) if is_known else None,
            )


def _sum(values: Iterator[Fraction]) -> Fraction:
    return sum(values, Fraction(0))


def _verdict(response: Response | None, deadline: Time | None) -> Verdict:
    if response is None:
        return Verdict.UNKNOWN
    if response.worst is None:
        return Verdict.UNBOUNDED
    if deadline is None:
        return Verdict.UNKNOWN
    return Verdict.MET if response.worst <= deadline else Verdict.MISSED


def in_picoseconds(response: Response, grains: int) -> Response:
    """A response time that was computed in grains; the greatest values rounded up, the least ones down."""
    if grains == 1:
        return response
    worst = None if response.worst is None else -(-response.worst // grains)
    terms = {name: -(-value // grains) for name, value in response.terms.items()}
    if worst is not None and "interference" in terms:
        # What rounding adds to the terms is taken from the greatest kind of them, so that they still add up.
        terms["interference"] += worst - sum(terms.values())
    return replace(
        response,
        worst=worst,
        best=response.best // grains,
        window=-(-response.window // grains),
        completions=tuple(-(-end // grains) for end in response.completions),
        terms=terms,
    )
