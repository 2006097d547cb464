"""Single changes of a system that shorten a latency of an event chain, each proved by an analysis of the changed system."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import partial
from itertools import islice

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros._internal.shown import Shown
from amalthea_uros.analyze.impact import Amount, ComparedFigure, Effect, FigureUnit, ResultPart, impact
from amalthea_uros.analyze.phases.cases import MAX_JOBS
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import EXPLAINED, LIMITED, LatencyQuantity
from amalthea_uros.analyze.results.explanations import ChainExplanation
from amalthea_uros.analyze.results.processes import ProcessorResult
from amalthea_uros.analyze.system import analyze_while
from amalthea_uros.design.changes.apply import Difference, apply, describe
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.description.edit import DescriptionEditor
from amalthea_uros.design.description.origin import DescriptionOrigin
from amalthea_uros.design.improving_changes import ImprovingChange, candidates
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.timing.activation.releases import counters, nominal_period
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import Rounding, Time, percent_text, time_text

#: The analyses of changed systems: at most so many, fewer for systems with many processes, but always some.
MAX_ANALYSES, MIN_ANALYSES = 24, 4
#: The processes of all changed systems together.
MAX_PROCESSES = 2_000
#: The work of the analyses of all changed systems together: that of two systems with as many phases as are evaluated.
MAX_WORK = 2 * MAX_JOBS


@dataclass(frozen=True, slots=True, kw_only=True)
class Drawback:
    """What a change makes worse: a verdict, or another latency of this or another chain; the values before and after, as text."""

    name: str
    before: str
    after: str
    is_verdict: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Improvement:
    """A change that shortens a latency.

    Attributes
    ----------
    differences : the values that the change sets, before and after; none if it only changes the communication
    before : None if there was no finite value
    claim : of the value after the change
    latencies : all latencies of the chain that can be explained, before and after; None where there is no finite value
    is_enough : whether all limits of the latency are met after the change, by the verdicts of its analysis; None if it has no limit
    """

    change: ImprovingChange
    differences: tuple[Difference, ...]
    before: Time | None
    after: Time
    claim: Claim
    drawbacks: tuple[Drawback, ...] = ()
    latencies: Mapping[LatencyQuantity, tuple[Time | None, Time | None]] = field(default_factory=dict)
    is_enough: bool | None = None

    @property
    def is_safe(self) -> bool:
        """Whether all that was met is still met."""
        return not any(each.is_verdict for each in self.drawbacks)

    @property
    def per_change(self) -> tuple[Fraction, Time]:
        """Sorts the greatest effect per change first; of what makes a latency bounded, the shortest."""
        gained = Fraction(0) if self.before is None else Fraction(self.before - self.after, self.change.count)
        return -gained, self.after


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Improvements(Shown):
    """What shortens a latency of a chain.

    Attributes
    ----------
    found : the shortest latency first, then combinations of them, from two changes on
    tried : number of changed systems that were analysed
    untried : number of changes that were not, because there are too many, or because of their phases
    is_work_exceeded : whether some were not because the analyses of those before took as much work as is allowed
    """

    chain: str
    quantity: LatencyQuantity
    found: tuple[Improvement, ...]
    tried: int
    untried: int
    is_work_exceeded: bool = False

    def __repr__(self) -> str:
        best = f"{time_text(self.found[0].after)} by {self.found[0].change.text}" if self.found else "none found"
        return f"<Improvements of {self.chain}, {self.quantity.replace('_', ' ')}: {best}>"

    @property
    def recommended(self) -> Improvement | None:
        """The change to recommend, of those that break nothing: the one with the greatest effect per change.

        If some are enough for the limits, only these count, and of them the ones with the fewest changes.
        """
        safe = [each for each in self.found if each.is_safe]
        enough = [each for each in safe if each.is_enough]
        if enough:
            return min(enough, key=lambda each: (each.change.count, each.after))
        return min(safe, key=lambda each: each.per_change, default=None)

    def best(self, count: int) -> tuple[Improvement, ...]:
        """The first ones, of changes of the same values with the same effect only the smallest."""
        different: dict[tuple[object, ...], Improvement] = {}
        for each in self.found:
            targets = tuple(change.target for change in each.change.changes)
            different.setdefault((*targets, each.change.communication, each.after), each)
        every = tuple(different.values())
        singles = [each for each in every if not each.change.is_combined]
        combined = [each for each in every if each.change.is_combined][-_SHOWN_COMBINATIONS:]
        return (*singles[: count - len(combined)], *combined)


def improvements_of(
    analysis: Analysis,
    explanation: ChainExplanation,
    offered: Sequence[Time] = (),
    source: DescriptionOrigin | None = None,
) -> Improvements:
    """Try single changes of a system, then the best of them together, and rank those that shorten an explained latency.

    Periods are only shortened: with a longer period of the first process, inputs wait longer before the chain begins, which a latency
    that begins there does not include.

    Parameters
    ----------
    offered : the periods that tasks can have; empty if they can have any
    source : the description of the system, which is what changes; None for other systems
    """
    context = analysis.solution.context
    present = Configuration(context.system, context.settings)
    trial = Trial(analysis, present, explanation.chain.name, explanation.quantity, source)
    every = candidates(explanation, analysis, present, offered, source)
    # Of a description, each is built to find out whether it is possible, so that no more of them are than are tried.
    prepared = list(islice((pair for one in every for pair in trial.prepared(one)), None if source is None else MAX_ANALYSES))
    most = min(MAX_ANALYSES, max(MIN_ANALYSES, MAX_PROCESSES // max(1, len(analysis.processes))))
    tries = (trial.tried(each, changed, trial.before) for each, changed in islice(prepared, most))
    singles = [each for each in tries if each is not None]
    ranked = sorted(singles, key=rank)
    combined = tuple(trial.combined(ranked))
    untried = max(0, len(prepared) - most) if source is None or len(prepared) < MAX_ANALYSES else len(every) - most
    return Improvements(
        chain=trial.chain,
        quantity=trial.quantity,
        found=(*ranked, *combined),
        tried=trial.count,
        untried=untried + trial.refused,
        is_work_exceeded=trial.refused > 0,
    )


def rank(improvement: Improvement) -> tuple[Time, bool]:
    """The shortest latency first."""
    return improvement.after, not improvement.is_safe


#: A part of the time of a core that is worth mentioning.
_MUCH_LOAD = Fraction(1, 10)
#: Of the combinations, so many are shown, those with the most changes.
_SHOWN_COMBINATIONS = 2
#: So many changes are tried together at most: the more there are, the less is known of which of them are needed.
MAX_COMBINED = 3


@dataclass(slots=True)
class Trial:
    """Tries changes.

    Attributes
    ----------
    count : of changed systems whose analysis is known
    known : what the analyses found; changes without an effect, or with that of another one, are analysed once
    work : of the analyses, in jobs
    refused : number of changed systems that were not analysed because of the work of those before
    editor : of the description; None for other systems
    """

    analysis: Analysis
    present: Configuration
    chain: str
    quantity: LatencyQuantity
    source: DescriptionOrigin | None
    count: int = 0
    known: list[tuple[Configuration, Improvement | None]] = field(default_factory=list)
    work: int = 0
    refused: int = 0
    editor: DescriptionEditor | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        self.known.append((self.present, None))
        self.editor = None if self.source is None else DescriptionEditor(self.source.text, self.source.path)

    def prepared(self, candidate: ImprovingChange) -> Iterator[tuple[ImprovingChange, Configuration]]:
        """A candidate with its changed system; nothing if it is impossible, or changes how often messages come."""
        try:
            if not candidate.is_stated:
                if _arrivals(apply(*self.present, candidate.changes)) != _arrivals(self.present):
                    return
                candidate = self._in_description(candidate)
            changed = (
                apply(*self.present, candidate.changes) if self.source is None else self.source.configure(candidate.changes)
            )
        except InvalidArgumentError:
            return
        yield candidate, candidate.with_communication(changed)

    def _in_description(self, candidate: ImprovingChange) -> ImprovingChange:
        """A candidate with what a description states for it, if there is one; InvalidArgumentError if it states nothing."""
        if self.source is None or self.editor is None or not candidate.changes:
            return candidate
        edited = self.editor.edited(candidate.changes)
        return replace(candidate, changes=self.source.changes_of(edited.assignments), is_stated=True)

    def tried(self, candidate: ImprovingChange, changed: Configuration, limit: Time | None) -> Improvement | None:
        """The improvement by a changed system; None if the latency is not shorter than a limit (None: has no bound).

        The limits of successive calls never rise, so that what was not shorter is not shorter now either.
        """
        for each, improvement in self.known:
            if each == changed:
                self.count += 1
                return improvement and replace(improvement, change=candidate, differences=self._differences(candidate))
        if self.work >= MAX_WORK:
            self.refused += 1
            return None
        try:
            after = analyze_while(*changed, partial(self._is_shorter, limit))
        except InvalidArgumentError:
            return None
        self.count += 1
        improvement = None if after is None else self._improvement(candidate, after)
        self.known.append((changed, improvement))
        return improvement

    def _is_shorter(self, limit: Time | None, for_a_phase: Analysis) -> bool:
        """Whether the maximum is shorter than a limit for a phase of a changed system; if not, it is not over all phases either."""
        self.work += for_a_phase.work
        now = _latency(for_a_phase, self.chain, self.quantity)
        return now is not None and (limit is None or now < limit)

    def _improvement(self, candidate: ImprovingChange, after: Analysis) -> Improvement | None:
        return _improvement(candidate, self._differences(candidate), self.chain, self.quantity, self.analysis, after)

    @property
    def before(self) -> Time | None:
        """The present latency."""
        return _latency(self.analysis, self.chain, self.quantity)

    def combined(self, ranked: Sequence[Improvement]) -> Iterator[Improvement]:
        """The best changes of a description together, one more at a time, as long as each of them helps."""
        # What breaks something alone is not recommended together with others either.
        ranked = [each for each in ranked if each.is_safe] or ranked
        if self.source is None or not ranked:
            return
        best = ranked[0]
        for other in ranked[1:]:
            both = _combination(best.change, other.change)
            if both is None or len(both.changes) > MAX_COMBINED:
                continue
            limit = min(best.after, other.after)
            for candidate, changed in self.prepared(both):
                improvement = self.tried(candidate, changed, limit)
                if improvement is not None and improvement.after < limit:
                    best = improvement
                    yield improvement

    def _differences(self, candidate: ImprovingChange) -> tuple[Difference, ...]:
        if self.source is None:
            return describe(*self.present, candidate.changes)
        return tuple(each for each in self.source.differences(candidate.changes) if not each.is_consequence)


def _combination(one: ImprovingChange, other: ImprovingChange) -> ImprovingChange | None:
    """Two changes together; None if they set the same value, or a communication."""
    targets = [change.target for change in (*one.changes, *other.changes)]
    if len(set(targets)) < len(targets) or one.communication is not None or other.communication is not None:
        return None
    changes = (*one.changes, *other.changes)
    return ImprovingChange(text=f"{one.text}, {other.text}", changes=changes, is_stated=True, count=one.count + other.count)


def check_explained(quantity: object) -> None:
    """Refuse what is no latency that can be explained.

    Raises
    ------
    InvalidArgumentError : lists those that can be.
    """
    if quantity not in EXPLAINED:
        raise InvalidArgumentError(f"cannot explain {str(quantity)!r}; expected one of {', '.join(EXPLAINED)}")


def _arrivals(configuration: Configuration) -> list[tuple[str, Time | None]]:
    """How often what comes from outside arrives; the executor takes it in every n-th job."""
    system = configuration.system
    return [
        (counter.source, nominal_period(system.processes[process], counter, system))
        for process, counter in counters(system)
        if counter.source
    ]


def _improvement(
    candidate: ImprovingChange,
    differences: tuple[Difference, ...],
    chain: str,
    quantity: LatencyQuantity,
    before: Analysis,
    after: Analysis,
) -> Improvement | None:
    latencies = {each: (_latency(before, chain, each), _latency(after, chain, each)) for each in EXPLAINED}
    then, now = latencies[quantity]
    value = after.chains[chain].value(quantity)
    if now is None or value is None or (then is not None and now >= then):
        return None
    return Improvement(
        change=candidate,
        differences=differences,
        before=then,
        after=now,
        claim=value.claim,
        drawbacks=tuple(_drawbacks(chain, latencies, before, after)),
        latencies=latencies,
        is_enough=_is_enough(chain, quantity, after),
    )


def _is_enough(chain: str, quantity: LatencyQuantity, analysis: Analysis) -> bool | None:
    """Whether the upper limits of a latency are met; None if it has none."""
    verdicts = [
        each.verdict
        for each in analysis.requirements
        if each.object == chain and each.is_upper and LIMITED.get(each.quantity) is quantity
    ]
    return all(verdict is Verdict.MET for verdict in verdicts) if verdicts else None


def _latency(analysis: Analysis, chain: str, quantity: LatencyQuantity) -> Time | None:
    value = analysis.chains[chain].value(quantity)
    return None if value is None else value.value


def _drawbacks(
    chain: str, latencies: Mapping[LatencyQuantity, tuple[Time | None, Time | None]], before: Analysis, after: Analysis
) -> Iterator[Drawback]:
    """What gets worse: verdicts, cores that are overloaded now, and latencies of this chain and other chains."""
    worse = [row for row in impact(before, after).rows if row.effect is Effect.WORSE]
    for row in worse:
        if row.part in (ResultPart.PROCESS, ResultPart.REQUIREMENT) and row.figure.unit is FigureUnit.VERDICT:
            yield Drawback(name=row.object, before=_verdict(row.before), after=_verdict(row.after), is_verdict=True)
    for process in after.processes:
        if process.name not in before.processes.names and process.verdict is not Verdict.MET:
            yield Drawback(name=process.name, before="no task", after=str(process.verdict), is_verdict=True)
    for core in after.processors:
        if core.is_overloaded and not before.processors[core.name].is_overloaded:
            yield Drawback(name=core.name, before="not overloaded", after="overloaded", is_verdict=True)
        elif _needs_much_more(before.processors[core.name], core):
            loads = [percent_text(each.worst or each.at_least, 1, Rounding.UP) for each in (before.processors[core.name], core)]
            yield Drawback(name=f"load of {core.name}", before=f"{loads[0]} %", after=f"{loads[1]} %", is_verdict=False)
    for quantity, (then, now) in latencies.items():
        if then is not None and (now is None or now > then):
            yield Drawback(name=quantity.replace("_", " "), before=_text(then), after=_text(now), is_verdict=False)
    for row in worse:
        if row.part is ResultPart.CHAIN and row.object != chain and row.before is not None and row.after is not None:
            name = f"{row.quantity.replace('_', ' ')} of {row.object}"
            yield Drawback(name=name, before=_text(row.before.value), after=_text(row.after.value), is_verdict=False)


def _needs_much_more(before: ProcessorResult, after: ProcessorResult) -> bool:
    """Whether the worst load of a core rises by more than a tenth of its time."""
    loads = before.worst, after.worst
    return None not in loads and (after.worst or 0) - (before.worst or 0) > _MUCH_LOAD


def _verdict(figure: ComparedFigure | None) -> str:
    return "no deadline" if figure is None or figure.value is None else str(figure.value)


def _text(value: Amount | None) -> str:
    return time_text(value) if isinstance(value, int) else "unknown"
