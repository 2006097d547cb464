"""Searches for a better design, every proposal of which the full analysis proves."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from time import monotonic

from amalthea_uros._internal.shown import Shown
from amalthea_uros.analyze.impact import Effect, Impact, ImpactRow, impact
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.changes.apply import Difference
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.changes.sweep import Sweep, parse_sweep
from amalthea_uros.design.optimize.evaluation import DesignEvaluator
from amalthea_uros.design.optimize.goals import Scale, goals_of, latency_limits, named_by
from amalthea_uros.design.optimize.limits import Limit, check_limit, parse_limit
from amalthea_uros.design.optimize.lower_bounds import sampled_chains
from amalthea_uros.design.optimize.parallel_evaluation import evaluator_on
from amalthea_uros.design.optimize.problem import Evaluation, Feasibility, Goal, Problem, SearchResult
from amalthea_uros.design.optimize.quantities import FROM_ARRIVAL, Figures, Range, takers
from amalthea_uros.design.optimize.recorder import Effort
from amalthea_uros.design.optimize.search import search
from amalthea_uros.design.optimize.space import Space
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.findings.suppression import unsuppressed
from amalthea_uros.perf.system import System
from amalthea_uros.services.design_space import DEFAULT, Vary, Wishes, design_space
from amalthea_uros.services.names import require_settings
from amalthea_uros.services.subject import Subject, open_subject, paths_of, reusable
from amalthea_uros.timing.basics.settings import Settings

#: So many proposals are shown, unless more are asked for.
MOST_PROPOSALS = 5
#: So many designs are judged, unless more are asked for.
MOST_DESIGNS = 2000


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
    changes : all that is set, also what follows from the changed values, such as the jobs that take messages
    value_changes : those of them that are values of a system
    rebuilt : the system in which they are set, if only a changed description describes it; otherwise None
    analysis : of the changed system
    configuration : its system and settings
    impact : what the changes do to all results
    limits : the limits beside those of the model
    """

    evaluation: Evaluation
    differences: tuple[Difference, ...]
    changes: tuple[Change, ...]
    value_changes: tuple[Change, ...]
    rebuilt: System | None
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
        """The options with which `amuros analyze` analyses it; none for a design that only a description states."""
        return () if self.rebuilt is not None else tuple(part for change in self.changes for part in ("--set", str(change)))


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Optimization(Shown):
    """The outcome of a search for a better design.

    Attributes
    ----------
    space : what was allowed to change
    limits : that designs must keep, beside those of the model
    goals : the first one counts most
    before : the analysis of the present design
    present : the evaluation of the present design
    proposals : the best first, those that were asked for
    search : everything that was found
    """

    subject: Subject = field(compare=False)
    paths: tuple[Path, ...]
    space: Space
    limits: tuple[Limit, ...]
    goals: tuple[Goal, ...]
    before: Analysis
    present: Evaluation
    proposals: tuple[DesignProposal, ...]
    search: SearchResult
    findings: tuple[Finding, ...] = ()
    settings: Settings = field(default_factory=Settings)

    def __repr__(self) -> str:
        return f"<Optimization: {self.search.conclusion}, {len(self.proposals)} proposals of {self.search.tried} designs>"

    def __getitem__(self, number: int) -> DesignProposal:
        """A proposal; 0 is the best one."""
        return self.proposals[number]


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """A search that can be started.

    Attributes
    ----------
    before : the analysis of the present design
    evaluator : judges the designs of the problem
    """

    subject: Subject = field(compare=False)
    problem: Problem
    before: Analysis
    evaluator: DesignEvaluator
    findings: tuple[Finding, ...]


