"""The explanation of a response time or of the latency of a chain for programs."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from amalthea_uros.analyze.explanations.chains import ChainExplanation, ProcessHop
from amalthea_uros.analyze.explanations.execution_shares import ExecutionShare
from amalthea_uros.analyze.explanations.hop_causes import Execution, LatencyCause
from amalthea_uros.analyze.explanations.processes import CallbackExplanation, ProcessExplanation
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.report.chain_causes import cause_text
from amalthea_uros.report.json import changes
from amalthea_uros.report.json.executors import handle_json
from amalthea_uros.services.analyze import Explanation

if TYPE_CHECKING:
    from amalthea_uros.services.improvements import Improvement, Improvements


def content(explanation: Explanation) -> dict[str, Any]:
    """Everything that is explained; null for what has another name."""
    return {
        "name": explanation.name,
        "process": None if explanation.process is None else _process_json(explanation.process),
        "callbacks": [_callback_json(callback) for callback in explanation.callbacks],
        "chain": None if explanation.chain is None else _chain_json(explanation.chain),
        "improvements": None if explanation.improvements is None else _improvements_json(explanation.improvements),
    }


def _process_json(explanation: ProcessExplanation) -> dict[str, Any]:
    response = explanation.process.response
    return {
        "wcrt_ps": response.worst if response else None,
        "wcet_ps": explanation.process.wcet,
        "reason": explanation.process.reason,
        "interference": [{"process": share.name, "jobs": share.jobs, "time_ps": share.time} for share in explanation.shares],
        "execution": [_share_json(share) for share in explanation.execution],
        "loads": [
            {"name": load.name, "priority": load.priority, "utilisation": _number(load.utilisation)}
            for load in explanation.loads
        ],
        "load": _number(explanation.load) if explanation.loads else None,
        "supply": _number(explanation.supply),
        "callbacks": [each.name for each in explanation.callbacks],
        "worst_job": explanation.worst_job,
        "in_worst_job": list(explanation.in_worst_job),
        "origins": [
            {"process": each.process, "kind": each.kind, "reason": each.reason, "remedy": each.remedy}
            for each in explanation.origins
        ],
    }


def _callback_json(explanation: CallbackExplanation) -> dict[str, Any]:
    callback = explanation.callback
    return {
        "name": callback.name,
        "process": callback.process,
        "wcrt_ps": callback.response.worst if callback.response is not None else None,
        "deadline_ps": callback.deadline,
        "reason": callback.reason,
        "execution": [_share_json(share) for share in explanation.execution],
        "handles": [handle_json(handle) for handle in explanation.handles],
    }


def _share_json(share: ExecutionShare) -> dict[str, Any]:
    return {
        "name": share.name,
        "is_runnable": share.is_runnable,
        "calls": share.calls,
        "counter": _counter_json(share.counter),
        "time_ps": share.time,
        "reason": share.reason,
    }


def _counter_json(counter: Counter | None) -> dict[str, int | None] | None:
    return None if counter is None else {"prescaler": counter.prescaler, "offset": counter.offset}


def _number(value: Fraction | None) -> float | None:
    return None if value is None else float(value)


def _chain_json(explanation: ChainExplanation) -> dict[str, Any]:
    value = explanation.value
    return {
        "quantity": explanation.quantity,
        "value_ps": value.value if value else None,
        "claim": value.claim if value else None,
        "method": value.method if value else None,
        "source": value.source if value else None,
        "route": explanation.route,
        "hops": [
            {
                "process": hop.process,
                "job": hop.job,
                "release_ps": hop.release,
                "start_ps": hop.start,
                "read_ps": hop.read,
                "write_ps": hop.write,
                "wait_ps": hop.wait,
                "run_ps": hop.run,
                "core": hop.core,
                "period_ps": hop.period,
                "one_in": hop.one_in,
                "share": float(explanation.share(hop.wait + hop.run)),
                "wait_causes": [_cause_json(cause, hop) for cause in hop.wait_causes],
                "run_causes": [_cause_json(cause, hop) for cause in hop.run_causes],
                "executions": [_execution_json(each) for each in hop.executions],
            }
            for hop in explanation.hops
        ],
        "until_overwritten_ps": explanation.overwritten,
        "reason": explanation.reason,
        "requirements": [
            {
                "name": each.name,
                "quantity": each.quantity,
                "limit_ps": each.limit,
                "verdict": each.verdict,
                "margin_ps": each.margin,
            }
            for each in explanation.requirements
        ],
    }


def _cause_json(cause: LatencyCause, hop: ProcessHop) -> dict[str, Any]:
    return {
        "kind": cause.kind,
        "time_ps": cause.time,
        "process": cause.process or None,
        "jobs": cause.jobs or None,
        "terms": {f"{name}_ps": time for name, time in cause.terms},
        "reason": cause_text(cause, hop),
    }


def _execution_json(execution: Execution) -> dict[str, Any]:
    return {
        "core": execution.core,
        "process": execution.process,
        "job": execution.job,
        "begin_ps": execution.begin,
        "end_ps": execution.end,
    }


def _improvements_json(improvements: Improvements) -> dict[str, Any]:
    return {
        "quantity": improvements.quantity,
        "tried": improvements.tried,
        "untried": improvements.untried,
        "found": [_improvement_json(each) for each in improvements.found],
    }


def _improvement_json(improvement: Improvement) -> dict[str, Any]:
    change = improvement.change
    return {
        "text": change.text,
        "options": list(change.options),
        "changes": changes.content(improvement.differences),
        "before_ps": improvement.before,
        "after_ps": improvement.after,
        "claim": improvement.claim,
        "is_safe": improvement.is_safe,
        "drawbacks": [
            {"name": each.name, "before": each.before, "after": each.after, "is_verdict": each.is_verdict}
            for each in improvement.drawbacks
        ],
        "latencies": {
            quantity: {"before_ps": before, "after_ps": after} for quantity, (before, after) in improvement.latencies.items()
        },
    }
