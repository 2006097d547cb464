"""What occurs in plays of a model, whatever the reading of what is open."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from random import Random

from opponent.models.chains import Chain, Event, Reading, chains_of, latencies, readings
from opponent.models.constraints import Constraint, Play
from opponent.models.player import Job, Player, play
from opponent.models.reading import Played, Process, read
from opponent.models.variants import Choices, items_of, variants_of

#: What is measured: its kind ("process", "jitter", "chain", "delay", "constraint"), of what, and the quantity.
Key = tuple[str, str, str]

#: Plays under each reading, and readings.
PLAYS, MOST_VARIANTS = 4, 8


@dataclass(slots=True)
class Extremes:
    """The greatest and the least value of each quantity."""

    greatest: dict[Key, int] = field(default_factory=dict)
    least: dict[Key, int] = field(default_factory=dict)

    def add(self, key: Key, value: int) -> None:
        """One more value."""
        self.at_least(key, value)
        self.least[key] = min(value, self.least.get(key, value))

    def at_least(self, key: Key, value: int) -> None:
        """One more value that is not complete."""
        self.greatest[key] = max(value, self.greatest.get(key, value))


@dataclass(frozen=True, slots=True, kw_only=True)
class Facts:
    """What occurs under every reading.

    Attributes
    ----------
    greatest, least : the least of the maxima under all readings, and the greatest of the minima
    spread : the least and the greatest value under any reading
    loose : the least and the greatest value in any way to read a constraint, and up to the end of a play; None: no complete one
    lost : processes of which activations were beyond a limit in some play
    is_complete : whether all readings were played
    determined : what has no other extremes, however the model is read
    """

    played: Played
    chains: tuple[Chain, ...]
    delays: tuple[tuple[Event, Event], ...]
    greatest: dict[Key, int]
    least: dict[Key, int]
    spread: dict[Key, tuple[int, int]]
    loose: dict[Key, tuple[int | None, int]]
    constraints: tuple[Constraint, ...]
    lost: frozenset[str]
    is_complete: bool
    determined: frozenset[Key] = frozenset()


def horizon(played: Played) -> int:
    """How long a model is played: some of its greatest periods."""
    given = [value for stimulus in played.stimuli.values() for value in stimulus.given.values() if isinstance(value, int)]
    given += [stimulus.given["distance"][1] for stimulus in played.stimuli.values() if "distance" in stimulus.given]
    return 12 * max(given, default=10**9) + 1


def facts_of(
    text: str | bytes,
    delays: Iterable[tuple[Event, Event]] = (),
    constraints: tuple[Constraint, ...] = (),
    *,
    plays: int = PLAYS,
    most: int = MOST_VARIANTS,
    until: int | None = None,
) -> Facts:
    """Play a model under all readings, or some of them."""
    played = read(text)
    chains, pairs = tuple(chains_of(text, played)), tuple(delays)
    end = until or horizon(played)
    variants = variants_of(played)
    chosen = variants if len(variants) <= most else Random(0).sample(variants, most)
    # The quantities of a chain are read in several ways, too: over each of the links of a step.
    results: list[Extremes] = []
    ways: dict[Constraint, list[Extremes]] = {}
    lost: set[str] = set()
    for variant in chosen:
        found = Extremes()
        by_link: dict[tuple[str, Reading], Extremes] = {}
        by_reading: dict[Constraint, dict[int, Extremes]] = {constraint: {} for constraint in constraints}
        for seed in range(plays):
            run = play(played, variant, Choices(seed), end)
            lost.update(process.name for process, count in zip(played.processes, run.lost, strict=True) if count)
            _add(found, played, run, pairs, end)
            for chain in chains:
                for links in readings(chain):
                    extremes = by_link.setdefault((chain.name, links), Extremes())
                    for quantity, value in latencies(played, run, chain, links, end):
                        extremes.add(("chain", chain.name, quantity), value)
            _constrain(by_reading, Play(played, run, end))
        for constraint, each in by_reading.items():
            ways.setdefault(constraint, []).extend(each.values())
            common = under_all([*each.values()])
            found.greatest |= common[0]
            found.least |= common[1]
        for chain in chains:
            common = under_all([e for (name, _), e in by_link.items() if name == chain.name])
            found.greatest |= common[0]
            found.least |= common[1]
        results.append(found)
    greatest, least = under_all(results)
    spread = {key: (min(r.least[key] for r in results), max(r.greatest[key] for r in results)) for key in least}
    loose: dict[Key, tuple[int | None, int]] = dict(spread)
    for constraint, extremes in ways.items():
        key = ("constraint", constraint.name, "")
        complete = [each.least[key] for each in extremes if key in each.least]
        if extremes:
            loose[key] = (min(complete, default=None), max(each.greatest[key] for each in extremes))
    is_fixed = len(chosen) == len(variants) and not lost and not is_random(played) and not has_counters(played)
    several = {("chain", chain.name) for chain in chains if len(list(readings(chain))) > 1 or not chain.is_whole}
    fixed = {key for key, ends in spread.items() if is_fixed and ends == (least[key], greatest[key]) and key[:2] not in several}
    return Facts(
        determined=frozenset(fixed),
        loose=loose,
        constraints=constraints,
        played=played,
        chains=chains,
        delays=pairs,
        greatest=greatest,
        least=least,
        spread=spread,
        lost=frozenset(lost),
        is_complete=len(chosen) == len(variants),
    )


def is_random(played: Played) -> bool:
    """Whether anything is left to chance: times, branches or orders; and the uses of servers, which are not determined either."""
    stimuli, items = played.stimuli.values(), list(items_of(played))
    if played.servers or any(
        s.kind in ("RelativePeriodic", "ArrivalCurve", "VariableRate") or "jitter" in s.given for s in stimuli
    ):
        return True
    if any(item[0] == "chance" or (item[0] == "group" and not item[2]) for item in items):
        return True
    return any(least != most for item in items if item[0] == "execute" for least, most, _ in item[1].values())


def has_counters(played: Played) -> bool:
    """Whether something takes effect only sometimes, so that schedules repeat late."""
    if any(stimulus.counter for stimulus in played.stimuli.values()):
        return True
    return any(item[0] in ("call", "trigger") and item[2] for item in items_of(played))


def under_all(results: list[Extremes]) -> tuple[dict[Key, int], dict[Key, int]]:
    """The least of the maxima and the greatest of the minima, of what occurs in all results."""
    if not results:
        return {}, {}
    common = set.intersection(*(set(r.greatest) & set(r.least) for r in results))
    only_greatest = set.intersection(*(set(r.greatest) for r in results))
    return (
        {key: min(r.greatest[key] for r in results) for key in only_greatest},
        {key: max(r.least[key] for r in results) for key in common},
    )


def _add(found: Extremes, played: Played, run: Player, pairs: Iterable[tuple[Event, Event]], until: int) -> None:
    for process, jobs in zip(played.processes, run.jobs, strict=True):
        for job in jobs:
            if job.end is None:
                found.at_least(("process", process.name, "response_time"), until - job.activated)
        occurred: dict[str, list[int]] = {}
        for quantity, value in metrics(process, jobs):
            found.add(("process", process.name, quantity), value)
            occurred.setdefault(quantity, []).append(value)
        for quantity, values in occurred.items():
            if (jitter := jitter_of(quantity, values, period_of(process, played))) is not None:
                found.at_least(("jitter", process.name, quantity), jitter)
    jobs_of = {process.name: jobs for process, jobs in zip(played.processes, run.jobs, strict=True)}
    for source, target in pairs:
        key = ("delay", f"{source[0]} {source[1]}", f"{target[0]} {target[1]}")
        for value, is_complete in delays(_times(jobs_of[source[0]], source[1]), _times(jobs_of[target[0]], target[1]), until):
            found.greatest[key] = max(value, found.greatest.get(key, value))
            if is_complete:
                found.least[key] = min(value, found.least.get(key, value))


def _constrain(by_reading: dict[Constraint, dict[int, Extremes]], run: Play) -> None:
    """What constraints limit in a play, reading by reading."""
    for constraint, found in by_reading.items():
        for value in constraint.values(run):
            for reading in value.readings:
                extremes = found.setdefault(reading, Extremes())
                add = extremes.add if value.is_complete else extremes.at_least
                add(("constraint", constraint.name, ""), value.value)


def period_of(process: Process, played: Played) -> int | None:
    """The nominal period of a process with one periodic stimulus."""
    stimuli = [played.stimuli[name] for name in process.stimuli]
    if len(stimuli) != 1 or stimuli[0].kind != "Periodic":
        return None
    return int(stimuli[0].given["recurrence"])


def jitter_of(quantity: str, values: list[int], period: int | None) -> int | None:
    """How far values are apart; those from a job to the next one, from the period of the process."""
    if quantity in ("activate_to_activate", "start_to_start", "end_to_end"):
        return None if period is None else max(max(values) - period, period - min(values))
    return max(values) - min(values) if len(values) > 1 else None


def metrics(process: Process, jobs: list[Job]) -> Iterator[tuple[str, int]]:
    """The times of the jobs of a process."""
    for job in jobs:
        if job.start is not None:
            yield "initial_pending_time", job.start - job.activated
        if job.end is not None and job.start is not None:
            yield "response_time", job.end - job.activated
            yield "gross_execution_time", job.end - job.start
            yield "running_time", job.executed
            yield "net_execution_time", job.executed + job.waited
            yield "ready_time", job.end - job.start - job.executed - job.waited
            if process.deadline is not None:
                yield "lateness", job.end - job.activated - process.deadline
    for one, other in pairwise(jobs):
        yield "activate_to_activate", other.activated - one.activated
        if one.start is not None and other.start is not None:
            yield "start_to_start", other.start - one.start
        if one.end is not None and other.start is not None:
            yield "end_to_start", other.start - one.end
        if one.end is not None and other.end is not None:
            yield "end_to_end", other.end - one.end


def _times(jobs: list[Job], event: str) -> list[int]:
    times = ({"activate": job.activated, "start": job.start, "terminate": job.end}[event] for job in jobs)
    return [time for time in times if time is not None]


def delays(sources: list[int], targets: list[int], until: int) -> Iterator[tuple[int, bool]]:
    """From each source event to the next target event at or after it; what has not come by the end of the play takes longer."""
    for source in sources:
        found = bisect_left(targets, source)
        yield (targets[found] - source, True) if found < len(targets) else (until - source, False)
