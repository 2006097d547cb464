"""Lower bounds of latencies, which hold for any priorities, offsets and execution times: designs beyond a limit need no analysis.

Two reads of a process with period T are somewhere T or more apart. What enters the chain just after the first of them is not read
before the second, so that the time from the moment at which an input can be taken to the response is somewhere at least T. The
first process of the chain takes it at its next read. Where all reads can take an input, that is at most the distance of two reads
later, which is at most its period and its response time together; and a design is only of interest if the response time does not
exceed the deadline.
"""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.chains.evaluator import ChainEvaluator
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import counters, known_releases, nominal_period, response_time_limits
from amalthea_uros.timing.dataflow.stages import Stage
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True, kw_only=True)
class SampledChain:
    """A chain with a single way, as far as its processes are activated by their own periods.

    Attributes
    ----------
    first : takes the input
    source : of a message that the first process takes; "" if it takes the input in all jobs
    others : the later processes that are activated by their own periods
    """

    first: str
    source: str
    others: tuple[str, ...]

    def shortest_maximum(self, system: System) -> Time | None:
        """What the maximum reduced reaction time is at least, if the first process meets its deadline; None if nothing is known."""
        first = known_releases(system.processes[self.first], system)
        periods = [
            found.period for name in self.others if (found := known_releases(system.processes[name], system)) is not None
        ]
        if first is None or not periods:
            return None
        distance = self._distance(system, first.period)
        return None if distance is None else max(0, max(periods) - distance - self._latest_start(system, first.period))

    def _distance(self, system: System, period: Time) -> Time | None:
        """The distance of two jobs that can take an input."""
        if not self.source:
            return period
        found = [(name, counter) for name, counter in counters(system) if name == self.first and counter.source == self.source]
        if all(not counter.is_phase_known and counter.arrivals is None for _, counter in found):
            return period
        intervals = [nominal_period(system.processes[name], counter, system) for name, counter in found]
        known = [interval for interval in intervals if interval is not None]
        return max(known) if len(known) == len(intervals) else None

    def _latest_start(self, system: System, period: Time) -> Time:
        """When a job that meets its deadline starts at the latest."""
        stated = next((each.deadline for each in system.mapping.tasks if each.task == self.first), None)
        return stated or response_time_limits(system).get(self.first, period)


def sampled_chains(analysis: Analysis) -> Mapping[str, SampledChain]:
    """The chains of which there are lower bounds."""
    evaluator = ChainEvaluator(analysis.solution)
    system = analysis.solution.context.system
    return {name: chain for name, each in system.chains.items() if (chain := _sampled(evaluator.stages(each), analysis, name))}


def _sampled(stages: list[Stage], analysis: Analysis, name: str) -> SampledChain | None:
    if not stages or len(analysis.chains[name].routes) != 1 or stages[0].is_triggered or stages[0].counter is None:
        return None
    first = stages[0].process
    others = dict.fromkeys(each.process.name for each in stages[1:] if not each.is_triggered and each.process is not first)
    return SampledChain(first=first.name, source=stages[0].counter.source, others=tuple(others))
