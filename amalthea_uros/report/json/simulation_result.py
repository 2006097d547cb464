"""A simulation for programs: times are rounded to the nearest picosecond."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from amalthea_uros.report.findings import finding_json, joined
from amalthea_uros.report.json import changes, impact
from amalthea_uros.report.simulated import SimulationShown, closing_line
from amalthea_uros.simulate.results import (
    ChainObservation,
    Histogram,
    LabelObservation,
    MetricObservation,
    Occurrence,
    ProcessObservation,
    RequirementObservation,
    RouteObservation,
    RunnableObservation,
    Simulation,
)


def content(result: SimulationShown) -> dict[str, Any]:
    """Everything that was observed."""
    simulation = result.simulation
    found = {
        "model": joined(result.paths),
        "assumptions": list(simulation.assumptions),
        "findings": [finding_json(finding) for finding in result.findings],
        "duration_ps": simulation.duration,
        "seed": simulation.seed,
        "mode": simulation.mode,
        "processors": [{"name": core.name, "load": float(core.load)} for core in simulation.cores],
        "processes": [_process(process) for process in simulation.processes],
        "chains": [_chain(chain) for chain in simulation.chains],
        "runnables": [_runnable(runnable) for runnable in simulation.runnables],
        "labels": [_label(label) for label in simulation.labels],
        "lost_activations": simulation.lost_activations,
        "requirements": [_requirement(requirement) for requirement in simulation.requirements],
        "summary": _summary(simulation),
    }
    if result.impact is not None:
        found["changes"] = changes.content(result.differences)
        found["impact"] = impact.content(result.impact)
    return found


def _process(process: ProcessObservation) -> dict[str, Any]:
    return {
        "name": process.name,
        "kind": "isr" if process.is_isr else "task",
        "processor": process.core,
        "priority": process.priority,
        "jobs": process.jobs,
        "load": float(process.load),
        "metrics": _observations(process.metrics),
        "preemptions": process.preemptions.total,
        "migrations": process.migrations.total,
        "lost_activations": process.lost_activations,
        "unfinished": process.unfinished,
        "longest_unfinished_ps": round(process.longest_unfinished),
        "deadline_ps": process.deadline,
        "deadline_is_period": process.is_implicit,
        "verdict": process.verdict,
        "reason": process.reason,
    }


def _runnable(runnable: RunnableObservation) -> dict[str, Any]:
    return {
        "name": runnable.name,
        "executions": runnable.executions,
        "metrics": _observations(runnable.metrics),
        "preemptions": runnable.preemptions.total,
        "migrations": runnable.migrations.total,
    }


def _label(label: LabelObservation) -> dict[str, Any]:
    return {
        "name": label.name,
        "reads": label.reads,
        "writes": label.writes,
        "unwritten_reads": label.unwritten_reads,
        "overwritten": label.overwritten,
        "age": None if label.age is None else _observation(label.age),
    }


def _chain(chain: ChainObservation) -> dict[str, Any]:
    return {
        "name": chain.name,
        "observations": chain.observations,
        "quantities": _observations(chain.quantities),
        "unanswered": chain.unanswered,
        "longest_unanswered_ps": round(chain.longest_unanswered),
        "not_evaluated": chain.not_evaluated,
        "routes": [_route(route) for route in chain.routes],
        "reason": chain.reason,
    }


def _route(route: RouteObservation) -> dict[str, Any]:
    return {
        "text": route.text,
        "stimuli": route.stimuli,
        "responses": route.responses,
        "quantities": _observations(route.quantities),
        "unanswered": route.unanswered,
        "not_evaluated": route.not_evaluated,
    }


def _observations(found: Mapping[Any, MetricObservation]) -> dict[str, Any]:
    return {name: _observation(each) for name, each in found.items()}


def _observation(found: MetricObservation) -> dict[str, Any]:
    return {
        "count": found.count,
        "min_ps": round(found.min),
        "avg_ps": round(found.mean),
        "max_ps": round(found.max),
        "std_ps": round(found.std),
        "jitter_ps": round(found.jitter),
        "at_min": _occurrence(found.at_min),
        "at_max": _occurrence(found.at_max),
        **({} if found.histogram is None else {"histogram": _histogram(found.histogram)}),
    }


def _occurrence(found: Occurrence) -> dict[str, int]:
    return {"instance": found.instance, "time_ps": round(found.time)}


def _histogram(found: Histogram) -> dict[str, list[int]]:
    return {"edges_ps": [round(edge) for edge in found.edges], "counts": list(found.counts)}


def _requirement(requirement: RequirementObservation) -> dict[str, Any]:
    values = {"limit": requirement.limit, "value": requirement.value, "margin": requirement.margin}
    return {
        "name": requirement.name,
        "object": requirement.object,
        "quantity": requirement.quantity,
        **{f"{name}_ps": _rounded(value) if requirement.is_time else None for name, value in values.items()},
        **{name: None if requirement.is_time or value is None else float(value) for name, value in values.items()},
        "verdict": requirement.verdict,
        "at_ps": _rounded(requirement.at),
        "reason": requirement.reason,
    }


def _rounded(value: Fraction | None) -> int | None:
    return None if value is None else round(value)


def _summary(simulation: Simulation) -> dict[str, Any]:
    tightest = simulation.tightest
    return {
        "errors": list(simulation.errors),
        "judged": len(simulation.judged),
        "missed": len(simulation.missed),
        "not_observed": len(simulation.not_observed),
        "tightest": None if tightest is None else {"name": tightest.name, "margin_ps": _rounded(tightest.margin)},
        "text": closing_line(simulation),
    }
