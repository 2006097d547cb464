"""The results for a whole system."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros._internal.shown import Shown
from amalthea_uros.analyze.results.chains import ChainResult
from amalthea_uros.analyze.results.processes import CallbackResult, ProcessorResult, ProcessResult, RequirementResult
from amalthea_uros.diagnostics import Finding
from amalthea_uros.judge.summary import Summary, summarize
from amalthea_uros.perf.constraints import LatencyConstraint

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.solution import Solution
    from amalthea_uros.executors.results import ExecutorResult

Judged: TypeAlias = ProcessResult | RequirementResult
SystemSummary: TypeAlias = Summary[Judged, ProcessorResult]


@dataclass(frozen=True, kw_only=True)
class Analysis(Shown):
    """The results for a system.

    Attributes
    ----------
    solution : the response times with their timing context, for explanations and proposals; for unknown phases, any job may take
        what comes from outside
    worst_solutions : for each process the solution of the phase in which its response time is the worst; empty if all are known
    executors : those that spin in loops
    host : the executors of the host
    work : of all phases that were analysed, in jobs; processes and activities count, too
    assumptions : on which the numbers are based
    findings : what the analysis does not take into account
    """

    solution: Solution = field(repr=False, compare=False)

    processors: Results[ProcessorResult]
    processes: Results[ProcessResult]
    callbacks: Results[CallbackResult]
    chains: Results[ChainResult]
    requirements: Results[RequirementResult]
    assumptions: tuple[str, ...]
    findings: tuple[Finding, ...]
    worst_solutions: Mapping[str, Solution] = field(default_factory=dict, repr=False, compare=False)
    executors: Results[ExecutorResult] = field(default_factory=Results)
    host: Results[ExecutorResult] = field(default_factory=Results)
    work: int = field(default=0, repr=False, compare=False)

    def __repr__(self) -> str:
        parts = [counted(len(self.processes), "process"), counted(len(self.chains), "chain")]
        if self.requirements:
            parts.append(counted(len(self.requirements), "requirement"))
        return f"<Analysis of {', '.join(parts)}; schedulable: {self.summary.schedulable}>"

    @cached_property
    def summary(self) -> SystemSummary:
        """Whether everything is met, and what is missed or unknown."""
        return summarize(self.processors, (*self.processes, *self.requirements), self.solution.context)

    @property
    def of_periodic_executors(self) -> tuple[CallbackResult, ...]:
        """The callbacks without those of executors that spin in loops, of which the executors have more to say."""
        looping = {executor.task for executor in self.executors}
        return tuple(callback for callback in self.callbacks if callback.process not in looping)

    @property
    def message_chains(self) -> tuple[ChainResult, ...]:
        """The chains that cross wires, the agent or executors in loops; those with limits first."""
        constraints = self.solution.context.system.constraints.constraints
        limited = {each.chain for each in constraints if isinstance(each, LatencyConstraint)}
        found = (chain for chain in self.chains if chain.crosses_messages)
        return tuple(sorted(found, key=lambda chain: chain.name not in limited))

    def solution_of(self, process: str) -> Solution:
        """The solution that the response time of a process is from."""
        return self.worst_solutions.get(process, self.solution)

    def __getitem__(self, process: str) -> ProcessResult:
        """The result of a process by its name.

        Raises
        ------
        KeyError : there is no such process; the text lists similar names.
        """
        return self.processes[process]


def require_analysis(analysis: Analysis) -> None:
    """Raise a TypeError that says where an analysis comes from, if it is something else."""
    if not isinstance(analysis, Analysis):
        raise TypeError(
            f"expected an Analysis, not {type(analysis).__name__}; analyze(...) makes one of a file, a model or a system"
        )
