"""Exact offsets: all vectors of offsets that differ by more than a common shift.

A shift of all releases by the same time is another start of the same schedule. Two vectors are shifts of each other if and only if the
distance of each two offsets is the same modulo the greatest common divisor of the two periods (Chinese remainder theorem), so that
prod(T) / lcm(T) of them differ (J. Goossens, "Scheduling of offset free systems", Real-Time Systems 24, 2003).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from math import gcd, prod
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.optimize.judged import Judged
from amalthea_uros.design.optimize.problem import Problem, SearchResult
from amalthea_uros.design.optimize.quantities import FROM_ARRIVAL, JITTER, LOAD
from amalthea_uros.design.optimize.space import Candidate, Choice, DecisionKind, combinations_of
from amalthea_uros.executors.semantics.loops import timing_context
from amalthea_uros.perf.constraints import LatencyConstraint, TimeLimit, TimeMetric
from amalthea_uros.perf.stimuli import RelativePeriodic
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import known_releases, unknown_phases
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.blocking.critical_sections import LockUsage
from amalthea_uros.timing.scheduling.scheduled import EqualPriority, is_preemptive
from amalthea_uros.units import Time

#: At most so many vectors are compared, and so many judged.
MAX_VECTORS, MAX_DESIGNS = 200_000, 5000

#: Quantities that are the same wherever a schedule starts.
_LASTING = (*LatencyQuantity, FROM_ARRIVAL, JobMetric.RESPONSE_TIME, LOAD)

#: The offsets and periods of processes with known releases.
Releases: TypeAlias = Mapping[str, tuple[Time, Time]]


def solve_offsets(problem: Problem) -> SearchResult | None:
    """The best offsets; None if something else may change, or there are too many."""
    if prod(len(choice.options) for choice in problem.space.choices) > MAX_VECTORS:
        return None
    classes = offset_classes(problem)
    if classes is None or len(classes) > MAX_DESIGNS:
        return None
    judged = Judged(problem)
    judged.judge(designs[0] for designs in classes)
    size = sum(map(len, classes))
    proof = f"all {size} vectors of offsets were judged"
    if len(classes) < size:
        proof = f"each of the {size} vectors of offsets is one of {len(classes)} that were judged, all tasks shifted alike"
    return judged.concluded(proof, excluded=size - len(classes))


def offset_classes(problem: Problem) -> Sequence[Sequence[Candidate]] | None:
    """The designs, grouped by those that are shifts of each other, in each group those with the fewest changes first; None as above."""
    varied = [choice for choice in problem.space.choices if len(choice.options) > 1]
    if not varied or problem.space.orders or any(choice.kind is not DecisionKind.OFFSET for choice in varied):
        return None
    shifts = _Shifts.of(problem, varied) if _can_be_shifted(problem.present) and not _depends_on_start(problem) else None
    classes: dict[object, list[Candidate]] = {}
    for number, design in enumerate(combinations_of(varied)):
        classes.setdefault(number if shifts is None else shifts.key(design), []).append(design)
    return [sorted(designs, key=lambda design: (len(design), tuple(map(str, design)))) for designs in classes.values()]


def _can_be_shifted(configuration: Configuration) -> bool:
    """Whether nothing but the distances of releases depends on the time: no counters, no messages at stated times."""
    system, settings = configuration
    if settings.phases or unknown_phases(system):
        return False
    if any(not _is_shiftable(process, system) for process in system.processes):
        return False
    context = timing_context(system, settings)
    if len(context.demands) < len(system.processes):
        return False
    return all(frame.is_always for demand in context.demands.values() for frame in demand.frames)


def _depends_on_start(problem: Problem) -> bool:
    """Whether something that counts can be another one if the same schedule starts at another time, when nothing is pending.

    Nothing ends later at the start than in the long run if all are preemptive, and latencies of chains are those in the long run. But
    something can end earlier at the start, which has an effect on jitter.
    """
    system, settings = problem.present
    limits = [requirement.limit for requirement in system.constraints.requirements]
    if not all(isinstance(limit, TimeLimit) and limit.metric is TimeMetric.RESPONSE_TIME for limit in limits):
        return True
    if not all(isinstance(constraint, LatencyConstraint) for constraint in system.constraints.constraints):
        return True
    if any(quantity not in _LASTING for _, quantity in problem.named) or any(goal.name == JITTER for goal in problem.goals):
        return True
    context = timing_context(system, settings)
    return not all(
        is_preemptive(item) and item.equal_priority is EqualPriority.FIFO and context.protection[item.name] == LockUsage()
        for item in context.scheduled.values()
    )


def _is_shiftable(process: str, system: System) -> bool:
    model = system.processes[process]
    stimuli = [system.stimuli_by_name.get(name) for name in model.stimuli]
    return known_releases(model, system) is not None or all(isinstance(each, RelativePeriodic) for each in stimuli)


@dataclass(frozen=True, slots=True)
class _Shifts:
    """What designs have in common that are shifts of each other.

    Attributes
    ----------
    effects : the releases that a change sets
    """

    present: Releases
    effects: Mapping[Change, Releases]

    @classmethod
    def of(cls, problem: Problem, choices: Sequence[Choice]) -> _Shifts | None:
        """The effects of each change; None if two choices affect the same releases."""
        present = _releases(problem.present.system)
        effects: dict[Change, Releases] = {}
        affected: set[str] = set()
        for choice in choices:
            own: set[str] = set()
            for option in choice.options[1:]:
                change = Change(choice.object, choice.key, option)
                found = _releases(problem.configure((change,)).system)
                effects[change] = {name: release for name, release in found.items() if release != present.get(name)}
                own |= effects[change].keys()
            if affected & own:
                return None
            affected |= own
        return cls(present, effects)

    def key(self, design: Candidate) -> tuple[Time, ...]:
        """The distances of each two releases, modulo the greatest common divisor of their periods."""
        releases = dict(self.present)
        for change in design:
            releases |= self.effects[change]
        return tuple(
            (other - one) % gcd(period, length) for (one, period), (other, length) in combinations(releases.values(), 2)
        )


def _releases(system: System) -> Releases:
    found = {name: known_releases(process, system) for name, process in system.processes.items()}
    return {name: (stimulus.offset, stimulus.period) for name, stimulus in found.items() if stimulus is not None}
