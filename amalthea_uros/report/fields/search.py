"""The fields of searches for a better design, and of sweeps."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from amalthea_uros.design.campaign.sweeps import SweepResult
from amalthea_uros.design.optimize.problem import DesignEvaluation, Goal
from amalthea_uros.design.optimize.quantities import Amount, AmountKind, Range, dimension
from amalthea_uros.design.proposals import DesignProposal, LimitRow
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.report.documents.search import optimization_line, sweep_line
from amalthea_uros.report.fields.analysis import summary_json
from amalthea_uros.report.fields.declaration import ALSO, declare, group, json_of, list_of
from amalthea_uros.report.wording.findings import joined
from amalthea_uros.services.optimize import Optimization

_VERDICTS = {"yes": "met", "no": "missed", "unknown": "unknown"}
_LIMIT_COLUMNS_LEFT_OUT = ("strict", "reason", "exact")


def proposal_rows(result: Optimization) -> Iterator[dict[str, Any]]:
    """A row for each proposal."""
    for number, proposal in enumerate(result.proposals, start=1):
        yield {
            "proposal": number,
            "set": " ".join(map(str, proposal.changes)),
            **_objective(result.goals, proposal.evaluation),
            "proof": _proof(proposal),
            "schedulable": proposal.analysis.summary.schedulable,
        }


def demand_rows(proposal: DesignProposal) -> Iterator[dict[str, Any]]:
    """A row for each requirement of the model, and for each limit beside them."""
    for each in map(json_of, proposal.analysis.requirements):
        yield {name: each[name] for name in ("object", "quantity", "limit_ps", "value_ps", "verdict")}
    for row in map(json_of, proposal.limits):
        yield {name: value for name, value in row.items() if name not in _LIMIT_COLUMNS_LEFT_OUT}


def _proof(proposal: DesignProposal) -> str:
    return "exact" if proposal.evaluation.is_exact else "bound"


def _proposals(result: Optimization) -> list[dict[str, Any]]:
    """The designs that meet all limits."""
    return [
        {
            "changes": json_of(proposal.differences),
            "set": list(map(str, proposal.changes)),
            "objective": _objective(result.goals, proposal.evaluation),
            "proof": _proof(proposal),
            "summary": summary_json(proposal.analysis),
            "requirements": json_of(proposal.analysis.requirements),
            "limits": json_of(proposal.limits),
            "impact": json_of(proposal.impact),
        }
        for proposal in result.proposals
    ]


def _objective(goals: tuple[Goal, ...], evaluation: DesignEvaluation) -> dict[str, Any]:
    return dict(_goal_value(goal, value) for goal, value in zip(goals, evaluation.values, strict=True))


def _goal_value(goal: Goal, value: Fraction | None) -> tuple[str, float | int | None]:
    if goal.unit == "ps":
        return f"{goal.name}_ps", None if value is None else int(value)
    return goal.name, None if value is None else float(value)


def _maximum(row: LimitRow) -> dict[str, Any]:
    unit = _unit(row)
    return {f"limit{unit}": _amount(row.limit.maximum, unit)}


def _values(row: LimitRow) -> dict[str, Any]:
    unit = _unit(row)
    return {f"before{unit}": _upper(row.before, unit), f"value{unit}": _upper(row.after, unit)}


def _unit(row: LimitRow) -> str:
    return "_ps" if dimension(row.limit.quantity) is AmountKind.TIME else ""


def _upper(found: Range, unit: str) -> float | int | None:
    return None if found.upper is None else _amount(found.upper, unit)


def _amount(value: Amount, unit: str) -> float | int:
    return int(value) if unit else float(value)


declare(
    Optimization,
    ("model", lambda result: joined(result.paths)),
    "findings",
    (
        "space",
        group(
            ("size", "space.size"),
            ("choices", list_of("space.choices", ("key", "target"), "kind", "options")),
            ("orders", list_of("space.orders", "scheduler", "tasks")),
        ),
    ),
    ("goals", lambda result: [goal.name for goal in result.goals]),
    (
        "present",
        lambda result: {"feasible": result.present.feasible, "objective": _objective(result.goals, result.present)},
    ),
    ("proposals", _proposals),
    (
        "front",
        lambda result: [
            {"set": map(str, each.candidate), "objective": _objective(result.goals, each)} for each in result.search.front
        ],
    ),
    ("conclusion", "search.conclusion"),
    ("proof", "search.proof"),
    ("ended", "search.ended"),
    ("tried", "search.tried"),
    ("excluded", "search.excluded"),
    ("not_allowed", "search.broken"),
    ("feasible", lambda result: len(result.search.best)),
    ("undecided", "search.undecided"),
    ("text", optimization_line),
)
declare(
    LimitRow,
    ("object", "limit.object"),
    ("quantity", "limit.quantity"),
    (ALSO, _maximum),
    ("strict", "limit.is_below"),
    ("reason", "limit.reason"),
    (ALSO, _values),
    ("exact", "after.is_exact"),
    ("verdict", lambda row: _VERDICTS[row.verdict]),
)
declare(
    SweepResult,
    ("model", "source"),
    "findings",
    ("changes", "differences"),
    ("sweeps", list_of("plan.sweeps", ("key", lambda each: f"{each.object}.{each.key}"), "values")),
    ("combinations", "plan.total"),
    ("seed", "plan.seed"),
    ("planned_variants", lambda result: len(result.plan.runs)),
    ("variants", "rows"),
    (
        "summary",
        lambda result: {
            "schedulable": len(result.schedulable),
            "not_schedulable": len(result.with_verdict(Schedulable.NO)),
            "unknown": len(result.with_verdict(Schedulable.UNKNOWN)),
            "failed": len(result.failed),
            "text": sweep_line(result),
        },
    ),
)
