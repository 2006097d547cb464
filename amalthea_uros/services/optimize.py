"""Searches for a better design, every proposal of which the full analysis proves."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from time import monotonic

from amalthea_uros._internal.one_or_several import one_or_several
from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros._internal.shown import Shown
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.design.changes.change import Sweeps, as_sweeps
from amalthea_uros.design.optimize.choices import DEFAULT, Vary, Wishes
from amalthea_uros.design.optimize.judged import Effort
from amalthea_uros.design.optimize.parallel_evaluation import evaluator_on
from amalthea_uros.design.optimize.problem import DesignEvaluation, Goal, SearchResult
from amalthea_uros.design.optimize.quantities import Limit
from amalthea_uros.design.optimize.search import search
from amalthea_uros.design.optimize.space import Space
from amalthea_uros.design.optimize.unstated import StatedOnly, proved_for_stated, without_unstated
from amalthea_uros.design.proposals import DesignProposal, SearchPlan, plan_search, proved_proposal
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.findings.accepted import unsuppressed
from amalthea_uros.services.changed import open_changed
from amalthea_uros.services.subject import Subject, SystemInput
from amalthea_uros.timing.basics.settings import Settings

#: So many proposals are shown, unless more are asked for.
MOST_PROPOSALS = 5
#: After so many designs that no description states, a search ends.
_MOST_UNSTATED = 500
#: So many designs are judged, unless more are asked for.
MOST_DESIGNS = 2000


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
    present: DesignEvaluation
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
class OptimizationPlan(SearchPlan):
    """A search that can be started, with what it is about."""

    opened: SystemInput
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
) -> OptimizationPlan:
    """Read what describes a system, and find out what may change; parameters and errors as for `optimize`."""
    changed = open_changed(subject, settings)
    opened = changed.opened
    plan = plan_search(
        changed.given,
        wishes or Wishes(),
        opened.assembly,
        changed.source if opened.model is None else changed.model_source,
        limits=limits,
        goals=goals,
        may_be_later=may_be_later,
        seed=seed,
    )
    return OptimizationPlan(
        problem=plan.problem,
        before=plan.before,
        evaluator=plan.evaluator,
        source=plan.source,
        opened=opened,
        findings=unsuppressed((*opened.findings, *plan.before.findings)),
    )


def optimize(
    subject: Subject,
    *,
    limits: Iterable[str | Limit] = (),
    goals: Sequence[str] = (),
    vary: Iterable[str | Vary] = DEFAULT,
    offers: Sweeps = (),
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
        vary=tuple(map(_vary, one_or_several(vary))),
        offers=as_sweeps(offers),
        keep=one_or_several(keep),
        is_rate_monotonic=is_rate_monotonic,
    )
    plan = plan_optimization(
        subject,
        wishes,
        limits=one_or_several(limits),
        goals=one_or_several(goals),
        settings=settings,
        may_be_later=may_be_later,
        seed=seed,
    )
    effort = Effort(designs=designs, is_complete=is_complete, ended=_clock(time_limit), progress=progress)
    with evaluator_on(plan.evaluator, workers, cluster) as evaluate:
        return _found(plan, StatedOnly(evaluate), effort, proposals)


def _found(plan: OptimizationPlan, evaluate: StatedOnly, effort: Effort, count: int) -> Optimization:
    """The outcome of a search, each proposal proved by a full analysis of its own.

    Designs that turn out not to be what any description states are left out; if no other one was found, the search continues.
    """
    problem, evaluator, before = plan.problem, plan.evaluator, plan.before
    while True:
        result = search(replace(problem, evaluate=evaluate), effort)
        result = proved_for_stated(result, evaluate.unstated)
        proved, refuted = _proved(plan, result, count)
        if not refuted or proved or result.ended or len(evaluate.unstated) > _MOST_UNSTATED:
            break
        evaluate = evaluate.without(refuted)
    return Optimization(
        subject=plan.opened.subject,
        paths=plan.opened.paths,
        space=problem.space,
        limits=evaluator.limits,
        goals=problem.goals,
        before=before,
        present=evaluator.judged((), before),
        proposals=proved,
        search=without_unstated(result, refuted) if refuted else result,
        findings=plan.findings,
        settings=problem.present.settings,
    )


def _proved(
    plan: OptimizationPlan, search: SearchResult, count: int
) -> tuple[tuple[DesignProposal, ...], list[DesignEvaluation]]:
    """The proposals, and the better designs that the edited description does not confirm."""
    proved, refuted = list[DesignProposal](), list[DesignEvaluation]()
    for each in search.best:
        if len(proved) == count:
            break
        proposal = proved_proposal(each, plan.evaluator, plan.before, plan.source)
        if proposal is None:
            refuted.append(each)
        else:
            proved.append(proposal)
    return tuple(proved), refuted


def _vary(text: str | Vary) -> Vary:
    try:
        return Vary(text)
    except ValueError:
        raise InvalidArgumentError(f"cannot vary {str(text)!r}; expected some of {', '.join(Vary)}") from None


def _clock(time_limit: float | None) -> Callable[[], str]:
    start = monotonic()

    def ended() -> str:
        is_over = time_limit is not None and monotonic() - start >= time_limit
        return f"the time limit of {time_limit:g} s was reached" if is_over else ""

    return ended
