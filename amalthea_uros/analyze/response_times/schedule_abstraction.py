"""All schedules of non-preemptive jobs whose releases and execution times vary within bounds, on one core or on several alike.

After M. Nasri and B. B. Brandenburg, "An exact and sustainable analysis of non-preemptive scheduling", RTSS 2017, and with G. Nelissen,
"A response-time analysis for non-preemptive job sets under global scheduling", ECRTS 2018. A state is what has been started so far, and
from when until when one core, two cores and so on can become free after it. A job that has not been started can be the next one
if some time is left between the earliest start (a core can be free, and the job released) and the latest one: no later than a core
is certainly free while something is certainly released (the scheduler never waits), and before anything of higher priority is certainly
released. The job then has that core, and the others are free no earlier than it starts.

States that have started the same jobs and can be free at the same times are merged. On one core that loses nothing, and the ends are
exact. On several cores, the times at which each number of them is free need not belong together, so that the ends are bounds.

The jobs never end. A hyperperiod later the same jobs follow, so that nothing new can come once each state of a hyperperiod's end is
within one of an earlier end.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import lcm
from operator import le
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros.timing.basics.time_base import LIMIT
from amalthea_uros.units import Time

#: How many decisions between a job and the cores are examined before the exploration is given up.
MAX_STEPS = 200_000

#: The jobs started before, the last one first: task, latest start, latest end; and those before it.
History: TypeAlias = "tuple[int, Time, Time, History] | None"
#: From when and until when one core, two cores and so on can become free, and the history in which the first does so the latest.
_Free: TypeAlias = tuple[tuple[Time, ...], tuple[Time, ...], History]
#: By the number of jobs that each task has started.
_States: TypeAlias = dict[tuple[int, ...], list[_Free]]


@dataclass(frozen=True, slots=True, kw_only=True)
class JobStream:
    """The jobs of a task.

    Attributes
    ----------
    first : earliest release of the first job; the n-th one after it is released n periods later
    jitter : by which a release can be later, less than the period
    demands : shortest and longest execution time of the first jobs
    lead : number of jobs before the demands repeat
    """

    period: Time
    first: Time = 0
    jitter: Time = 0
    demands: tuple[tuple[Time, Time], ...]
    lead: int = 0

    @property
    def cycle(self) -> int:
        """Number of jobs after which the demands repeat."""
        return len(self.demands) - self.lead

    def demand(self, job: int) -> tuple[Time, Time]:
        """The shortest and longest execution time of a job, counted from 0."""
        return self.demands[job if job < self.lead else self.lead + (job - self.lead) % self.cycle]


@dataclass(slots=True, kw_only=True)
class JobEnds:
    """When the jobs of a task can end.

    Attributes
    ----------
    latest : after the earliest release of the job; exact on one core
    earliest : after the latest release of the job, but no less than a job executes
    jobs : number of jobs examined
    job, history : the job that is the latest, and what was started before it
    """

    latest: Time = -1
    earliest: Time = LIMIT
    jobs: int = 0
    job: int = 0
    history: History = None

    def note(self, job: int, latest: Time, earliest: Time, history: History) -> None:
        """Take a way in which a job can end into account."""
        self.jobs = max(self.jobs, job + 1)
        self.earliest = min(self.earliest, earliest)
        if latest > self.latest:
            self.latest, self.job, self.history = latest, job, history


def explored(streams: Sequence[JobStream], cores: int = 1, max_steps: int = MAX_STEPS) -> Sequence[JobEnds] | None:
    """When the jobs of each task can end, the most important task first; None if that takes more steps."""
    ends = [JobEnds() for _ in streams]
    hyperperiod = lcm(*(stream.period * stream.cycle for stream in streams))
    in_hyperperiod = sum(hyperperiod // stream.period for stream in streams)
    if in_hyperperiod * len(streams) > max_steps:
        return None
    states: _States = {(0,) * len(streams): [((0,) * cores, (0,) * cores, None)]}
    ends_of_hyperperiods: list[_States] = []
    steps = 0
    while True:
        before = _shifted(states, streams, hyperperiod, len(ends_of_hyperperiods))
        is_repeating = all(number >= stream.lead for started in states for number, stream in zip(started, streams, strict=True))
        if is_repeating and any(_is_within(before, earlier) for earlier in ends_of_hyperperiods):
            return ends
        ends_of_hyperperiods.append(before if is_repeating else {})
        for _ in range(in_hyperperiod):
            steps += len(streams) * sum(map(len, states.values()))
            if steps > max_steps:
                return None
            states = _merged(_followers(states, streams, ends))


def _followers(
    states: _States, streams: Sequence[JobStream], ends: Sequence[JobEnds]
) -> Iterator[tuple[tuple[int, ...], _Free]]:
    """The states after each job that can be the next one in a state."""
    for started, intervals in states.items():
        releases = [stream.first + number * stream.period for number, stream in zip(started, streams, strict=True)]
        certain = [release + stream.jitter for release, stream in zip(releases, streams, strict=True)]
        first_certain = min(certain)
        for begins, finishes, history in intervals:
            free, latest = begins[0], max(finishes[0], first_certain)
            for task, release in enumerate(releases):
                start = max(free, release)
                if start <= latest:
                    number = started[task]
                    shortest, longest = streams[task].demand(number)
                    begun = (task, latest, latest + longest, history)
                    on_time = max(shortest, start + shortest - certain[task])
                    ends[task].note(number, latest + longest - release, on_time, begun)
                    after = (*started[:task], number + 1, *started[task + 1 :])
                    yield (
                        after,
                        (_occupied(begins, start, start + shortest), _occupied(finishes, start, latest + longest), begun),
                    )
                # What is less important starts before this is certainly released.
                latest = min(latest, certain[task] - 1)
                if latest < free:
                    break


def _occupied(free: tuple[Time, ...], start: Time, end: Time) -> tuple[Time, ...]:
    """When one core, two cores and so on are free after a job has taken the first of them; no other one is needed before its start."""
    return (end,) if len(free) == 1 else tuple(sorted((end, *(max(start, time) for time in free[1:]))))


def _merged(followers: Iterator[tuple[tuple[int, ...], _Free]]) -> _States:
    """The states, those with the same jobs and common times as one."""
    merged: _States = {}
    for started, free in followers:
        merged.setdefault(started, []).append(free)
    return {started: intervals if len(intervals) == 1 else _united(intervals) for started, intervals in merged.items()}


def _united(intervals: list[_Free]) -> list[_Free]:
    united: list[_Free] = []
    for free in sorted(intervals, key=lambda interval: interval[:2]):
        begins, finishes, history = free
        for index, (other_begins, other_finishes, other_history) in enumerate(united):
            if all(map(le, begins, other_finishes)) and all(map(le, other_begins, finishes)):
                latest = other_history if other_finishes[0] >= finishes[0] else history
                united[index] = (tuple(map(min, begins, other_begins)), tuple(map(max, finishes, other_finishes)), latest)
                break
        else:
            united.append(free)
    return united


def _shifted(states: _States, streams: Sequence[JobStream], hyperperiod: Time, times: int) -> _States:
    """The states some hyperperiods earlier. Cores that are free before anything is released are as free just then."""
    shifted: _States = {}
    for started, intervals in states.items():
        early = tuple(number - times * hyperperiod // stream.period for number, stream in zip(started, streams, strict=True))
        next_release = min(stream.first + number * stream.period for number, stream in zip(early, streams, strict=True))
        shift = times * hyperperiod
        shifted[early] = [
            (
                tuple(max(begin - shift, next_release) for begin in begins),
                tuple(max(end - shift, next_release) for end in finishes),
                None,
            )
            for begins, finishes, _ in intervals
        ]
    return shifted


def _is_within(states: _States, others: _States) -> bool:
    """Whether each state is within another one, so that all that follows it follows that one, too."""
    return all(
        any(all(map(le, other[0], free[0])) and all(map(le, free[1], other[1])) for other in others.get(started, ()))
        for started, intervals in states.items()
        for free in intervals
    )
