"""The fields of explanations: what a response time or a latency consists of, and what would shorten it."""

from __future__ import annotations

from typing import Any

from amalthea_uros.analyze.results.explanations import (
    CallbackExplanation,
    ChainExplanation,
    Execution,
    ExecutionShare,
    ProcessExplanation,
    ProcessHop,
)
from amalthea_uros.design.improvements import Improvement, Improvements
from amalthea_uros.report.fields.declaration import Field, declare, json_of, list_of, record
from amalthea_uros.report.wording.chains import cause_text
from amalthea_uros.services.analyze import Explanation


def _hops(explanation: ChainExplanation) -> list[dict[str, Any]]:
    return [json_of(hop) | {"share": float(explanation.share(hop.wait + hop.run))} | _parts(hop) for hop in explanation.hops]


def _parts(hop: ProcessHop) -> dict[str, Any]:
    """Why a hop takes its time, and what executes meanwhile."""
    fields: tuple[Field, ...] = (
        *("kind", "time_ps"),
        ("process", lambda cause: cause.process or None),
        ("jobs", lambda cause: cause.jobs or None),
        ("terms", lambda cause: {f"{name}_ps": time for name, time in cause.terms}),
        ("reason", lambda cause: cause_text(cause, hop)),
    )
    causes: tuple[Field, ...] = (
        ("wait_causes", list_of("wait_causes", *fields)),
        ("run_causes", list_of("run_causes", *fields)),
    )
    return record(hop, (*causes, "executions"))


declare(Explanation, *("name", "process", "callbacks", "chain", "improvements"))
declare(
    ProcessExplanation,
    ("wcrt_ps", "process.response.worst"),
    ("wcet_ps", "process.wcet"),
    ("reason", "process.reason"),
    ("interference", list_of("shares", ("process", "name"), "jobs", "time_ps")),
    "execution",
    ("loads", list_of("loads", "name", "priority", "utilisation")),
    ("load", lambda found: found.load if found.loads else None),
    "supply",
    ("callbacks", lambda found: [each.name for each in found.callbacks]),
    *("worst_job", "in_worst_job"),
    ("origins", list_of("origins", "process", "kind", "reason", "remedy")),
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
    ("counter", lambda share: None if share.counter is None else record(share.counter, ("prescaler", "offset"))),
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
    ("requirements", list_of("requirements", "name", "quantity", "limit_ps", "verdict", "margin_ps")),
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
    ("drawbacks", list_of("drawbacks", "name", "before", "after", "is_verdict")),
    (
        "latencies",
        lambda found: {
            quantity: {"before_ps": before, "after_ps": after} for quantity, (before, after) in found.latencies.items()
        },
    ),
)
