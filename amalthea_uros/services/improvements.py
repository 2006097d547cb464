"""Single changes of a system that shorten a latency of an event chain, each proved by an analysis of the changed system."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from itertools import islice

from amalthea_uros._internal.shown import Shown
from amalthea_uros.analyze.chains.explanation import explain_chain
from amalthea_uros.analyze.results import EXPLAINED, Analysis, Claim, Quantity
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.analyze.verdicts import Verdict
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.services.analyze import Analyzed, analysis_result
from amalthea_uros.services.changes.apply import apply
from amalthea_uros.services.changes.key import Configuration
from amalthea_uros.services.improvement_candidates import Candidate, candidates
from amalthea_uros.services.names import require
from amalthea_uros.timing.arrivals import nominal_period
from amalthea_uros.timing.phases import counters
from amalthea_uros.units import Time, time_text

#: The analyses of changed systems: at most so many, fewer for systems with many processes, but always some.
MAX_ANALYSES, MIN_ANALYSES = 24, 4
#: The processes of all changed systems together.
MAX_PROCESSES = 2_000
#: From the best to the worst verdict.
_SEVERITY = {None: 0, Verdict.MET: 0, Verdict.UNKNOWN: 1, Verdict.MISSED: 2, Verdict.UNBOUNDED: 2}


@dataclass(frozen=True, slots=True, kw_only=True)
class Drawback:
    """What a change makes worse: a verdict, or another latency of the chain; the values before and after, as text."""

    name: str
    before: str
    after: str
    is_verdict: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Improvement:
    """A change that shortens a latency.

    Attributes
    ----------
    before : None if there was no finite value
    claim : of the value after the change
    latencies : all latencies of the chain that can be explained, before and after; None where there is no finite value
    """

    change: Candidate
    before: Time | None
    after: Time
    claim: Claim
    drawbacks: tuple[Drawback, ...] = ()
    latencies: Mapping[Quantity, tuple[Time | None, Time | None]] = field(default_factory=dict)

    @property
    def is_safe(self) -> bool:
        """Whether all that was met is still met."""
        return not any(each.is_verdict for each in self.drawbacks)


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Improvements(Shown):
    """What shortens a latency of a chain.

    Attributes
    ----------
    found : the shortest latency first
    tried : number of changed systems that were analysed
    untried : number of changes that were not, because there are too many
    """

    chain: str
    quantity: Quantity
    found: tuple[Improvement, ...]
    tried: int
    untried: int

    def __repr__(self) -> str:
        best = f"{time_text(self.found[0].after)} by {self.found[0].change.text}" if self.found else "none found"
        return f"<Improvements of {self.chain}, {self.quantity.replace('_', ' ')}: {best}>"

    def best(self, count: int) -> tuple[Improvement, ...]:
        """The first ones, of changes of the same values with the same effect only the smallest."""
        different: dict[tuple[object, ...], Improvement] = {}
        for each in self.found:
            targets = tuple(change.target for change in each.change.changes)
            different.setdefault((*targets, each.change.communication, each.after), each)
        return tuple(islice(different.values(), count))


def improvements(analyzed: Analyzed, chain: str, quantity: Quantity = Quantity.MAX_REDUCED_REACTION_TIME) -> Improvements:
    """Try single changes of a system, and rank those that shorten a latency of a chain.

    Periods are only shortened: with a longer period of the first process, inputs wait longer before the chain begins, which a latency
    that begins there does not include.

    Parameters
    ----------
    analyzed : an analysis, or what `analyze` takes
    quantity : one of `MAX_REACTION_TIME`, `MAX_REDUCED_REACTION_TIME`, `MAX_DATA_AGE` and `MAX_REDUCED_DATA_AGE`

    Raises
    ------
    InvalidArgumentError : there is no such chain, or another quantity.
    """
    result = analysis_result(analyzed)
    require("chain", [chain], result.system.chains)
    check_explained(quantity)
    analysis, present = result.analysis, Configuration(result.system, result.settings)
    every = candidates(explain_chain(analysis, chain, quantity), analysis, present, result.task_periods)
    applied = [(each, changed) for each in every if (changed := _applied(each, present)) is not None]
    most = min(MAX_ANALYSES, max(MIN_ANALYSES, MAX_PROCESSES // max(1, len(analysis.processes))))
    found, tried = [], 0
    for candidate, changed in islice(applied, most):
        try:
            after = analyze_system(*changed)
        except InvalidArgumentError:
            continue
        tried += 1
        found.append(_improvement(candidate, chain, quantity, analysis, after))
    ranked = sorted(filter(None, found), key=lambda each: (each.after, not each.is_safe))
    return Improvements(chain=chain, quantity=quantity, found=tuple(ranked), tried=tried, untried=max(0, len(applied) - most))


def check_explained(quantity: object) -> None:
    """Refuse what is no latency that can be explained.

    Raises
    ------
    InvalidArgumentError : lists those that can be.
    """
    if quantity not in EXPLAINED:
        raise InvalidArgumentError(f"cannot explain {str(quantity)!r}; expected one of {', '.join(EXPLAINED)}")


def _applied(candidate: Candidate, present: Configuration) -> Configuration | None:
    """The changed system; None if the change is impossible, or changes how often messages come."""
    try:
        changed = apply(*present, candidate.changes)
    except InvalidArgumentError:
        return None
    if _arrivals(changed) != _arrivals(present):
        return None
    return candidate.with_communication(changed)


def _arrivals(configuration: Configuration) -> list[tuple[str, Time | None]]:
    """How often what comes from outside arrives; the executor takes it in every n-th job."""
    system = configuration.system
    return [
        (counter.source, nominal_period(system.processes[process], counter, system))
        for process, counter in counters(system)
        if counter.source
    ]


def _improvement(candidate: Candidate, chain: str, quantity: Quantity, before: Analysis, after: Analysis) -> Improvement | None:
    latencies = {each: (_latency(before, chain, each), _latency(after, chain, each)) for each in EXPLAINED}
    then, now = latencies[quantity]
    value = after.chains[chain].value(quantity)
    if now is None or value is None or (then is not None and now >= then):
        return None
    return Improvement(
        change=candidate,
        before=then,
        after=now,
        claim=value.claim,
        drawbacks=(*_worse_verdicts(before, after), *_worse_latencies(latencies)),
        latencies=latencies,
    )


def _latency(analysis: Analysis, chain: str, quantity: Quantity) -> Time | None:
    value = analysis.chains[chain].value(quantity)
    return None if value is None else value.value


def _worse_verdicts(before: Analysis, after: Analysis) -> Iterable[Drawback]:
    verdicts = {(each.name, index): each.verdict for index, each in enumerate(after.requirements)}
    pairs = [
        *((each.name, each.verdict, after.processes[each.name].verdict) for each in before.processes),
        *((each.name, each.verdict, verdicts[each.name, index]) for index, each in enumerate(before.requirements)),
    ]
    for name, then, now in pairs:
        if _SEVERITY[now] > _SEVERITY[then]:
            yield Drawback(name=name, before=str(then or "no deadline"), after=str(now), is_verdict=True)
    for core in after.processors:
        if core.is_overloaded and not before.processors[core.name].is_overloaded:
            yield Drawback(name=core.name, before="not overloaded", after="overloaded", is_verdict=True)


def _worse_latencies(latencies: Mapping[Quantity, tuple[Time | None, Time | None]]) -> Iterable[Drawback]:
    for quantity, (then, now) in latencies.items():
        if then is not None and (now is None or now > then):
            text = "unknown" if now is None else time_text(now)
            yield Drawback(name=quantity.replace("_", " "), before=time_text(then), after=text, is_verdict=False)