def plan_optimization(
    subject: Subject,
    wishes: Wishes | None = None,
    *,
    limits: Iterable[str | Limit] = (),
    goals: Sequence[str] = (),
    settings: Settings | None = None,
    may_be_later: bool = False,
    seed: int = 1,
) -> Plan:
    """Read what describes a system, and find out what may change; parameters and errors as for `optimize`."""
    subject = reusable(subject)
    opened = open_subject(subject)
    settings = settings or Settings()
    require_settings(settings, opened.system)
    present = Configuration(opened.system, settings)
    before = analyze_system(*present)
    figures = Figures(takers(before))
    space, designs = design_space(subject, opened, present, wishes or Wishes())
    stated = tuple(parse_limit(each) if isinstance(each, str) else each for each in limits)
    for limit in stated:
        check_limit(limit, opened.system)
    evaluator = DesignEvaluator(
        designs=designs,
        limits=stated if may_be_later else (*stated, *_not_later(before, figures)),
        chains=sampled_chains(before),
        goals=goals_of(goals, opened.system),
        scale=Scale(figures=figures, latencies=latency_limits(before, stated, figures)),
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
    findings = unsuppressed((*opened.findings, *before.findings))
    return Plan(subject=subject, problem=problem, before=before, evaluator=evaluator, findings=findings)


def optimize(
    subject: Subject,
    *,
    limits: Iterable[str | Limit] = (),
    goals: Sequence[str] = (),
    vary: Iterable[str | Vary] = DEFAULT,
    offers: Iterable[str | Sweep] = (),
    keep: Iterable[str] = (),
    settings: Settings | None = None,
    is_rate_monotonic: bool = False,
    may_be_later: bool = False,
    is_complete: bool = False,
    designs: int = MOST_DESIGNS,
    proposals: int = MOST_PROPOSALS,
    seed: int = 1,
    time_limit: float | None = None,
    workers: int | None = 1,
    cluster: str | None = None,
    progress: Callable[[int], None] = lambda _tried: None,
) -> Optimization:
    """Search for changes of a system with which all deadlines, requirements and limits are met, and then for the best ones.

    >>> optimize("app.yaml", limits=["factor-to-output.max_reduced_reaction_time<=11ms"])  # doctest: +SKIP

    Parameters
    ----------
    subject : as for `analyze`
    limits : beside those of the model
    goals : what to minimise: `latency`, `load`, `balance`, `jitter`, `changes` or OBJECT.QUANTITY; by default `changes`
    vary : what may change: `periods` (on offer), `priorities`, `offsets`, `cores`; `callbacks` (in the executor or in tasks of their
        own), `order` (of those in the executor), `communication` (implicit or LET), `memory` (of labels)
    offers : values on offer, such as "Control_Function.offset=0ms..0.9ms/0.1ms"
    keep : objects, or their properties as OBJECT.KEY, that must not change
    is_rate_monotonic : let the priorities follow the periods
    may_be_later : allow that the maximum time from the arrival of a message to the response of a chain gets longer
    is_complete : judge all designs, although some with few changes meet all limits
    designs : judge at most so many
    proposals : return at most so many
    seed : of searches that choose at random
    time_limit : in seconds, after which the search ends with what it has found
    workers : designs judged at the same time on this computer; None: one for each core. The result does not depend on it
    cluster : address of a Dask scheduler, on whose workers designs are judged instead
    progress : told how many designs have been judged

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    InvalidArgumentError : something that is named does not exist, a value is wrong, or the cluster cannot be used.
    """
    wishes = Wishes(
        vary=tuple(map(_vary, vary)),
        offers=tuple(parse_sweep(each) if isinstance(each, str) else each for each in offers),
        keep=tuple(keep),
        is_rate_monotonic=is_rate_monotonic,
    )
    plan = plan_optimization(
        subject, wishes, limits=limits, goals=goals, settings=settings, may_be_later=may_be_later, seed=seed
    )
    effort = Effort(designs=designs, is_complete=is_complete, ended=_clock(time_limit), progress=progress)
    with evaluator_on(plan.evaluator, workers, cluster) as evaluate:
        found = search(replace(plan.problem, evaluate=evaluate), effort)
    return found_by(plan, found, proposals)


def found_by(plan: Plan, found: SearchResult, proposals: int = MOST_PROPOSALS) -> Optimization:
    """The outcome of a search, each proposal proved by a full analysis of its own."""
    problem, evaluator = plan.problem, plan.evaluator
    return Optimization(
        subject=plan.subject,
        paths=paths_of(plan.subject) or (),
        space=problem.space,
        limits=evaluator.limits,
        goals=problem.goals,
        before=plan.before,
        present=evaluator.judged((), plan.before),
        proposals=tuple(_proposal(each, evaluator, plan.before) for each in found.best[:proposals]),
        search=found,
        findings=plan.findings,
        settings=problem.present.settings,
    )


def _vary(text: str | Vary) -> Vary:
    try:
        return Vary(text)
    except ValueError:
        raise InvalidArgumentError(f"cannot vary {str(text)!r}; expected some of {', '.join(Vary)}") from None


def _not_later(before: Analysis, figures: Figures) -> Iterator[Limit]:
    """No chain must answer later than now: a chain that is measured from the job that takes a message gets shorter if messages wait."""
    for chain in before.chains:
        found = figures.range(before, chain.name, FROM_ARRIVAL)
        if found.upper is not None:
            yield Limit(object=chain.name, quantity=FROM_ARRIVAL, maximum=found.upper, reason="not later than now")


def _clock(time_limit: float | None) -> Callable[[], str]:
    start = monotonic()

    def ended() -> str:
        is_over = time_limit is not None and monotonic() - start >= time_limit
        return f"the time limit of {time_limit:g} s was reached" if is_over else ""

    return ended


def _proposal(evaluation: Evaluation, evaluator: DesignEvaluator, before: Analysis) -> DesignProposal:
    """A proposal, proved by a full analysis of its own."""
    designs = evaluator.designs
    stated, values = designs.divided(evaluation.candidate)
    built = designs.built(stated)
    configuration = designs.configure(evaluation.candidate)
    analysis = analyze_system(*configuration)
    again = evaluator.judged(evaluation.candidate, analysis)
    assert again == evaluation, "a design was judged in two ways"
    figures = evaluator.figures(evaluation.candidate, analysis)
    return DesignProposal(
        evaluation=evaluation,
        differences=designs.describe(evaluation.candidate),
        changes=designs.changes(evaluation.candidate),
        value_changes=built.value_changes(values),
        rebuilt=built.present.system if stated else None,
        analysis=analysis,
        configuration=configuration,
        impact=impact(before, analysis),
        limits=tuple(
            LimitRow(limit=limit, before=limit.range(before, evaluator.scale.figures), after=limit.range(analysis, figures))
            for limit in evaluator.limits
        ),
    )
