"""Proposals for a better design: what may change, what must hold, and the proof of each by a full analysis."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.shown import Shown
from amalthea_uros.analyze.impact import Effect, Impact, ImpactRow, impact
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.changes.apply import Difference
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.description.edit import DescriptionEditor
from amalthea_uros.design.description.origin import ASSUMED, DescriptionOrigin
from amalthea_uros.design.model_attributes.origin import ModelOrigin
from amalthea_uros.design.optimize.choices import Wishes, design_space
from amalthea_uros.design.optimize.designs import Designs
from amalthea_uros.design.optimize.evaluation import DesignEvaluator
from amalthea_uros.design.optimize.goals import GoalScale, goals_of, latency_limits, named_by
from amalthea_uros.design.optimize.lower_bounds import sampled_chains
from amalthea_uros.design.optimize.problem import DesignEvaluation, Feasibility, Problem
from amalthea_uros.design.optimize.quantities import FROM_ARRIVAL, Figures, Limit, Range, check_limit, parse_limit, takers
from amalthea_uros.design.optimize.space import Candidate
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.uros.assemble import Assembly


@dataclass(frozen=True, slots=True, kw_only=True)
class LimitRow:
    """A limit that designs must keep beside those of the model, now and in a proposal."""

    limit: Limit
    before: Range
    after: Range

    @property
    def verdict(self) -> Feasibility:
        """Whether it holds in the proposal."""
        return self.limit.verdict(self.after)


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class DesignProposal(Shown):
    """A design that meets all limits, with its full analysis.

    Attributes
    ----------
    differences : the changed values, before and after
    changes : all that is set, also what follows from the changed values, such as the jobs that take messages; of a description,
        what is written in it
    analysis : of the changed system
    configuration : its system and settings
    impact : what the changes do to all results
    limits : the limits beside those of the model
    """

    evaluation: DesignEvaluation
    differences: tuple[Difference, ...]
    changes: tuple[Change, ...]
    analysis: Analysis
    configuration: Configuration
    impact: Impact
    limits: tuple[LimitRow, ...]

    def __repr__(self) -> str:
        return f"<DesignProposal {'; '.join(map(str, self.differences)) or 'no change'}>"

    @property
    def worse(self) -> tuple[ImpactRow, ...]:
        """The figures that get worse, such as the load."""
        return tuple(row for row in self.impact.rows if row.effect is Effect.WORSE)

    @property
    def options(self) -> tuple[str, ...]:
        """The options with which `amuros analyze` analyses it."""
        return tuple(part for change in self.changes for part in ("--set", str(change)))


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchPlan:
    """A search that can be started.

    Attributes
    ----------
    before : the analysis of the present design
    evaluator : judges the designs of the problem
    source : the text of the description, or the model; None for other systems
    """

    problem: Problem
    before: Analysis
    evaluator: DesignEvaluator
    source: DescriptionOrigin | ModelOrigin | None = None


def plan_search(
    present: Configuration,
    wishes: Wishes,
    assembly: Assembly | None = None,
    source: DescriptionOrigin | ModelOrigin | None = None,
    *,
    limits: Iterable[str | Limit] = (),
    goals: Sequence[str] = (),
    may_be_later: bool = False,
    seed: int = 1,
) -> SearchPlan:
    """Find out what may change of a system.

    Parameters
    ----------
    assembly : of the description of the system; None if it has none
    source : the text of the description, or the model
    limits, goals, may_be_later, seed : as for `optimize`

    Raises
    ------
    InvalidArgumentError : something that is named does not exist, or a value is wrong.
    """
    before = analyze_system(*present)
    figures = Figures(takers(before))
    space, designs = design_space(present, wishes, assembly, source)
    stated = tuple(parse_limit(each) if isinstance(each, str) else each for each in limits)
    for limit in stated:
        check_limit(limit, present.system)
    evaluator = DesignEvaluator(
        designs=designs,
        limits=stated if may_be_later else (*stated, *_not_later(before, figures)),
        chains=sampled_chains(before),
        goals=goals_of(goals, present.system),
        scale=GoalScale(figures=figures, latencies=latency_limits(before, stated, figures)),
    )
    problem = Problem(
        present=present,
        space=space,
        goals=evaluator.goals,
        configure=designs.configure,
        evaluate=evaluator,
        seed=seed,
        named=frozenset([(limit.object, limit.quantity) for limit in evaluator.limits]) | named_by(evaluator.goals),
    )
    return SearchPlan(problem=problem, before=before, evaluator=evaluator, source=source)


def _not_later(before: Analysis, figures: Figures) -> Iterator[Limit]:
    """No chain must answer later than now: a chain that is measured from the job that takes a message gets shorter if messages wait."""
    for chain in before.chains:
        found = figures.range(before, chain.name, FROM_ARRIVAL)
        if found.upper is not None:
            yield Limit(object=chain.name, quantity=FROM_ARRIVAL, maximum=found.upper, reason="not later than now")


def proved_proposal(
    evaluation: DesignEvaluation,
    evaluator: DesignEvaluator,
    before: Analysis,
    source: DescriptionOrigin | ModelOrigin | None = None,
) -> DesignProposal | None:
    """A proposal, proved by a full analysis of its own: of the edited description if there is one, otherwise of the changed system.

    Returns
    -------
    None : no description states the design, or the edited one is another design than the one that was judged.
    """
    designs, candidate = evaluator.designs, evaluation.candidate
    if not isinstance(source, DescriptionOrigin):
        changes = designs.changes(candidate)
        configuration = designs.configure(candidate) if source is None else source.configure(changes)
    else:
        try:
            changes = _in_description(designs, candidate, source)
            configuration = source.configure(changes)
        except InvalidArgumentError:
            return None
    analysis = analyze_system(*configuration)
    if evaluator.judged(candidate, analysis) != evaluation:
        assert isinstance(source, DescriptionOrigin), "a design was judged in two ways"
        return None
    figures = evaluator.figures(candidate, analysis)
    return DesignProposal(
        evaluation=evaluation,
        differences=designs.describe(candidate),
        changes=changes,
        analysis=analysis,
        configuration=configuration,
        impact=impact(before, analysis),
        limits=tuple(
            LimitRow(limit=limit, before=limit.range(before, evaluator.scale.figures), after=limit.range(analysis, figures))
            for limit in evaluator.limits
        ),
    )


def _in_description(designs: Designs, candidate: Candidate, source: DescriptionOrigin) -> tuple[Change, ...]:
    """The changes of a description for a design, with those that no description states.

    Raises
    ------
    InvalidArgumentError : no description states it.
    """
    own, values = designs.divided(candidate)
    stated = designs.described_changes(own)
    assumed = tuple(change for change in values if change.key in ASSUMED)
    others = tuple(change for change in designs.built(own).value_changes(values) if change not in assumed)
    edited = DescriptionEditor(source.edited(stated), source.path).edited(others)
    return (*stated, *source.changes_of((*edited.assignments, *edited.kept)), *assumed)
