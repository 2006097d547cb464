"""The response times of the processes of one core, by the method that fits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from amalthea_uros.analyze import fixed_priority, non_preemptive, schedule
from amalthea_uros.analyze.arrivals import finer
from amalthea_uros.analyze.blocking import blocking_times, has_sections, last_region, preemption
from amalthea_uros.analyze.known import Known
from amalthea_uros.analyze.placement import Placed
from amalthea_uros.analyze.task import Claim, Response, Task
from amalthea_uros.perf.software import Preemption
from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.units import Time


def responses_on(core: str, known: Known) -> dict[str, Response]:
    """The response times on a core, in picoseconds, as far as they can be known."""
    here = known.on_core(core)
    usable = known.usable(here, core)
    analysis = _Core(known, core)
    found = analysis.exact(usable) if len(usable) == len(here) else None
    if found is None:
        found = analysis.bounds(usable, here)
    responses = (in_picoseconds(response, known.demands.grains(core)) for response in found)
    return {placed.process.name: response for placed, response in zip(usable, responses, strict=True)}


@dataclass(frozen=True, slots=True)
class _Core:
    known: Known
    core: str

    @property
    def grains(self) -> int:
        """Parts of a picosecond in which everything here is counted."""
        return self.known.demands.grains(self.core)

    def exact(self, here: Sequence[Placed]) -> list[Response] | None:
        """By the schedule, where all releases are known and nobody waits for lower priorities."""
        released = [self._released(placed, rank) for rank, placed in enumerate(reversed(here))]
        tasks = [task for task in released if task is not None]
        if len(tasks) < len(released) or not tasks or len({placed.rank for placed in here}) < len(here):
            return None
        found = schedule.response_times(tasks)
        if found is None:
            return None
        self.known.notes.assume("periodic tasks are released at their offsets; where none is stated, at 0")
        return found[::-1]

    def _released(self, placed: Placed, rank: int) -> schedule.Released | None:
        """A process whose releases are all known, and that neither holds up others nor waits for them; None if it is none."""
        process = placed.process
        if preemption(placed) is not Preemption.PREEMPTIVE or has_sections(placed, self.known.demands):
            return None
        match [self.known.system.stimuli_by_name.get(name) for name in process.stimuli]:
            case [Periodic(jitter=None, condition=None, period=period, offset=offset)] if period > 0 <= offset:
                return schedule.Released(
                    name=process.name,
                    period=period * self.grains,
                    offset=offset * self.grains,
                    cost=self.known.costs[process.name],
                    priority=rank,
                )
        return None

    def bounds(self, usable: Sequence[Placed], here: Sequence[Placed]) -> list[Response]:
        """By busy windows; who comes lower may block, if its demand is known."""
        known = self.known
        ranks = sorted({placed.rank for placed in usable})
        tasks = [
            Task(
                name=placed.process.name,
                arrivals=finer(known.arrivals[placed.process.name], self.grains),
                cost=known.costs[placed.process.name],
                priority=ranks.index(placed.rank),
            )
            for placed in usable
        ]
        blocking = blocking_times([p for p in here if p.process.name in known.costs], known.demands, known.notes)
        if tasks:
            known.notes.assume("where not all releases on a core are known, all of them may come together at the worst moment")
            known.notes.assume("best cases there hold once all tasks have been released")
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
            sentence = "cooperative tasks are interrupted by preemptive ones at once, by others between runnables"
            self.known.notes.assume(sentence)
        higher = [other for other in tasks if other is not task and other.priority >= task.priority]
        always = [
            tasks[number]
            for number, other in enumerate(here)
            if tasks[number].priority > task.priority
            and (other.is_isr or (is_cooperative and preemption(other) is not Preemption.COOPERATIVE))
        ]
        last = last_region(placed, self.known.demands)
        return non_preemptive.response_time(task, higher, blocking[task.name], 1, last, always)


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
