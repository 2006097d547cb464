"""The fields of explanations: what a response time or a latency consists of, and what would shorten it."""

from __future__ import annotations

from typing import Any

from amalthea_uros.analyze.results.explanations import (
    CallbackExplanation,
    ChainExplanation,
    Execution,
    ExecutionShare,
    LatencyCause,
    ProcessExplanation,
    ProcessHop,
)
from amalthea_uros.design.improvements import Improvement, Improvements
from amalthea_uros.report.fields.declaration import declare, json_of
from amalthea_uros.report.wording.chains import cause_text
from amalthea_uros.services.analyze import Explanation


def _named(*names: str) -> Any:
    """A function that reads attributes of an object under their names."""
    return lambda found: {name: getattr(found, name) for name in names}


def _hops(explanation: ChainExplanation) -> list[dict[str, Any]]:
    return [
        {
            **json_of(hop),
            "share": float(explanation.share(hop.wait + hop.run)),
            "wait_causes": [_cause(cause, hop) for cause in hop.wait_causes],
            "run_causes": [_cause(cause, hop) for cause in hop.run_causes],
            "executions": json_of(hop.executions),
        }
        for hop in explanation.hops
    ]


def _cause(cause: LatencyCause, hop: ProcessHop) -> dict[str, Any]:
    return {
        "kind": cause.kind,
        "time_ps": cause.time,
        "process": cause.process or None,
        "jobs": cause.jobs or None,
        "terms": {f"{name}_ps": time for name, time in cause.terms},
        "reason": cause_text(cause, hop),
    }


declare(Explanation, *("name", "process", "callbacks", "chain", "improvements"))
declare(
    ProcessExplanation,
    ("wcrt_ps", "process.response.worst"),
    ("wcet_ps", "process.wcet"),
    ("reason", "process.reason"),
    (
        "interference",
        lambda found: [{"process": each.name, "jobs": each.jobs, "time_ps": each.time} for each in found.shares],
    ),
    "execution",
    ("loads", lambda found: map(_named("name", "priority", "utilisation"), found.loads)),
    ("load", lambda found: found.load if found.loads else None),
    "supply",
    ("callbacks", lambda found: [each.name for each in found.callbacks]),
    *("worst_job", "in_worst_job"),
    ("origins", lambda found: map(_named("process", "kind", "reason", "remedy"), found.origins)),
)
declare(
    CallbackExplanation,
    ("name", "callback.name"),
    ("process", "callback.process"),
    ("wcrt_ps", "callback.response.worst"),
    ("deadline_ps", "callback.deadline"),
    ("reason", "callback.reason"),
    *("execution", "handles"),
)
declare(
    ExecutionShare,
    *("name", "is_runnable", "calls"),
    ("counter", lambda share: None if share.counter is None else _named("prescaler", "offset")(share.counter)),
    *("time_ps", "reason"),
)
declare(
    ChainExplanation,
    "quantity",
    ("value_ps", "value.value"),
    ("claim", "value.claim"),
    ("method", "value.method"),
    ("source", "value.source"),
    "route",
    ("hops", _hops),
    ("until_overwritten_ps", "overwritten"),
    "reason",
    (
        "requirements",
        lambda found: [
            {
                "name": each.name,
                "quantity": each.quantity,
                "limit_ps": each.limit,
                "verdict": each.verdict,
                "margin_ps": each.margin,
            }
            for each in found.requirements
        ],
    ),
)
declare(
    ProcessHop,
    *("process", "job", "release_ps", "start_ps", "read_ps", "write_ps", "wait_ps", "run_ps", "core", "period_ps", "one_in"),
)
declare(Execution, *("core", "process", "job", "begin_ps", "end_ps"))
declare(Improvements, *("quantity", "tried", "untried", "found"))
declare(
    Improvement,
    ("text", "change.text"),
    ("options", "change.options"),
    ("changes", "differences"),
    ("before_ps", "before"),
    ("after_ps", "after"),
    *("claim", "is_safe", "is_enough"),
    ("drawbacks", lambda found: map(_named("name", "before", "after", "is_verdict"), found.drawbacks)),
    (
        "latencies",
        lambda found: {
            quantity: {"before_ps": before, "after_ps": after} for quantity, (before, after) in found.latencies.items()
        },
    ),
)
