"""Searches for a better design, and sweeps, as documents."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.impact import Impact, ResultPart
from amalthea_uros.design.campaign.sweeps import GROWTH, SCHEDULABLE
from amalthea_uros.design.optimize.goals import CHANGES
from amalthea_uros.design.optimize.problem import Conclusion, Feasibility
from amalthea_uros.design.optimize.quantities import AmountKind, dimension
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.report.basics.document import Block, ResultDocument, Section, Sentences, document, section, table
from amalthea_uros.report.wording.cells import UNKNOWN, about, at_least, at_most, load_text, words
from amalthea_uros.report.wording.closing_line import closing_line
from amalthea_uros.report.wording.impact import impact_cells
from amalthea_uros.units import Rounding, number_text, rounded, time_text

if TYPE_CHECKING:
    from amalthea_uros.analyze.results.analysis import Analysis
    from amalthea_uros.analyze.results.processes import RequirementResult
    from amalthea_uros.design.campaign.run import RunOutcome, Value
    from amalthea_uros.design.campaign.sweeps import SweepResult
    from amalthea_uros.design.optimize.quantities import Amount, Limit, Range
    from amalthea_uros.design.optimize.space import Choice, Space
    from amalthea_uros.design.proposals import DesignProposal, LimitRow
    from amalthea_uros.services.optimize import Optimization

_NOTHING = "nothing: allow more with --vary or --offer"
#: More values of a choice are only counted, and further drawbacks and violations.
_MOST_OPTIONS, _MOST_CHOICES, _MOST_DRAWBACKS, _MOST_VIOLATIONS = 6, 12, 6, 3
#: Larger numbers have an exponent.
_LONG = 10**15
_GOALS = {
    "latency": "the largest latency of a chain relative to its limit (latency)",
    "load": "the largest load of a core (load)",
    "balance": "the difference between the loads of the cores (balance)",
    "jitter": "the largest response-time jitter (jitter)",
    CHANGES: "the number of changed values (changes)",
}
_VERDICTS = {Feasibility.YES: "met", Feasibility.NO: "missed", Feasibility.UNKNOWN: "unknown"}


def optimization_document(result: Optimization) -> ResultDocument:
    """What was asked, the present design, the proposals with all their effects, and what the search proves."""
    sections = (
        section("Search", _question(result)),
        *(_proposal(result, number, proposal) for number, proposal in enumerate(result.proposals, start=1)),
        section("Designs", _tried(result)),
    )
    return document(sections, optimization_line(result))


def _question(result: Optimization) -> Sentences:
    rows = [("may change", line) for line in list(_space_lines(result.space)) or [_NOTHING]]
    rows.append(("must hold", "all deadlines, requirements and constraints of the model"))
    rows += [("", _limit_text(limit)) for limit in result.limits]
    rows += [("then" if number else "minimised", _GOALS.get(goal.name, goal.name)) for number, goal in enumerate(result.goals)]
    rows += [("now", line) for line in _present(result)]
    names = [name for name, _ in rows]
    firsts = ["" if name == before else name for name, before in zip(names, ["", *names], strict=False)]
    return Sentences([f"{first:<10}  {text}" for first, (_, text) in zip(firsts, rows, strict=True)])


def _space_lines(space: Space) -> Iterator[str]:
    """What may change."""
    shown = space.choices[:_MOST_CHOICES]
    yield from map(_choice, shown)
    if len(space.choices) > len(shown):
        yield f"{counted(len(space.choices) - len(shown), 'other value')}"
    for order in space.orders:
        yield f"priorities on {order.scheduler}: any order of {counted(len(order.tasks), 'task')}"


def _choice(choice: Choice) -> str:
    options = ", ".join(choice.options[1 : _MOST_OPTIONS + 1])
    more = len(choice.options) - 1 - _MOST_OPTIONS
    return f"{choice.target} {choice.options[0]}: {options}" + (f" and {more} more" if more > 0 else "")


def _limit_text(limit: Limit) -> str:
    """A limit, and what it is for."""
    maximum = load_text(limit.maximum) if dimension(limit.quantity) is AmountKind.SHARE else time_text(limit.maximum)  # type: ignore[arg-type]
    return f"{limit.target} {'<' if limit.is_below else '<='} {maximum}" + (f" ({limit.reason})" if limit.reason else "")


def _present(result: Optimization) -> Iterator[str]:
    """Whether the present design meets all limits, else which ones it does not, and why."""
    if result.present.feasible is Feasibility.YES:
        yield "all limits are met"
        return
    names = list(result.present.violations)
    more = f" and {len(names) - _MOST_VIOLATIONS} more" if names[_MOST_VIOLATIONS:] else ""
    violations = "; ".join(names[:_MOST_VIOLATIONS]) + more
    if result.present.feasible is Feasibility.NO:
        yield f"not met: {violations or 'something is overloaded'}"
    else:
        yield f"unknown: {violations or 'nothing is demanded of the model'}"
    if result.before.summary.schedulable is not Schedulable.YES:
        yield closing_line(result.before.summary)


def _proposal(result: Optimization, number: int, proposal: DesignProposal) -> Section:
    claim = "exact" if proposal.evaluation.is_exact else "with safe bounds"
    count = counted(proposal.evaluation.changes, "changed value") if proposal.differences else "the design as it is"
    rows = [
        *_requirements(result.before, proposal.analysis),
        *map(_limit, proposal.limits),
        *_loads(result.before, proposal.analysis),
    ]
    titles = ("what", "quantity", ">now", ">proposed", ">limit", ">margin", "verdict")
    blocks: list[Block] = [Sentences(list(map(str, proposal.differences))), table("", titles, rows)]
    blocks.append(Sentences([*_drawbacks(proposal), *_next(result, proposal)]))
    return section(f"Proposal {number}: {count}, proved by the analysis ({claim})", *blocks)


def _next(result: Optimization, proposal: DesignProposal) -> Iterator[str]:
    if proposal.changes:
        files = " ".join(shlex.quote(str(path)) for path in result.paths) or "FILE"
        yield f"to see all effects: amuros analyze {files} {shlex.join(proposal.options)}"


def _requirements(before: Analysis, after: Analysis) -> Iterator[tuple[str, ...]]:
    for old, new in zip(before.requirements, after.requirements, strict=True):
        if new.limit is not None:
            yield (
                new.object,
                words(new.quantity),
                _value(old),
                _value(new),
                f"{'<=' if new.is_upper else '>='} {about(new.limit)}",
                "-" if new.margin is None else at_least(new.margin),
                str(new.verdict) if new.verdict is old.verdict else f"{old.verdict} -> {new.verdict}",
            )


def _value(requirement: RequirementResult) -> str:
    if requirement.value is None:
        return "unbounded" if requirement.verdict is Verdict.UNBOUNDED else UNKNOWN
    return (at_most if requirement.is_upper else at_least)(requirement.value, requirement.limit)


def _limit(row: LimitRow) -> tuple[str, ...]:
    limit = row.limit
    margin = None if row.after.upper is None else limit.maximum - row.after.upper
    old, new = _VERDICTS[limit.verdict(row.before)], _VERDICTS[row.verdict]
    return (
        limit.object,
        words(limit.quantity),
        _upper(row.before, limit.quantity),
        _upper(row.after, limit.quantity),
        f"{'<' if limit.is_below else '<='} {_amount(limit.maximum, limit.quantity)}",
        "-" if margin is None else _amount(margin, limit.quantity),
        new if old == new else f"{old} -> {new}",
    )


def _upper(found: Range, quantity: str) -> str:
    return UNKNOWN if found.upper is None else _amount(found.upper, quantity)


def _amount(value: Amount, quantity: str) -> str:
    return load_text(Fraction(value), Rounding.UP) if dimension(quantity) is AmountKind.SHARE else at_most(int(value))


def _loads(before: Analysis, after: Analysis) -> Iterator[tuple[str, ...]]:
    for old, new in zip(before.processors, after.processors, strict=True):
        if old.worst or new.worst:
            loads = (load_text(core.worst, Rounding.UP) for core in (old, new))
            yield new.name, "worst load", *loads, "", "", ""


def _drawbacks(proposal: DesignProposal) -> Iterator[str]:
    """What gets worse, apart from what the table has."""
    rows = [row for row in proposal.worse if not (row.part is ResultPart.CORE or row.part is ResultPart.REQUIREMENT)]
    for name, quantity, before, after, *_ in impact_cells(Impact(rows=tuple(rows[:_MOST_DRAWBACKS]), unchanged=0)):
        yield f"worse: {quantity} of {name}: {before} -> {after}"
    if len(rows) > _MOST_DRAWBACKS:
        yield f"worse: {counted(len(rows) - _MOST_DRAWBACKS, 'other figure')}"


def _tried(result: Optimization) -> Sentences:
    search = result.search
    shown = f", {len(result.proposals):,} shown" if len(search.best) > len(result.proposals) else ""
    rows = [("in the space", result.space.size, ""), ("judged by the analysis", search.tried, "")]
    rows += [("  meet all limits", len(search.best), shown)]
    rows += [("  unknown whether they do", search.undecided, "")] if search.undecided else []
    rows += [("excluded by lower bounds", search.excluded, "")] if search.excluded else []
    rows += [(f"not allowed: {rule}", number, "") for rule, number in search.broken.items()]
    width = max(len(name) for name, _, _ in rows)
    return Sentences([f"{name:<{width}}  {_count(number):>7}{remark}" for name, number, remark in rows])


def _count(count: int) -> str:
    """A number of designs, which may be very large."""
    return f"{count:,}" if count < _LONG else number_text(count)


def optimization_line(result: Optimization) -> str:
    """What the search found and what it proves."""
    search = result.search
    of = f"{search.tried:,} judged out of {_count(result.space.size)}"
    match search.conclusion:
        case Conclusion.OPTIMAL if not search.best[0].candidate:
            return f"Nothing needs to change: the present design meets all {_demanded(result)}{_and_best(result)}"
        case Conclusion.OPTIMAL:
            proved = "" if search.best[0].is_exact and not search.undecided else " that is proved to meet all limits"
            return f"Optimal: no allowed design{proved} is better than proposal 1: {search.proof}"
        case Conclusion.NONE:
            return f"None exists: no allowed design meets all limits: {search.proof}"
        case Conclusion.BEST_FOUND:
            return f"Best found, not proved to be optimal: {_why_open(result)}; {of}"
    return f"None found, which proves nothing: {_why_open(result)}; {of}"


def is_met(result: Optimization) -> bool:
    """Whether a design that meets all limits was found."""
    return any(each.feasible is Feasibility.YES for each in result.search.best)


def _why_open(result: Optimization) -> str:
    """Why the search proves nothing."""
    search = result.search
    meet = "meets" if search.undecided == 1 else "meet"
    unknown = f"it is unknown whether {counted(search.undecided, 'design')} {meet} all limits" if search.undecided else ""
    return "; ".join(filter(None, (search.ended, unknown))) or "not all designs were judged"


def _demanded(result: Optimization) -> str:
    is_limited = result.limits or any(each.limit is not None for each in result.before.requirements)
    return "limits" if is_limited else "deadlines, and nothing else is demanded (add what must hold with --limit)"


def _and_best(result: Optimization) -> str:
    if result.goals[0].name == CHANGES:
        return "; to improve it, state a goal, e.g. --goal latency"
    return f", and none is better: {result.search.proof}"


#: More variants are for a table in a file, and more quantities, too.
_MOST_VARIANTS, _MOST_COLUMNS = 50, 4
#: What is stated or follows from others is not shown unless somebody asks for it.
_DEFAULTS_WITHOUT = (".verdict", ".deadline_ps", ".limit_ps", ".margin_ps", SCHEDULABLE)


def sweep_document(result: SweepResult) -> ResultDocument:
    """The variants with what is computed for them, and for how many everything is met."""
    columns = _columns(result)
    shown = result.outcomes[:_MOST_VARIANTS]
    targets = [f"{sweep.object}.{sweep.key}" for sweep in result.plan.sweeps]
    quantities = (f"{'~' * number}>{_heading(column)}" for number, column in enumerate(columns))
    titles = (*(f">{target}" for target in targets), *quantities, SCHEDULABLE)
    return document(
        [
            section(
                "",
                table("", titles, (_variant(outcome, columns) for outcome in shown)),
                Sentences(list(_hidden(result, columns))),
            )
        ],
        sweep_line(result),
    )


def _hidden(result: SweepResult, columns: Sequence[str]) -> Iterator[str]:
    if (more := len(result.outcomes) - _MOST_VARIANTS) > 0:
        yield f"{counted(more, 'more variant')} not shown; write all to a file with --table FILE"
    hidden = [name for name in result.changing if name not in (*columns, SCHEDULABLE)]
    if hidden and not result.shown:
        others = counted(len(hidden), "other result")
        yield f"{others} that change not shown; choose with --quantity, or write all with --table FILE"


def sweep_line(result: SweepResult) -> str:
    """For how many variants everything is met for certain, and for how many not."""
    planned = len(result.plan.runs)
    of = counted(planned, "variant")
    parts = [f"yes in {len(result.schedulable):,} of {of}"]
    parts += [f"no in {number:,}"] if (number := len(result.with_verdict(Schedulable.NO))) else []
    parts += [f"unknown in {number:,}"] if (number := len(result.with_verdict(Schedulable.UNKNOWN))) else []
    parts += [f"{len(result.failed):,} failed"] if result.failed else []
    parts += [f"{planned - len(result.outcomes):,} not finished"] if not result.is_complete else []
    sample = f"; a random sample of {result.plan.total:,} combinations" if planned < result.plan.total else ""
    return f"Schedulable: {', '.join(parts)}{sample}"


def _columns(result: SweepResult) -> Sequence[str]:
    """The chosen quantities, or the first ones that change."""
    growth = [GROWTH] if GROWTH in result.quantities else []
    if result.shown:
        return [*(result.column(name) for name in result.shown), *growth]
    numbers = [name for name in result.changing if not name.endswith(_DEFAULTS_WITHOUT)]
    return [*(name for name in numbers if name != GROWTH)][:_MOST_COLUMNS] + growth


def _heading(column: str) -> str:
    """The name of the object as it is, and the quantity in words."""
    name, _, quantity = column.removesuffix("_ps").rpartition(".")
    return f"{name} {words(quantity)}".strip()


def _variant(outcome: RunOutcome, columns: Sequence[str]) -> tuple[str, ...]:
    values = (change.value for change in outcome.run.changes)
    cells = ("" if outcome.error else _computed(name, outcome.record.get(name)) for name in columns)
    return (*values, *cells, f"failed: {outcome.error}" if outcome.error else str(outcome.record.get(SCHEDULABLE, "")))


def _computed(column: str, value: Value) -> str:
    if value is None:
        return UNKNOWN
    if isinstance(value, str):
        return value
    if column.endswith("_ps"):
        return at_most(Fraction(value))
    number = Fraction(value)
    is_lower = any(word in column for word in ("best", "min", "margin"))
    return number_text(number if number.denominator == 1 else rounded(number, Rounding.DOWN if is_lower else Rounding.UP, 1))
