"""The outcome of a search for a better design, for people."""

from __future__ import annotations

import shlex
from collections.abc import Iterator
from fractions import Fraction

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.impact import Impact, ImpactRow, ResultPart
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.processes import RequirementResult
from amalthea_uros.design.optimize.problem import Feasibility
from amalthea_uros.design.optimize.quantities import Amount, AmountKind, Range, dimension
from amalthea_uros.design.proposals import DesignProposal, LimitRow
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.report.optimized import closing_line, count_text, goal_text, limit_text, space_lines
from amalthea_uros.report.wording.cells import load_text
from amalthea_uros.report.wording.impact import impact_cells
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.optimize import Optimization
from amalthea_uros.units import Rounding, Time, rounded_time_text

_HEADINGS = ("what", "quantity", "now", "proposed", "limit", "margin", "verdict")
_RIGHT = (2, 3, 4, 5)
#: Further drawbacks are counted.
_MOST_DRAWBACKS = 6


def write(result: Optimization, terminal: Terminal) -> None:
    """Write what was asked, the present design, the proposals with all their effects, and what the search proves."""
    _question(result, terminal)
    for number, proposal in enumerate(result.proposals, start=1):
        _proposal(result, number, proposal, terminal)
    _tried(result, terminal)
    terminal.heading(closing_line(result))


def write_closing(result: Optimization, terminal: Terminal) -> None:
    """Write the outcome only."""
    terminal.line(closing_line(result))


def _question(result: Optimization, terminal: Terminal) -> None:
    terminal.line(terminal.style("Search", "1"))
    rows = [("may change", line) for line in space_lines(result.space)] or [("may change", "nothing")]
    rows.append(("must hold", "all deadlines, requirements and constraints of the model"))
    rows += [("", limit_text(limit)) for limit in result.limits]
    rows += [("minimised" if not number else "then", goal_text(goal)) for number, goal in enumerate(result.goals)]
    rows.append(("now", _present(result)))
    before = ""
    for name, text in rows:
        terminal.line(f"  {'' if name == before else name:<10}  {text}")
        before = name


def _present(result: Optimization) -> str:
    present = result.present
    match present.feasible:
        case Feasibility.YES:
            return "all limits are met"
        case Feasibility.NO:
            return f"not met: {', '.join(present.violations) or 'something is overloaded'}"
    return f"unknown: {', '.join(present.violations) or 'nothing is demanded of the model'}"


def _proposal(result: Optimization, number: int, proposal: DesignProposal, terminal: Terminal) -> None:
    claim = "exact" if proposal.evaluation.is_exact else "with safe bounds"
    count = counted(proposal.evaluation.changes, "changed value") if proposal.differences else "the design as it is"
    terminal.heading(f"Proposal {number}: {count}, proved by the analysis ({claim})")
    for difference in proposal.differences:
        terminal.line(f"  {difference}")
    rows = [
        *_requirements(result.before, proposal.analysis),
        *map(_limit, proposal.limits),
        *_loads(result.before, proposal.analysis),
    ]
    terminal.table(_HEADINGS, rows, right=_RIGHT)
    _worse(proposal, terminal)
    if proposal.rebuilt is not None:
        terminal.line(f"  to see all effects, write it: add -o FILE.yaml --proposal {number}, then amuros analyze FILE.yaml")
    elif proposal.changes:
        files = " ".join(shlex.quote(str(path)) for path in result.paths) or "FILE"
        terminal.line(f"  to see all effects: amuros analyze {files} {shlex.join(proposal.options)}")


def _requirements(before: Analysis, after: Analysis) -> Iterator[tuple[str, ...]]:
    for old, new in zip(before.requirements, after.requirements, strict=True):
        if new.limit is not None:
            sign = "<=" if new.is_upper else ">="
            yield (
                new.object,
                new.quantity.replace("_", " "),
                _value(old),
                _value(new),
                f"{sign} {_time(new.limit)}",
                "-" if new.margin is None else _time(new.margin, Rounding.DOWN),
                str(new.verdict) if new.verdict is old.verdict else f"{old.verdict} -> {new.verdict}",
            )


def _value(requirement: RequirementResult) -> str:
    if requirement.value is None:
        return "unbounded" if requirement.verdict is Verdict.UNBOUNDED else "unknown"
    return _time(requirement.value, Rounding.UP if requirement.is_upper else Rounding.DOWN, requirement.limit)


def _limit(row: LimitRow) -> tuple[str, ...]:
    limit = row.limit
    margin = None if row.after.upper is None else limit.maximum - row.after.upper
    verdicts = {Feasibility.YES: "met", Feasibility.NO: "missed", Feasibility.UNKNOWN: "unknown"}
    old, new = verdicts[limit.verdict(row.before)], verdicts[row.verdict]
    return (
        limit.object,
        limit.quantity.replace("_", " "),
        _upper(row.before, limit.quantity),
        _upper(row.after, limit.quantity),
        f"{'<' if limit.is_below else '<='} {_amount(limit.maximum, limit.quantity)}",
        "-" if margin is None else _amount(margin, limit.quantity),
        new if old == new else f"{old} -> {new}",
    )


def _loads(before: Analysis, after: Analysis) -> Iterator[tuple[str, ...]]:
    for old, new in zip(before.processors, after.processors, strict=True):
        if old.worst or new.worst:
            yield new.name, "worst load", *(_load(core.worst) for core in (old, new)), "", "", ""


def _worse(proposal: DesignProposal, terminal: Terminal) -> None:
    """What gets worse, apart from what the table has."""
    rows = [row for row in proposal.worse if not (row.part is ResultPart.CORE or row.part is ResultPart.REQUIREMENT)]
    for text in map(_drawback, rows[:_MOST_DRAWBACKS]):
        terminal.line(f"  worse: {text}")
    if len(rows) > _MOST_DRAWBACKS:
        terminal.line(f"  worse: {counted(len(rows) - _MOST_DRAWBACKS, 'other figure')}")


def _drawback(row: ImpactRow) -> str:
    (name, quantity, before, after, *_rest) = impact_cells(Impact(rows=(row,), unchanged=0))[0]
    return f"{quantity} of {name}: {before} -> {after}"


def _tried(result: Optimization, terminal: Terminal) -> None:
    search = result.search
    shown = f", {len(result.proposals):,} shown" if len(search.best) > len(result.proposals) else ""
    rows = [("in the space", result.space.size, ""), ("judged by the analysis", search.tried, "")]
    rows += [("  meet all limits", len(search.best), shown)]
    rows += [("  unknown whether they do", search.undecided, "")] if search.undecided else []
    rows += [("excluded by lower bounds", search.excluded, "")] if search.excluded else []
    rows += [(f"not allowed: {rule}", number, "") for rule, number in search.broken.items()]
    terminal.heading("Designs")
    width = max(len(name) for name, _, _ in rows)
    for name, number, remark in rows:
        terminal.line(f"  {name:<{width}}  {count_text(number):>7}{remark}")


def _upper(found: Range, quantity: str) -> str:
    return "unknown" if found.upper is None else _amount(found.upper, quantity)


def _amount(value: Amount, quantity: str) -> str:
    if dimension(quantity) is AmountKind.SHARE:
        return load_text(Fraction(value), Rounding.UP)
    return _time(int(value), Rounding.UP)


def _time(value: Time, rounding: Rounding = Rounding.NEAREST, limit: Time | None = None) -> str:
    return rounded_time_text(value, rounding, limit)


def _load(load: Fraction | None) -> str:
    return "unknown" if load is None else load_text(load, Rounding.UP)
