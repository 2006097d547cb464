"""The outcome of a search for a better design, for programs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Any

from amalthea_uros.design.optimize.problem import Evaluation, Goal
from amalthea_uros.design.optimize.quantities import Amount, Dimension, Range, dimension
from amalthea_uros.design.optimize.space import Space
from amalthea_uros.report.findings import finding_json, joined
from amalthea_uros.report.json import changes, impact
from amalthea_uros.report.json.analysis_result import requirement_json, summary_json
from amalthea_uros.report.optimized import closing_line
from amalthea_uros.services.optimize import DesignProposal, LimitRow, Optimization


def content(result: Optimization) -> dict[str, Any]:
    """What was searched, what was found, and what it proves."""
    search = result.search
    return {
        "model": joined(result.paths),
        "findings": [finding_json(finding) for finding in result.findings],
        "space": _space_json(result.space),
        "goals": [goal.name for goal in result.goals],
        "present": {"feasible": result.present.feasible, "objective": _objective(result.goals, result.present)},
        "proposals": [proposal_json(proposal, result.goals) for proposal in result.proposals],
        "front": [_front_json(each, result.goals) for each in search.front],
        "conclusion": search.conclusion,
        "proof": search.proof,
        "ended": search.ended,
        "tried": search.tried,
        "excluded": search.excluded,
        "not_allowed": dict(search.broken),
        "feasible": len(search.best),
        "undecided": search.undecided,
        "text": closing_line(result),
    }


def proposal_json(proposal: DesignProposal, goals: tuple[Goal, ...]) -> dict[str, Any]:
    """A design that meets all limits."""
    return {
        "changes": changes.content(proposal.differences),
        "set": [str(change) for change in proposal.changes],
        "objective": _objective(goals, proposal.evaluation),
        "proof": _proof(proposal),
        "summary": summary_json(proposal.analysis),
        "requirements": [requirement_json(each) for each in proposal.analysis.requirements],
        "limits": [_limit_json(row) for row in proposal.limits],
        "impact": impact.content(proposal.impact),
    }


def rows_json(result: Optimization) -> Iterator[dict[str, Any]]:
    """A row for each proposal."""
    for number, proposal in enumerate(result.proposals, start=1):
        yield {
            "proposal": number,
            "set": " ".join(map(str, proposal.changes)),
            **_objective(result.goals, proposal.evaluation),
            "proof": _proof(proposal),
            "schedulable": proposal.analysis.summary.schedulable,
        }


def demands_json(proposal: DesignProposal) -> Iterator[dict[str, Any]]:
    """A row for each requirement of the model, and for each limit beside them."""
    for each in proposal.analysis.requirements:
        found = requirement_json(each)
        yield {name: found[name] for name in ("object", "quantity", "limit_ps", "value_ps", "verdict")}
    for row in proposal.limits:
        found = _limit_json(row)
        yield {name: value for name, value in found.items() if name not in ("strict", "reason", "exact")}


def _proof(proposal: DesignProposal) -> str:
    return "exact" if proposal.evaluation.is_exact else "bound"


def _space_json(space: Space) -> dict[str, Any]:
    return {
        "size": space.size,
        "choices": [{"key": choice.target, "kind": choice.kind, "options": list(choice.options)} for choice in space.choices],
        "orders": [{"scheduler": order.scheduler, "tasks": list(order.tasks)} for order in space.orders],
    }


def _objective(goals: tuple[Goal, ...], evaluation: Evaluation) -> dict[str, Any]:
    return dict(_value(goal, value) for goal, value in zip(goals, evaluation.values, strict=True))


def _value(goal: Goal, value: Fraction | None) -> tuple[str, float | int | None]:
    if goal.unit == "ps":
        return f"{goal.name}_ps", None if value is None else int(value)
    return goal.name, None if value is None else float(value)


def _front_json(evaluation: Evaluation, goals: tuple[Goal, ...]) -> Mapping[str, Any]:
    return {"set": [str(change) for change in evaluation.candidate], "objective": _objective(goals, evaluation)}


def _limit_json(row: LimitRow) -> dict[str, Any]:
    limit = row.limit
    end = "_ps" if dimension(limit.quantity) is Dimension.TIME else ""
    return {
        "object": limit.object,
        "quantity": limit.quantity,
        f"limit{end}": _amount(limit.maximum, end),
        "strict": limit.is_below,
        "reason": limit.reason,
        f"before{end}": _upper(row.before, end),
        f"value{end}": _upper(row.after, end),
        "exact": row.after.is_exact,
        "verdict": {"yes": "met", "no": "missed", "unknown": "unknown"}[row.verdict],
    }


def _upper(found: Range, end: str) -> float | int | None:
    return None if found.upper is None else _amount(found.upper, end)


def _amount(value: Amount, end: str) -> float | int:
    return int(value) if end else float(value)
