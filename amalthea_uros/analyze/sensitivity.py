"""Sensitivity: by how much execution times can increase before a deadline or requirement is missed.

Worst-case execution times are multiplied by a factor: all of them, or those of one process. Best cases stay as they are, so that each
analysis also covers all smaller factors: with a single execution time, a latency can be longer for a smaller factor, because a job that
starts earlier reads older data. The maximum factor is found by bisection.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros._internal.shown import Shown
from amalthea_uros.analyze.results.analysis import Analysis, require_analysis
from amalthea_uros.analyze.results.processes import RequirementResult
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf.constraints import ChainSynchronization, LatencyConstraint
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import Time

#: Absolute resolution of factors below 1, relative resolution of factors above 1.
RESOLUTION = Fraction(1, 1000)
#: Greater factors are not distinguished.
MAX_FACTOR = 1000


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Sensitivity(Shown):
    """The maximum factors on worst-case execution times with which nothing is missed; None if there is no such factor.

    With a factor above 1, nothing is missed with any execution times up to it.

    Attributes
    ----------
    everything : on all execution times
    processes : on the execution times of one process
    execution_times : the present worst-case execution time of each process; None if it is unknown
    """

    everything: Fraction | None
    processes: Mapping[str, Fraction | None]
    execution_times: Mapping[str, Time | None]

    def longest(self, process: str) -> Time | None:
        """What the worst-case execution time of a process may grow to; None if it is unknown, or nothing is met even now."""
        time, factor = self.execution_times[process], self.processes[process]
        return None if time is None or factor is None else int(time * factor)

    def __repr__(self) -> str:
        factor = "none" if self.everything is None else f"{float(self.everything):.4g}"
        return f"<Sensitivity: maximum factor on all execution times {factor}>"


def sensitivity(analysis: Analysis) -> Sensitivity:
    """The maximum factors; unknown verdicts are ignored."""
    require_analysis(analysis)
    return Sensitivity(
        everything=max_growth(analysis),
        processes={process.name: _max_factor_of(process.name, analysis) for process in analysis.processes},
        execution_times={process.name: process.wcet for process in analysis.processes},
    )


def max_growth(analysis: Analysis) -> Fraction | None:
    """The maximum factor on all worst-case execution times."""
    settings = analysis.solution.context.settings
    return _max_factor(analysis, lambda factor: replace(settings, growth=settings.growth * factor))


def _max_factor_of(name: str, analysis: Analysis) -> Fraction | None:
    settings = analysis.solution.context.settings

    def changed(factor: Fraction) -> Settings:
        return replace(settings, factors={**settings.factors, name: settings.factors.get(name, 1) * factor})

    return _max_factor(analysis, changed)


def _max_factor(analysis: Analysis, changed: Callable[[Fraction], Settings]) -> Fraction | None:
    """The maximum factor with which everything is met.

    Chains take most of the time of an analysis, and seldom decide: if everything is also met with the maximum factor of the system
    without them, that is the one.
    """
    system = analysis.solution.context.system
    without = _without_chains(system)
    demanded = _bounded(analysis)
    of_processes = demanded & _bounded(analyze_system(without, changed(Fraction(1))))

    def holds(system: System, keys: set[Key], factor: Fraction) -> bool:
        found = analysis if factor == 1 else analyze_system(system, changed(factor))
        return not found.summary.overloaded and keys <= _met(found)

    greatest = _greatest(lambda factor: holds(without, of_processes, factor))
    if greatest is None or demanded == of_processes or holds(system, demanded, greatest):
        return greatest
    return _greatest(lambda factor: holds(system, demanded, factor))


def _without_chains(system: System) -> System:
    """The system without its chains, and what is demanded of them."""
    demanded = (
        each for each in system.constraints.constraints if not isinstance(each, LatencyConstraint | ChainSynchronization)
    )
    return replace(
        system,
        events=replace(system.events, chains=()),
        constraints=replace(system.constraints, constraints=tuple(demanded)),
    )


def _bounded(analysis: Analysis) -> set[Key]:
    """What is not unknown for lack of information: a bound beyond a limit must not count as met."""
    processes = {process.name for process in analysis.processes if process.response is not None}
    limits = {_key(limit) for limit in analysis.requirements if limit.value is not None or limit.verdict is not Verdict.UNKNOWN}
    return processes | limits


def _met(analysis: Analysis) -> set[Key]:
    processes = {process.name for process in analysis.processes if process.verdict in (Verdict.MET, None)}
    return processes | {_key(limit) for limit in analysis.requirements if limit.verdict is Verdict.MET}


#: A process, or a limit of a requirement: requirements can have the same name.
Key = str | tuple[str, str, str, bool]


def _key(limit: RequirementResult) -> Key:
    return limit.name, limit.object, limit.quantity, limit.is_upper


def _greatest(holds: Callable[[Fraction], bool]) -> Fraction | None:
    low, high = (1000, 2000) if holds(Fraction(1)) else (0, 1000)
    while low and high * RESOLUTION < MAX_FACTOR and holds(high * RESOLUTION):
        low, high = high, high * 2
    while high - low > max(1, low // 1000):
        middle = (low + high) // 2
        low, high = (middle, high) if holds(middle * RESOLUTION) else (low, middle)
    return low * RESOLUTION if low else None
