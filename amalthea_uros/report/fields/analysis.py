"""The fields of an analysis and its parts."""

from __future__ import annotations

from typing import Any

from amalthea_uros.analyze.priorities.assignment import Proposal
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import ChainResult, LatencyValue
from amalthea_uros.analyze.results.needs import ExecutionOnCores
from amalthea_uros.analyze.results.processes import CallbackResult, Metric, ProcessorResult, ProcessResult, RequirementResult
from amalthea_uros.analyze.sensitivity import Sensitivity
from amalthea_uros.design.missing_values import MissingValues
from amalthea_uros.executors.results import ExecutorResult, HandleResult, Hop, Loss, TimePart
from amalthea_uros.report.fields.changes import CHANGED
from amalthea_uros.report.fields.declaration import ABSENT, Field, declare, given, group, json_of
from amalthea_uros.report.wording.closing_line import closing_line
from amalthea_uros.report.wording.findings import joined
from amalthea_uros.services.analyze import AnalysisResult

_BCRT: Field = ("bcrt_ps", "response.best")
_WCRT: Field = ("wcrt_ps", "response.worst")
_METHOD: tuple[Field, ...] = (("method", "response.method"), ("source", "response.source"), ("claim", "response.claim"))
_METRICS: tuple[Field, ...] = (
    ("mean_response_ps", "metrics.response_time.mean"),
    ("response_jitter_ps", "metrics.response_time.jitter"),
    "metrics",
)


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


def _chains(result: AnalysisResult) -> list[dict[str, Any]]:
    """The chains, with the values of all methods if they are wanted."""
    all_values = ({"values": json_of(chain.all_values)} if result.all_methods else {} for chain in result.analysis.chains)
    return [json_of(chain) | values for chain, values in zip(result.analysis.chains, all_values, strict=True)]


def _explanation(result: AnalysisResult) -> object:
    """The explanation, whose classes are declared only where there is one."""
    if result.explanation is None:
        return ABSENT
    from amalthea_uros.report.fields import explanation  # noqa: F401

    return result.explanation


def _terms(process: ProcessResult) -> dict[str, int]:
    response = process.response
    return {f"{term.replace(' ', '_')}_ps": value for term, value in response.terms.items()} if response else {}


declare(
    AnalysisResult,
    ("model", lambda result: joined(result.paths)),
    ("assumptions", "analysis.assumptions"),
    "findings",
    ("processors", "analysis.processors"),
    ("processes", "analysis.processes"),
    ("callbacks", "analysis.callbacks"),
    ("executors", "analysis.executors"),
    ("host", "analysis.host"),
    ("chains", _chains),
    ("requirements", "analysis.requirements"),
    ("summary", lambda result: summary_json(result.analysis)),
    *CHANGED,
    ("explanation", _explanation),
    ("sensitivity", given("sensitivity")),
    ("priorities", given("proposals")),
    ("missing", given("missing")),
)
declare(MissingValues, ("set", lambda missing: list(map(str, missing.changes))), "gained", "lacks_schedulers")
declare(
    ProcessorResult,
    "name",
    ("utilisation", group(("bcet", "best"), ("acet", "mean"), ("wcet", "worst"), ("wcet_at_least", "at_least"))),
)
declare(
    ProcessResult,
    "name",
    ("kind", lambda process: "isr" if process.is_isr else "task"),
    *("processor", "priority", "preemption", "bcet_ps", "acet_ps", "wcet_ps"),
    ("utilisation", "share"),
    _BCRT,
    _WCRT,
    "deadline_ps",
    ("deadline_is_period", "is_implicit"),
    *("verdict", "failure", "reason"),
    *_METHOD,
    ("terms", _terms),
    *_METRICS,
    "needs",
)
declare(
    ExecutionOnCores,
    *("core_type", "cores"),
    ("clock_hz", "frequency"),
    *("bcet_ps", "acet_ps", "wcet_ps", "least_ticks", "mean_ticks", "most_ticks"),
    ("utilisation", "load"),
    ("least_clock_hz", "least_frequency"),
    "reason",
)
declare(CallbackResult, "name", "process", _BCRT, _WCRT, "deadline_ps", "reason", *_METHOD, *_METRICS)
declare(Metric, "min_ps", ("avg_ps", "mean"), "max_ps", "claim")
declare(
    ChainResult,
    *("name", "communication", "routes", "why", "reason", "remedy", "start", "end", "hops", "worst_if_not_lost_ps"),
    *("loss", "assumptions", "values"),
)
declare(Hop, *("kind", "name", "best_ps", "worst_ps", "share", "source", "reason", "remedy", "parts"))
declare(LatencyValue, *("quantity", "value_ps", "claim", "method", "source"))
declare(
    RequirementResult,
    *("name", "object", "quantity", "limit_ps", "value_ps", "lower_ps", "upper_ps", "margin_ps", "verdict", "reason"),
)
declare(
    ExecutorResult,
    *("name", "task"),
    ("round", group(("min_ps", "round.least"), ("max_ps", "round.most"))),
    ("loop", group(("min_ps", "loop.least"), ("max_ps", "loop.most"))),
    *("reason", "handles"),
)
declare(
    HandleResult,
    *("name", "kind"),
    ("callback", "runnable"),
    "interval_ps",
    _BCRT,
    _WCRT,
    ("lateness_ps", "lateness.most"),
    ("claim", "response.claim"),
    ("method", "response.method"),
    ("source", "response.source"),
    ("reason", "response.reason"),
    *("lost", "terms"),
)
declare(Loss, *("what", "is_certain", "most", "sequence"))
declare(TimePart, "name", ("min_ps", "least"), ("max_ps", "most"), "why")
declare(
    Sensitivity,
    *("everything", "processes"),
    ("longest_ps", lambda found: {name: found.longest(name) for name in found.processes}),
)
declare(Proposal, ("processor", "core"), "current", ("proposed", "priorities"), *("outcome", "reason"))
