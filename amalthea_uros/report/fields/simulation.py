"""The fields of simulations and campaigns: times are rounded to the nearest picosecond."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from amalthea_uros.design.campaign.simulations import CampaignResult
from amalthea_uros.judge.causes import distinct
from amalthea_uros.report.documents.simulation import campaign_line, closing_line
from amalthea_uros.report.fields.changes import CHANGED
from amalthea_uros.report.fields.declaration import ALSO, declare, fields_of, given, json_of
from amalthea_uros.report.wording.findings import joined
from amalthea_uros.services.simulate import SimulationResult
from amalthea_uros.simulate.observations import (
    ChainObservation,
    CoreObservation,
    ExecutorObservation,
    HandleObservation,
    LabelObservation,
    LossObservation,
    MetricObservation,
    ObservedOccurrence,
    ProcessObservation,
    RequirementObservation,
    RouteObservation,
    RunnableObservation,
    TimeHistogram,
)
from amalthea_uros.simulate.results import Simulation

_LEFT_OUT = ("name", "kind", "deadline_ps", "deadline_is_period", "verdict", "reason")


def _edges(histogram: TimeHistogram) -> Sequence[Fraction | int]:
    """The edges of the bins, as whole numbers where they are."""
    start, width = histogram.start, histogram.width
    if start.denominator == width.denominator == 1:
        edges = len(histogram.counts) + 1
        return range(int(start), int(start + edges * width), int(width))
    return histogram.edges


def _left_out(result: SimulationResult) -> list[dict[str, Any]]:
    """The processes that are not simulated, without what was not observed of them."""
    found = (json_of(process) for process in result.simulation.left_out)
    return [{name: process[name] for name in _LEFT_OUT} for process in found]


def _summary(simulation: Simulation) -> dict[str, Any]:
    tightest = simulation.tightest
    return {
        "errors": simulation.errors,
        "judged": len(simulation.judged),
        "missed": len(simulation.missed),
        "failures": len(distinct(simulation.missed)),
        "not_observed": len(simulation.not_observed),
        "tightest": None if tightest is None else fields_of({"name": tightest.name, "margin_ps": tightest.margin}),
        "text": closing_line(simulation),
    }


def _limited(requirement: RequirementObservation) -> dict[str, Any]:
    """The values of a requirement: times with their unit, other numbers without."""
    values = {"limit": requirement.limit, "value": requirement.value, "margin": requirement.margin}
    times = {f"{name}_ps": value if requirement.is_time else None for name, value in values.items()}
    return times | {name: None if requirement.is_time else value for name, value in values.items()}


declare(
    SimulationResult,
    ("model", lambda result: joined(result.paths)),
    ("assumptions", "simulation.assumptions"),
    "findings",
    ("duration_ps", "simulation.duration"),
    ("seed", "simulation.seed"),
    ("mode", "simulation.mode"),
    ("processors", "simulation.cores"),
    ("processes", "simulation.processes"),
    ("executors", "simulation.executors"),
    ("host", "simulation.host"),
    ("losses", "simulation.losses"),
    ("chains", "simulation.chains"),
    ("left_out", _left_out),
    ("runnables", "simulation.runnables"),
    ("labels", "simulation.labels"),
    ("lost_activations", "simulation.lost_activations"),
    ("requirements", "simulation.requirements"),
    ("summary", lambda result: _summary(result.simulation)),
    *CHANGED,
)
declare(CoreObservation, "name", "load")
declare(
    ProcessObservation,
    "name",
    ("kind", lambda process: "isr" if process.is_isr else "task"),
    ("processor", "core"),
    *("priority", "jobs", "load", "metrics"),
    ("preemptions", "preemptions.total"),
    ("migrations", "migrations.total"),
    *("lost_activations", "unfinished", "longest_unfinished_ps", "deadline_ps"),
    ("deadline_is_period", "is_implicit"),
    *("verdict", "reason"),
)
declare(
    RunnableObservation,
    *("name", "executions", "metrics"),
    ("preemptions", "preemptions.total"),
    ("migrations", "migrations.total"),
)
declare(ExecutorObservation, *("name", "iterations", "timeouts", "refusals", "handles"))
declare(LossObservation, *("name", "wire", "sent", "lost", "sent_again"))
declare(
    HandleObservation,
    *("name", "kind", "runnable", "calls", "lost", "metrics"),
    ("preemptions", "preemptions.total"),
)
declare(LabelObservation, *("name", "reads", "writes", "unwritten_reads", "overwritten", "age"))
declare(
    ChainObservation,
    *("name", "observations", "quantities", "unanswered", "longest_unanswered_ps", "not_evaluated", "routes", "reason"),
)
declare(RouteObservation, *("text", "stimuli", "responses", "quantities", "unanswered", "not_evaluated"))
declare(
    MetricObservation,
    *("count", "min_ps"),
    ("avg_ps", "mean"),
    *("max_ps", "std_ps", "jitter_ps", "at_min", "at_max"),
    ("histogram", given("histogram")),
)
declare(ObservedOccurrence, "instance", "time_ps")
declare(TimeHistogram, ("edges_ps", _edges), "counts")
declare(
    RequirementObservation,
    *("name", "object", "quantity"),
    (ALSO, _limited),
    "verdict",
    ("at_ps", "at"),
    "reason",
)
declare(
    CampaignResult,
    ("model", lambda result: joined(result.paths)),
    "findings",
    ("duration_ps", "options.duration"),
    ("mode", "options.mode"),
    ("changes", "differences"),
    ("planned_runs", "planned"),
    ("runs", "rows"),
    (
        "summary",
        lambda result: {
            "missed": len(result.missed),
            "failed": len(result.failed),
            "incomplete": len(result.incomplete),
            "not_observed": len(result.not_observed),
            "text": campaign_line(result),
        },
    ),
)
