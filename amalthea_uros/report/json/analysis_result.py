"""An analysis for programs."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import ChainResult, LatencyValue
from amalthea_uros.analyze.results.processes import CallbackResult, Metric, ProcessorResult, ProcessResult
from amalthea_uros.analyze.results.requirements import RequirementResult
from amalthea_uros.report.closing_line import closing_line
from amalthea_uros.report.findings import finding_json, joined
from amalthea_uros.report.json import changes, explanation, impact
from amalthea_uros.report.json.executors import executor_json, hop_json
from amalthea_uros.services.analyze import AnalysisResult
from amalthea_uros.timing.basics.quantities import JobMetric


def content(result: AnalysisResult) -> dict[str, Any]:
    """Everything that was computed."""
    analysis = result.analysis
    found: dict[str, Any] = {
        "model": joined(result.paths),
        "assumptions": list(analysis.assumptions),
        "findings": [finding_json(finding) for finding in result.findings],
        "processors": [processor_json(processor) for processor in analysis.processors],
        "processes": [process_json(process) for process in analysis.processes],
        "callbacks": [callback_json(callback) for callback in analysis.callbacks],
        "executors": [executor_json(executor) for executor in analysis.executors],
        "chains": [_chain_json(chain, result.all_methods) for chain in analysis.chains],
        "requirements": [requirement_json(requirement) for requirement in analysis.requirements],
        "summary": summary_json(analysis),
    }
    if result.impact is not None:
        found["changes"] = changes.content(result.differences)
        found["impact"] = impact.content(result.impact)
    if result.explanation is not None:
        found["explanation"] = explanation.content(result.explanation)
    if result.sensitivity is not None:
        found["sensitivity"] = {
            "everything": _number(result.sensitivity.everything),
            "processes": {name: _number(factor) for name, factor in result.sensitivity.processes.items()},
            "longest_ps": {name: result.sensitivity.longest(name) for name in result.sensitivity.processes},
        }
    if result.proposals is not None:
        found["priorities"] = [
            {"processor": p.core, "current": p.current, "proposed": p.priorities, "outcome": p.outcome, "reason": p.reason}
            for p in result.proposals
        ]
    return found


def summary_json(analysis: Analysis) -> dict[str, Any]:
    """Whether everything is met, and what is tightest."""
    summary = analysis.summary
    tightest = summary.tightest
    return {
        "schedulable": summary.schedulable,
        "missed": summary.missed,
        "failures": len(summary.causes),
        "unknown": len(summary.unknown),
        "judged": summary.judged,
        "overloaded": [processor.name for processor in analysis.processors if processor.is_overloaded],
        "tightest": None if tightest is None else {"name": tightest.name, "margin_ps": tightest.margin},
        "text": closing_line(analysis.summary),
    }


def _number(value: Fraction | None) -> float | None:
    return None if value is None else float(value)


def processor_json(processor: ProcessorResult) -> dict[str, Any]:
    """The load of a core."""
    return {
        "name": processor.name,
        "utilisation": {
            "bcet": _number(processor.best),
            "acet": _number(processor.mean),
            "wcet": _number(processor.worst),
            "wcet_at_least": _number(processor.at_least),
        },
    }


def process_json(process: ProcessResult) -> dict[str, Any]:
    """The response time of a process, with its verdict and metrics."""
    response = process.response
    return {
        "name": process.name,
        "kind": "isr" if process.is_isr else "task",
        "processor": process.processor,
        "priority": process.priority,
        "preemption": process.preemption,
        "bcet_ps": process.bcet,
        "acet_ps": _rounded(process.acet),
        "wcet_ps": process.wcet,
        "bcrt_ps": response.best if response else None,
        "wcrt_ps": response.worst if response else None,
        "deadline_ps": process.deadline,
        "deadline_is_period": process.is_implicit,
        "verdict": process.verdict,
        "failure": process.failure,
        "reason": process.reason,
        "method": response.method if response else None,
        "source": response.source if response else None,
        "claim": response.claim if response else None,
        "terms": {f"{term.replace(' ', '_')}_ps": value for term, value in response.terms.items()} if response else {},
        **_metrics_json(process.metrics),
    }


def callback_json(callback: CallbackResult) -> dict[str, Any]:
    """The response time of a callback."""
    response = callback.response
    return {
        "name": callback.name,
        "process": callback.process,
        "bcrt_ps": response.best if response else None,
        "wcrt_ps": response.worst if response else None,
        "deadline_ps": callback.deadline,
        "reason": callback.reason,
        "method": response.method if response else None,
        "source": response.source if response else None,
        "claim": response.claim if response else None,
        **_metrics_json(callback.metrics),
    }


def _metrics_json(metrics: Mapping[JobMetric, Metric]) -> dict[str, Any]:
    response = metrics.get(JobMetric.RESPONSE_TIME)
    return {
        "mean_response_ps": _rounded(response.mean) if response else None,
        "response_jitter_ps": response.jitter if response else None,
        "metrics": {
            name: {"min_ps": metric.min, "avg_ps": _rounded(metric.mean), "max_ps": metric.max, "claim": metric.claim}
            for name, metric in metrics.items()
        },
    }


def _rounded(value: Fraction | None) -> int | None:
    return None if value is None else round(value)


def _chain_json(chain: ChainResult, all_methods: bool) -> dict[str, Any]:
    return {
        "name": chain.name,
        "communication": chain.communication,
        "routes": list(chain.routes),
        "why": chain.why,
        "reason": chain.reason,
        "remedy": chain.remedy,
        "start": chain.start,
        "end": chain.end,
        "hops": [hop_json(hop) for hop in chain.hops],
        "worst_if_not_lost_ps": chain.worst_if_not_lost,
        "loss": chain.loss,
        "assumptions": list(chain.assumptions),
        "values": [value_json(value) for value in (chain.all_values if all_methods else chain.values)],
    }


def value_json(value: LatencyValue) -> dict[str, Any]:
    """A latency of a chain by one method."""
    return {
        "quantity": value.quantity,
        "value_ps": value.value,
        "claim": value.claim,
        "method": value.method,
        "source": value.source,
    }


def requirement_json(requirement: RequirementResult) -> dict[str, Any]:
    """The verdict on a requirement or constraint."""
    return {
        "name": requirement.name,
        "object": requirement.object,
        "quantity": requirement.quantity,
        "limit_ps": requirement.limit,
        "value_ps": requirement.value,
        "lower_ps": requirement.lower,
        "upper_ps": requirement.upper,
        "margin_ps": requirement.margin,
        "verdict": requirement.verdict,
        "reason": requirement.reason,
    }
