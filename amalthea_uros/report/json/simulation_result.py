"""A simulation for programs: times are rounded to the nearest picosecond."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from amalthea_uros.judge.causes import distinct
from amalthea_uros.report.findings import finding_json, joined
from amalthea_uros.report.json import changes, impact
from amalthea_uros.report.simulated import SimulationShown, closing_line
from amalthea_uros.simulate.observations import (
    ChainObservation,
    CoreObservation,
    LabelObservation,
    MetricObservation,
    ObservedOccurrence,
    ProcessObservation,
    RequirementObservation,
    RouteObservation,
    RunnableObservation,
    TimeHistogram,
)
from amalthea_uros.simulate.results import Simulation


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
        "processors": [core_json(core) for core in simulation.cores],
        "processes": [process_json(process) for process in simulation.processes],
        "chains": [chain_json(chain) for chain in simulation.chains],
        "left_out": [left_out_json(process) for process in simulation.left_out],
        "runnables": [runnable_json(runnable) for runnable in simulation.runnables],
        "labels": [label_json(label) for label in simulation.labels],
        "lost_activations": simulation.lost_activations,
        "requirements": [requirement_json(requirement) for requirement in simulation.requirements],
        "summary": _summary(simulation),
    }
    if result.impact is not None:
        found["changes"] = changes.content(result.differences)
        found["impact"] = impact.content(result.impact)
    return found


def core_json(core: CoreObservation) -> dict[str, Any]:
    """The load of a core."""
    return {"name": core.name, "load": float(core.load)}


def process_json(process: ProcessObservation) -> dict[str, Any]:
    """What was observed of a process."""
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


def left_out_json(process: ProcessObservation) -> dict[str, Any]:
    """A process that is not simulated."""
    kept = ("name", "kind", "deadline_ps", "deadline_is_period", "verdict", "reason")
    return {key: value for key, value in process_json(process).items() if key in kept}


def runnable_json(runnable: RunnableObservation) -> dict[str, Any]:
    """What was observed of a runnable."""
    return {
        "name": runnable.name,
        "executions": runnable.executions,
        "metrics": _observations(runnable.metrics),
        "preemptions": runnable.preemptions.total,
        "migrations": runnable.migrations.total,
    }


def label_json(label: LabelObservation) -> dict[str, Any]:
    """The accesses to a label."""
    return {
        "name": label.name,
        "reads": label.reads,
        "writes": label.writes,
        "unwritten_reads": label.unwritten_reads,
        "overwritten": label.overwritten,
        "age": None if label.age is None else _observation(label.age),
    }


def chain_json(chain: ChainObservation) -> dict[str, Any]:
    """What was observed of a chain."""
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
        **({} if found.histogram is None else {"histogram": histogram_json(found.histogram)}),
    }


def _occurrence(found: ObservedOccurrence) -> dict[str, int]:
    return {"instance": found.instance, "time_ps": round(found.time)}


def histogram_json(found: TimeHistogram) -> dict[str, list[int]]:
    """The edges of the bins, and the values in each."""
    return {"edges_ps": [round(edge) for edge in found.edges], "counts": list(found.counts)}


def requirement_json(requirement: RequirementObservation) -> dict[str, Any]:
    """The observed verdict on a requirement or constraint."""
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
        "failures": len(distinct(simulation.missed)),
        "not_observed": len(simulation.not_observed),
        "tightest": None if tightest is None else {"name": tightest.name, "margin_ps": _rounded(tightest.margin)},
        "text": closing_line(simulation),
    }
