"""The one answer of an analysis: what its verdict depends on most, and which change would help."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.explanations.chains import explain_chain
from amalthea_uros.analyze.explanations.processes import explain_process
from amalthea_uros.analyze.results.analysis import Analysis, Judged
from amalthea_uros.analyze.results.chains import LIMITED, ChainResult
from amalthea_uros.analyze.results.explanations import ChainExplanation, ProcessExplanation
from amalthea_uros.analyze.results.processes import ProcessorResult, ProcessResult, RequirementResult
from amalthea_uros.judge.summary import urgency
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.services.analyze import AnalysisResult

if TYPE_CHECKING:
    from amalthea_uros.design.improvements import Improvement, Improvements

#: What an answer is about: an overloaded core, or what was judged.
Decisive: TypeAlias = ProcessorResult | ProcessResult | RequirementResult

#: Each change is analysed: in larger systems that takes longer than all the rest.
MOST_RUNNABLES, MOST_PROCESSES = 300, 100


@dataclass(frozen=True, slots=True, kw_only=True)
class FirstAnswer:
    """The object that the verdict depends on.

    Attributes
    ----------
    item : what is missed or not proved first, or closest to its limit
    chain : whose latency that is; None for others
    shares : of the processes of an overloaded core, the largest first
    is_wire : whether an overloaded core stands for a wire
    explanation : of the latency or response time; None if there is none
    improvements : None if nothing was tried: the limit is met, is not that of a latency, or the system is large
    """

    item: Decisive
    chain: ChainResult | None = None
    shares: tuple[tuple[str, Fraction], ...] = ()
    is_wire: bool = False
    explanation: ChainExplanation | ProcessExplanation | None = None
    improvements: Improvements | None = None

    @property
    def best(self) -> Improvement | None:
        """The change to recommend: safe, and if possible enough to meet the limits."""
        return None if self.improvements is None else self.improvements.recommended


def first_answer(result: AnalysisResult) -> FirstAnswer | None:
    """The answer of an analysis; None if nothing was judged."""
    item = decisive(result.analysis)
    return None if item is None else answer_about(result, item)


def answer_about(result: AnalysisResult, item: Decisive, *, with_changes: bool = True) -> FirstAnswer:
    """The answer about one limit or core.

    Parameters
    ----------
    with_changes : whether changes are tried if a limit of a latency is not met
    """
    analysis = result.analysis
    if isinstance(item, ProcessorResult):
        shares = [(each.name, each.share) for each in analysis.processes if each.processor == item.name and each.share]
        is_wire = any(item.name in wire.cores for wire in result.system.network.wires)
        return FirstAnswer(item=item, shares=tuple(sorted(shares, key=lambda each: -each[1])), is_wire=is_wire)
    if isinstance(item, ProcessResult):
        return FirstAnswer(item=item, explanation=explain_process(analysis, item.name))
    quantity = LIMITED.get(item.quantity)
    if quantity is None or item.object not in result.system.chains or not item.is_upper:
        return FirstAnswer(item=item, chain=_chain(analysis, item))
    explanation = explain_chain(analysis, item.object, quantity)
    is_tried = with_changes and item.verdict is not Verdict.MET and is_small(result)
    improved = None
    if is_tried:
        from amalthea_uros.services.explain import improvements

        improved = improvements(result, item.object, quantity)
    return FirstAnswer(item=item, chain=_chain(analysis, item), explanation=explanation, improvements=improved)


def is_small(result: AnalysisResult) -> bool:
    """Whether a system is so small that changes can be tried unasked."""
    return len(result.system.software.runnables) <= MOST_RUNNABLES and len(result.system.processes) <= MOST_PROCESSES


def decisive(analysis: Analysis) -> Decisive | None:
    """The limit that is missed, or else not proved, or else closest to its limit.

    An overloaded core comes before all that follows from it, then latencies of chains, as people ask for these.
    """
    summary = analysis.summary
    if summary.causes:
        roots = [cause.root for cause in summary.causes]
        overloaded = [each for each in roots if isinstance(each, ProcessorResult)]
        overloaded += [analysis.processors[core] for root in roots if (core := _core_of(root, analysis)) is not None]
        latency = _latency(each for each in roots if isinstance(each, RequirementResult))
        return next(iter(overloaded), None) or latency or roots[0]
    unknown = summary.unexplained or summary.unknown
    if unknown:
        latency = _latency(each for each in unknown if isinstance(each, RequirementResult))
        return latency or min(unknown, key=urgency)
    return summary.tightest


def _core_of(root: Decisive, analysis: Analysis) -> str | None:
    """The overloaded core because of which a process fails."""
    core = root.overloaded_core if isinstance(root, ProcessResult) else None
    return core if core is not None and analysis.processors[core].is_overloaded else None


def _latency(items: Iterable[RequirementResult]) -> RequirementResult | None:
    """The most urgent limit of a latency."""
    return min((each for each in items if each.quantity in LIMITED), key=urgency, default=None)


def _chain(analysis: Analysis, item: Judged) -> ChainResult | None:
    return analysis.chains[item.object] if item.object in analysis.chains.names else None
