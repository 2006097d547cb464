"""What a change of a system does to the results: the figures before and after it.

The figures that are compared are what is guaranteed: a bound that gets lower is better, although the exact value, which is unknown,
may be the same. Where nothing is guaranteed before or after, nothing is concluded in favour of the change.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from enum import StrEnum
from fractions import Fraction
from functools import partial
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.shown import Shown
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import ChainResult, LatencyQuantity
from amalthea_uros.analyze.results.processes import CallbackResult, ProcessorResult, ProcessResult, RequirementResult
from amalthea_uros.judge.verdict import Failure, Verdict
from amalthea_uros.timing.response import Claim, Response

#: The value of a figure.
Amount: TypeAlias = int | Fraction | StrEnum


class ResultPart(StrEnum):
    """The part of the results that a figure belongs to."""

    SYSTEM = "system"
    CORE = "core"
    PROCESS = "process"
    CALLBACK = "callback"
    CHAIN = "chain"
    REQUIREMENT = "requirement"


class FigureUnit(StrEnum):
    """What the value of a figure is: picoseconds, a share of a core (1 is full), a number, or a word."""

    TIME = "time"
    SHARE = "share"
    NUMBER = "number"
    VERDICT = "verdict"


class Preference(StrEnum):
    """Which figures are better."""

    LOW = "low"
    HIGH = "high"
    NONE = "none"


class Effect(StrEnum):
    """What a change does to a figure.

    Attributes
    ----------
    UNKNOWN : the figure was unknown before, so nobody can say; or a failure is no longer certain
    CHANGED : neither is better
    ADDED, REMOVED : there is no such figure before, or after
    """

    BETTER = "better"
    WORSE = "worse"
    UNKNOWN = "unknown"
    CHANGED = "changed"
    ADDED = "added"
    REMOVED = "removed"


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparedFigure:
    """A figure of an object.

    Attributes
    ----------
    object : name of the core, process, chain or requirement; "" for the whole system
    quantity : such as "worst_case_response_time"
    about : of a requirement, what it limits; requirements of one name that limit something else are not the same
    value : None if it is unknown; a verdict also if nothing is judged
    claim : None for verdicts, stated limits and what is unknown
    at_least : of an unknown value, the part that is known; None if there is none
    is_overload : whether the value is None because, in the long run, more work is activated than can be executed
    reason : why it is unknown
    """

    part: ResultPart
    object: str
    quantity: str
    value: Amount | None
    unit: FigureUnit = FigureUnit.TIME
    goal: Preference = Preference.NONE
    claim: Claim | None = None
    at_least: Fraction | None = None
    is_overload: bool = False
    reason: str = ""
    about: str = ""

    @property
    def key(self) -> tuple[ResultPart, str, str, str]:
        """What says that two figures are about the same."""
        return self.part, self.object, self.quantity, self.about

    @property
    def compared(self) -> tuple[Amount | None, Fraction | None, bool]:
        """What must differ for a change of the figure."""
        return self.value, self.at_least, self.is_overload


@dataclass(frozen=True, slots=True, kw_only=True)
class ImpactRow:
    """A figure that is not the same before and after.

    Attributes
    ----------
    before, after : None if there is no such figure
    """

    before: ComparedFigure | None
    after: ComparedFigure | None
    effect: Effect

    @property
    def figure(self) -> ComparedFigure:
        """The figure after the change, or the one before it if there is none."""
        found = self.after or self.before
        assert found is not None
        return found

    @property
    def part(self) -> ResultPart:
        """The part of the results."""
        return self.figure.part

    @property
    def object(self) -> str:
        """The name of the core, process, chain or requirement; "" for the whole system."""
        return self.figure.object

    @property
    def quantity(self) -> str:
        """What of the object, such as "worst_case_response_time"."""
        return self.figure.quantity

    @property
    def claim(self) -> Claim | None:
        """The weaker claim of both values; None if neither has one."""
        claims = [figure.claim for figure in (self.before, self.after) if figure is not None and figure.claim is not None]
        return max(claims, key=tuple(Claim).index, default=None)


@dataclass(frozen=True, slots=True, kw_only=True)
class Impact(Shown):
    """What a change of a system does to the results.

    Attributes
    ----------
    rows : the figures that changed
    unchanged : number of the other figures
    """

    rows: tuple[ImpactRow, ...]
    unchanged: int

    def __repr__(self) -> str:
        counts = (f"{number} {effect}" for effect, number in self.counts.items())
        return f"<Impact: {', '.join((*counts, f'{self.unchanged} unchanged'))}>"

    def __bool__(self) -> bool:
        """Whether anything changed."""
        return bool(self.rows)

    @property
    def counts(self) -> Mapping[Effect, int]:
        """The number of rows with each effect that occurs."""
        found = Counter(row.effect for row in self.rows)
        return {effect: found[effect] for effect in Effect if found[effect]}


def impact(before: Analysis, after: Analysis) -> Impact:
    """Compare the results of two systems, object by object."""
    return compare(figures(before), figures(after))


def compare(before: Iterable[ComparedFigure], after: Iterable[ComparedFigure]) -> Impact:
    """Compare figures; those that only one side has are also part of the result."""
    old, new = _numbered(before), _numbered(after)
    pairs = [(old.get(key), new.get(key)) for key in (*new, *(key for key in old if key not in new))]
    rows = tuple(
        ImpactRow(before=one, after=other, effect=_effect(one, other))
        for one, other in pairs
        if one is None or other is None or one.compared != other.compared
    )
    rows = tuple(sorted(rows, key=lambda row: tuple(ResultPart).index(row.part)))
    return Impact(rows=rows, unchanged=len(pairs) - len(rows))


def _numbered(given: Iterable[ComparedFigure]) -> dict[tuple[object, ...], ComparedFigure]:
    """The figures by what they are about; several requirements may have one name."""
    counts: Counter[object] = Counter()
    found: dict[tuple[object, ...], ComparedFigure] = {}
    for figure in given:
        found[*figure.key, counts[figure.key]] = figure
        counts[figure.key] += 1
    return found


def _effect(before: ComparedFigure | None, after: ComparedFigure | None) -> Effect:
    if before is None:
        return Effect.ADDED
    if after is None:
        return Effect.REMOVED
    old, new = before.value, after.value
    if isinstance(old, StrEnum) or isinstance(new, StrEnum):
        return _effect_of_verdicts(old, new)
    if new is None:
        is_worse = old is not None or (after.is_overload and not before.is_overload)
        return Effect.WORSE if is_worse else Effect.UNKNOWN
    if old is None:
        return Effect.BETTER if before.is_overload else Effect.UNKNOWN
    if after.goal is Preference.NONE:
        return Effect.CHANGED
    return Effect.BETTER if (new < old) == (after.goal is Preference.LOW) else Effect.WORSE


#: Verdicts from good to bad: of a process or requirement, and of a system; what was observed is ordered alike.
_GOOD = ("met", "yes", "observed_ok")
_OPEN = ("unknown", "not_observed")
_ENDLESS = (Verdict.UNBOUNDED, Failure.OVERLOAD)


def _effect_of_verdicts(before: Amount | None, after: Amount | None) -> Effect:
    old, new = _rank(before), _rank(after)
    if new < old:
        # That a failure is not certain any more is no improvement.
        return Effect.BETTER if new == 0 else Effect.UNKNOWN
    return Effect.WORSE if new > old else Effect.CHANGED


def _rank(verdict: Amount | None) -> int:
    """0 for what is certainly good, 1 for what is unknown or not judged, 2 and more for failures."""
    if verdict in _GOOD:
        return 0
    if verdict is None or verdict in _OPEN:
        return 1
    return 3 if verdict in _ENDLESS else 2


def figures(analysis: Analysis) -> Iterator[ComparedFigure]:
    """Everything that is compared."""
    yield verdict_figure(ResultPart.SYSTEM, "", analysis.summary.schedulable, quantity="schedulable")
    sources: tuple[tuple[Iterable[object], Callable[..., Iterator[ComparedFigure]]], ...] = (
        (analysis.processors, _of_core),
        (analysis.processes, _of_process),
        (analysis.callbacks, _of_callback),
        (analysis.chains, _of_chain),
        (analysis.requirements, _of_requirement),
    )
    for results, figures_of in sources:
        for result in results:
            yield from figures_of(result)


def verdict_figure(
    part: ResultPart, name: str, verdict: StrEnum | None, reason: str = "", quantity: str = "verdict"
) -> ComparedFigure:
    """A verdict as a figure."""
    return ComparedFigure(part=part, object=name, quantity=quantity, value=verdict, unit=FigureUnit.VERDICT, reason=reason)


def _of_core(core: ProcessorResult) -> Iterator[ComparedFigure]:
    yield ComparedFigure(
        part=ResultPart.CORE,
        object=core.name,
        quantity="worst_case_load",
        value=core.worst,
        unit=FigureUnit.SHARE,
        goal=Preference.LOW,
        claim=None if core.worst is None else Claim.BOUND,
        at_least=core.at_least if core.worst is None else None,
        is_overload=core.worst is None and core.is_overloaded,
    )


def _of_process(process: ProcessResult) -> Iterator[ComparedFigure]:
    yield _response(ResultPart.PROCESS, process.name, process.response, process.reason)
    if process.deadline is not None:
        yield ComparedFigure(part=ResultPart.PROCESS, object=process.name, quantity="deadline", value=process.deadline)
    yield verdict_figure(ResultPart.PROCESS, process.name, process.failure or process.verdict, process.reason)


def _of_callback(callback: CallbackResult) -> Iterator[ComparedFigure]:
    name = f"{callback.name} in {callback.process}"
    yield _response(ResultPart.CALLBACK, name, callback.response, callback.reason)


def _response(part: ResultPart, name: str, response: Response | None, reason: str) -> ComparedFigure:
    worst = response.worst if response else None
    return ComparedFigure(
        part=part,
        object=name,
        quantity="worst_case_response_time",
        value=worst,
        goal=Preference.LOW,
        claim=response.claim if response and worst is not None else None,
        is_overload=response is not None and response.is_overload,
        reason=reason if worst is None else "",
    )


#: The headline latencies of a chain; the shortest one is neither good nor bad.
_LATENCIES = {
    LatencyQuantity.MIN_FIRST_TO_FIRST: Preference.NONE,
    LatencyQuantity.MAX_REDUCED_REACTION_TIME: Preference.LOW,
    LatencyQuantity.MAX_REDUCED_DATA_AGE: Preference.LOW,
}


def _of_chain(chain: ChainResult) -> Iterator[ComparedFigure]:
    for quantity, goal in _LATENCIES.items():
        found = chain.value(quantity)
        value = found.value if found else None
        yield ComparedFigure(
            part=ResultPart.CHAIN,
            object=chain.name,
            quantity=quantity,
            value=value,
            goal=goal,
            claim=found.claim if found and value is not None else None,
            reason="" if value is not None else (found.reason if found else "") or chain.reason,
        )


def _of_requirement(requirement: RequirementResult) -> Iterator[ComparedFigure]:
    bound = "maximum" if requirement.is_upper else "minimum"
    figure = partial(
        ComparedFigure,
        part=ResultPart.REQUIREMENT,
        object=requirement.name,
        about=f"{bound} {requirement.quantity} of {requirement.object}",
    )
    if requirement.limit is not None:
        margin = None if requirement.verdict is Verdict.UNKNOWN else requirement.margin
        yield figure(quantity="limit", value=requirement.limit)
        yield figure(
            quantity="margin",
            value=margin,
            goal=Preference.HIGH,
            claim=None if margin is None else Claim.EXACT if requirement.lower == requirement.upper else Claim.BOUND,
            is_overload=requirement.verdict is Verdict.UNBOUNDED,
            reason=requirement.reason,
        )
    yield figure(quantity="verdict", value=requirement.verdict, unit=FigureUnit.VERDICT, reason=requirement.reason)
