"""A simulation for programs: times are rounded to the nearest picosecond."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from amalthea_uros.report.findings import finding_json, joined
from amalthea_uros.report.simulated import SimulationShown, closing_line
from amalthea_uros.simulate.results import (
    ChainObservation,
    Histogram,
    MetricObservation,
    Occurrence,
    ProcessObservation,
    RequirementObservation,
    RouteObservation,
    Simulation,
)


def content(result: SimulationShown) -> dict[str, Any]:
    """Everything that was observed."""
    simulation = result.simulation
    return {
        "model": joined(result.paths),
        "assumptions": list(simulation.assumptions),
        "findings": [finding_json(finding) for finding in result.findings],
        "duration_ps": simulation.duration,
        "seed": simulation.seed,
        "mode": simulation.mode,
        "processors": [{"name": core.name, "load": float(core.load)} for core in simulation.cores],
        "processes": [_process(process) for process in simulation.processes],
        "chains": [_chain(chain) for chain in simulation.chains],
        "lost_activations": simulation.lost_activations,
        "requirements": [_requirement(requirement) for requirement in simulation.requirements],
        "summary": _summary(simulation),
    }


def _process(process: ProcessObservation) -> dict[str, Any]:
    return {
        "name": process.name,
        "kind": "isr" if process.is_isr else "task",
        "processor": process.core,
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
    return {
        name: {
            "count": each.count,
            "min_ps": round(each.min),
            "avg_ps": round(each.mean),
            "max_ps": round(each.max),
            "std_ps": round(each.std),
            "jitter_ps": round(each.jitter),
            "at_min": _occurrence(each.at_min),
            "at_max": _occurrence(each.at_max),
            **({} if each.histogram is None else {"histogram": _histogram(each.histogram)}),
        }
        for name, each in found.items()
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
        "reason": requirement.reason,
    }


def _rounded(value: Fraction | None) -> int | None:
    return None if value is None else round(value)


def _summary(simulation: Simulation) -> dict[str, Any]:
    tightest = simulation.tightest
    return {
        "judged": len(simulation.judged),
        "missed": len(simulation.missed),
        "not_observed": len(simulation.not_observed),
        "tightest": None if tightest is None else {"name": tightest.name, "margin_ps": _rounded(tightest.margin)},
        "text": closing_line(simulation),
    }
