"""What occurs in plays of a system, whatever the reading of what is open.

Latencies of a chain are those of Guenzel, Chen, Ueter, Chen (ECRTS 2023). Each job reads once and writes once. The forward job chain of
a job continues with the first job that reads at or after a write, the backward one with the last job that wrote at or before a read.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from math import lcm
from random import Random

from opponent.player import Job, play
from opponent.readings import Readings, readings_of
from opponent.systems import PlainSystem, has_open_choices, items_of


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


# Plays under all readings.


@dataclass(frozen=True, slots=True)
class Horizon:
    """Where the steady state begins, after which time it repeats if nothing is left to chance, and where the last activations are.

    Whatever happens before the last activations is as if they went on for ever.
    """

    begin: int
    pattern: int
    end: int

    @classmethod
    def of(cls, system: PlainSystem) -> Horizon:
        """Counters repeat after a common multiple of their prescalers, and come into effect at their offsets."""
        arrivals = [given for process in system["processes"] for given in process["arrival"].values()]
        offsets = [given.get("offset", 0) + given.get("jitter", 0) for given in arrivals if "prescaler" not in given]
        periods = [given.get("period") or given.get("most") or 1 for given in arrivals]
        hyperperiod = lcm(*periods) if lcm(*periods) <= 1000 else max(periods)
        counters = [given for given in (*items_of(system), *arrivals) if "prescaler" in given]
        repetition = min(lcm(*(counter["prescaler"] for counter in counters)), 12)
        start_up = min(max((counter["offset"] for counter in counters), default=0) + 1, 12)
        begin, pattern = max(offsets) + hyperperiod * start_up, hyperperiod * repetition
        return cls(begin, pattern, begin + pattern * (6 if "chain" in system else 3))


@dataclass(slots=True)
class Extremes:
    """Greatest and least values by name, of maxima and minima of the same things."""

    greatest: dict[str, int] = field(default_factory=dict)
    least: dict[str, int] = field(default_factory=dict)

    def add(self, name: str, value: int) -> None:
        """One more value."""
        self.greatest[name] = max(value, self.greatest.get(name, value))
        self.least[name] = min(value, self.least.get(name, value))


@dataclass(frozen=True, slots=True, kw_only=True)
class Observation:
    """Values that occur under every reading.

    Attributes
    ----------
    worst : of each process, the greatest response time found
    best : of each process, the least one in the steady state
    chain : quantities of the chain
    determined : names of processes, and of quantities of the chain, that have no other value, however the system is read
    """

    worst: dict[str, int]
    best: dict[str, int]
    chain: dict[str, int]
    determined: frozenset[str]


@dataclass(slots=True)
class ReadingResult:
    """What occurs under one reading: from start-up on, in the steady state, and of the chain (by its readings) in the steady state."""

    all: Extremes = field(default_factory=Extremes)
    steady: Extremes = field(default_factory=Extremes)
    chains: dict[bool, Extremes] = field(default_factory=dict)
    unsteady: set[str] = field(default_factory=set)

    def add(self, system: PlainSystem, jobs: list[list[Job]], horizon: Horizon) -> None:
        """One more play."""
        for process, of_process in zip(system["processes"], jobs, strict=True):
            name = process["name"]
            halves: list[list[int]] = [[], []]
            for job in of_process:
                if job.end is None or job.end >= horizon.end:
                    continue
                response = job.end - job.release.time
                self.all.add(name, response)
                if job.release.time >= horizon.begin:
                    self.steady.add(name, response)
                    if (half := (job.release.time - horizon.begin) // horizon.pattern) < 2:
                        halves[half].append(response)
            if halves[0] != halves[1] or not halves[0]:
                self.unsteady.add(name)
        for by_periods in _chain_readings(system):
            chain = self.chains.setdefault(by_periods, Extremes())
            for quantity, value in chain_latencies(system, jobs, horizon.begin, horizon.end, by_periods=by_periods):
                chain.add(quantity, value)


def _chain_readings(system: PlainSystem) -> tuple[bool, ...]:
    """Whether the ends of the chain are those of periods: open under LET."""
    if "chain" not in system:
        return ()
    return (False, True) if system["chain"]["communication"] == "LET" else (False,)


def observe(system: PlainSystem, seeds: Iterable[int], most_readings: int | None = None) -> Observation:
    """Play a system under all readings, or at most some of them, with each seed."""
    horizon, results = Horizon.of(system), []
    seeds = list(seeds) if has_open_choices(system) else [0]
    for readings in _chosen(readings_of(system), most_readings):
        result = ReadingResult()
        for seed in seeds:
            result.add(system, play(system, readings, Random(seed), horizon.end), horizon)
        results.append(result)
    return _under_all(results, is_random=has_open_choices(system))


def _chosen(readings: list[Readings], most: int | None) -> list[Readings]:
    return readings if most is None or len(readings) <= most else Random(0).sample(readings, most)


def _under_all(results: list[ReadingResult], *, is_random: bool) -> Observation:
    worst = {name: min(r.all.greatest[name] for r in results) for name in _common([r.all.greatest for r in results])}
    best = {name: max(r.steady.least[name] for r in results) for name in _common([r.steady.least for r in results])}
    chains = [chain for result in results for chain in result.chains.values()]
    by_quantity = {quantity: [_extreme(c, quantity) for c in chains] for quantity in _common([c.greatest for c in chains])}
    chain = {quantity: min(found) if quantity.startswith("max") else max(found) for quantity, found in by_quantity.items()}
    determined = set()
    if not is_random:
        for name in best:
            ends = {(r.all.greatest[name], r.all.least[name]) for r in results}
            ends |= {(r.steady.greatest[name], r.steady.least[name]) for r in results}
            if len(ends) == 1 and not any(name in r.unsteady for r in results):
                determined.add(name)
        if not any(r.unsteady for r in results):
            determined |= {quantity for quantity, found in by_quantity.items() if len(set(found)) == 1}
    return Observation(worst=worst, best=best, chain=chain, determined=frozenset(determined))


def _extreme(found: Extremes, quantity: str) -> int:
    return (found.greatest if quantity.startswith("max") else found.least)[quantity]


def _common(found: list[dict[str, int]]) -> set[str]:
    """The names that occur under every reading."""
    return set.intersection(*map(set, found)) if found else set()
