"""Judges designs: each by the full analysis of its system."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.analyze.results.analysis import Analysis, Judged
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.optimize.designs import Designs
from amalthea_uros.design.optimize.goals import GoalScale, constraints_of, value_of
from amalthea_uros.design.optimize.lower_bounds import SampledChain
from amalthea_uros.design.optimize.problem import DesignEvaluation, Feasibility, Goal
from amalthea_uros.design.optimize.quantities import FROM_ARRIVAL, Figures, Limit, Range, takers
from amalthea_uros.design.optimize.space import Candidate
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.perf.system import System
from amalthea_uros.timing.response import Claim

#: No less than the reduced reaction time.
_AT_LEAST_REACTION = (LatencyQuantity.MAX_REDUCED_REACTION_TIME, LatencyQuantity.MAX_REACTION_TIME, FROM_ARRIVAL)
_OF_MODEL = {Schedulable.YES: Feasibility.YES, Schedulable.NO: Feasibility.NO, Schedulable.UNKNOWN: Feasibility.UNKNOWN}
#: A share is exceeded by so many picoseconds per second.
_SECOND = 10**12


@dataclass(frozen=True, slots=True, kw_only=True)
class DesignEvaluator:
    """An evaluator that depends on nothing but its fields and the candidates, so that it can be sent to other processes.

    Attributes
    ----------
    limits : beside those of the model
    chains : those of which there are lower bounds
    """

    designs: Designs
    limits: tuple[Limit, ...]
    chains: Mapping[str, SampledChain] = field(default_factory=dict)
    goals: tuple[Goal, ...]
    scale: GoalScale

    def __call__(self, candidates: Iterable[Candidate]) -> Iterator[DesignEvaluation]:
        """Judge designs one after the other; only those that are asked for."""
        return map(self.evaluate, candidates)

    def evaluate(self, candidate: Candidate) -> DesignEvaluation:
        """Judge a design."""
        try:
            configuration = self.designs.configure(candidate)
        except InvalidArgumentError as error:
            return DesignEvaluation(candidate=candidate, feasible=Feasibility.NO, reason=str(error))
        if rule := self.designs.broken_rule(candidate, configuration.system):
            return DesignEvaluation(candidate=candidate, feasible=Feasibility.NO, broken_rule=rule)
        if not self._is_rebuilt(candidate) and (exceeded := dict(self._exceeded(configuration.system))):
            return DesignEvaluation(candidate=candidate, feasible=Feasibility.NO, violations=exceeded, is_excluded=True)
        try:
            analysis = analyze_system(*configuration)
        except InvalidArgumentError as error:
            return DesignEvaluation(candidate=candidate, feasible=Feasibility.NO, reason=str(error))
        return self.judged(candidate, analysis)

    def _exceeded(self, system: System) -> Iterator[tuple[str, int]]:
        """The limits of latencies that lower bounds exceed, and by how much at least."""
        for limit in (*self.limits, *constraints_of(system)):
            chain = self.chains.get(limit.object)
            if chain is not None and limit.quantity in _AT_LEAST_REACTION:
                bound = chain.shortest_maximum(system)
                if bound is not None and bound > limit.maximum:
                    yield limit.target, int(bound - limit.maximum)

    def judged(self, candidate: Candidate, analysis: Analysis) -> DesignEvaluation:
        """The evaluation of a design by its analysis."""
        scale = replace(self.scale, figures=self.figures(candidate, analysis))
        ranges = {limit: limit.range(analysis, scale.figures) for limit in self.limits}
        return DesignEvaluation(
            candidate=candidate,
            feasible=feasibility(analysis, ranges),
            violations=dict(_violations(analysis, ranges)),
            values=tuple(value_of(goal, analysis, candidate, scale) for goal in self.goals),
            is_exact=_is_exact(analysis, scale.figures) and all(found.is_exact for found in ranges.values()),
            work=analysis.work,
        )

    def figures(self, candidate: Candidate, analysis: Analysis) -> Figures:
        """What finds the quantities of a design: in a system that is built otherwise, others take the messages."""
        return Figures(takers(analysis)) if self._is_rebuilt(candidate) else self.scale.figures

    def _is_rebuilt(self, candidate: Candidate) -> bool:
        return bool(self.designs.divided(candidate)[0])


def feasibility(analysis: Analysis, ranges: Mapping[Limit, Range]) -> Feasibility:
    """Whether everything that the model and the limits demand is met; unknown if nothing is demanded."""
    summary, verdicts = analysis.summary, [limit.verdict(found) for limit, found in ranges.items()]
    if summary.judged or summary.missed or not verdicts:
        verdicts.append(_OF_MODEL[summary.schedulable])
    return next((verdict for verdict in (Feasibility.NO, Feasibility.UNKNOWN) if verdict in verdicts), Feasibility.YES)


def _violations(analysis: Analysis, ranges: Mapping[Limit, Range]) -> Iterator[tuple[str, int | None]]:
    summary = analysis.summary
    for judged in (*summary.failing, *summary.unknown):
        yield _name(judged), None if judged.margin is None else max(0, -judged.margin)
    for core in summary.overloaded:
        yield f"{core.name}.load", int((core.at_least - 1) * _SECOND)
    for limit, found in ranges.items():
        if limit.verdict(found) is not Feasibility.YES:
            yield limit.target, _excess(limit, found)


def _excess(limit: Limit, found: Range) -> int | None:
    if found.upper is None:
        return None
    difference = found.upper - limit.maximum
    return max(1 if limit.is_below else 0, int(difference * _SECOND if isinstance(difference, Fraction) else difference))


def _name(judged: Judged) -> str:
    quantity = getattr(judged, "quantity", "deadline")
    return f"{judged.name}.{quantity}"


def _is_exact(analysis: Analysis, figures: Figures) -> bool:
    """Whether the response times and the latencies from which verdicts follow are exact."""
    responses = all(process.response is not None and process.response.claim is Claim.EXACT for process in analysis.processes)
    requirements = all(each.lower == each.upper for each in analysis.requirements if each.limit is not None)
    chains = (figures.range(analysis, chain.name, LatencyQuantity.MAX_REDUCED_REACTION_TIME) for chain in analysis.chains)
    return responses and requirements and all(found.is_exact for found in chains)
