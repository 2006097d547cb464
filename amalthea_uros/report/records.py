"""Results as rows of tables, with the names of the JSON output."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from typing import Any

from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.shown import Record
from amalthea_uros.analyze.impact import Impact
from amalthea_uros.analyze.priorities.assignment import Proposal
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import ChainResult
from amalthea_uros.analyze.results.processes import CallbackResult, ProcessResult
from amalthea_uros.analyze.sensitivity import Sensitivity
from amalthea_uros.compare.calibration.calibration import Calibration
from amalthea_uros.compare.results import Comparison
from amalthea_uros.design.campaign.simulations import CampaignResult
from amalthea_uros.design.campaign.sweeps import SweepResult
from amalthea_uros.design.improvements import Improvement, Improvements
from amalthea_uros.design.proposals import DesignProposal
from amalthea_uros.executors.results import ExecutorResult
from amalthea_uros.measure.series import Measurement
from amalthea_uros.report.fields import analysis, descriptions, explanation, measurement, models, search, simulation
from amalthea_uros.report.fields.declaration import is_declared, json_of, list_of
from amalthea_uros.services.analyze import AnalysisResult, Explanation
from amalthea_uros.services.build import BuildResult
from amalthea_uros.services.check import CheckResult
from amalthea_uros.services.diff import DiffResult
from amalthea_uros.services.generate import GenerateResult, MetaCheck
from amalthea_uros.services.migrate import MigrationResult
from amalthea_uros.services.optimize import Optimization
from amalthea_uros.services.own_methods import MethodBounds
from amalthea_uros.services.simulate import SimulationResult
from amalthea_uros.services.what_if import WhatIf
from amalthea_uros.simulate.observations import ChainObservation, ProcessObservation, RunnableObservation

#: Declare the fields of all results.
_DECLARATIONS = (analysis, descriptions, explanation, measurement, models, search, simulation)

#: The most important columns of the results that have too many for a table.
_LEAN: Mapping[type, tuple[str, ...]] = {
    Measurement: (
        *("object", "quantity", "samples"),
        *(f"latency.{figure}_ps" for figure in ("min", "avg", "max", "std", "p99")),
        "jitter.peak_to_peak_ps",
    ),
    ProcessResult: (
        *("name", "processor", "priority", "bcet_ps", "wcet_ps", "bcrt_ps", "wcrt_ps", "deadline_ps"),
        *("verdict", "claim", "reason"),
    ),
    CallbackResult: ("name", "process", "bcrt_ps", "wcrt_ps", "deadline_ps", "claim", "reason"),
    ProcessObservation: (
        *("name", "processor", "priority", "jobs", "load"),
        *(f"metrics.response_time.{figure}_ps" for figure in ("min", "avg", "max")),
    ),
    RunnableObservation: ("name", *(f"metrics.response_time.{figure}" for figure in ("count", "min_ps", "avg_ps", "max_ps"))),
    ChainObservation: (
        *("name", "observations"),
        *(f"quantities.{age}.max_ps" for age in ("reaction_time", "reduced_reaction_time", "data_age", "reduced_data_age")),
    ),
}


def lean_records(result: Any) -> list[Record]:
    """The rows of a result with the most important columns; rows of one kind have the same columns."""
    match result:
        case AnalysisResult():
            return lean_records(result.analysis)
        case Analysis():
            return lean_records(result.processes)
        case Results():
            return [row for each in result for row in lean_records(each)]
    rows, columns = all_records(result), _LEAN.get(type(result))
    return rows if columns is None else [{name: row.get(name) for name in columns} for row in rows]


def all_records(result: Any) -> list[Record]:
    """The rows of a result with all columns; one with parts has a row for each of them.

    Raises
    ------
    TypeError : results of this class have no table.
    """
    if isinstance(result, Results):
        return [row for each in result for row in all_records(each)]
    if isinstance(result, Mapping):
        return [flat(result)]
    parts = _PARTS.get(type(result))
    if parts is not None:
        return [row for part in parts(result) for row in all_records(part)]
    if not is_declared(type(result)):
        raise TypeError(f"{type(result).__name__} has no records")
    return [flat(json_of(result))]


def _latencies(chain: ChainResult) -> Iterator[Record]:
    """One row for each latency; a chain without any has a row with the reason."""
    own: Record = {"name": chain.name, "communication": chain.communication}
    for value in chain.values:
        yield own | flat(json_of(value)) | {"reason": value.reason}
    if not chain.values:
        nothing: Record = dict.fromkeys(("quantity", "value_ps", "claim", "method", "source"))
        yield own | nothing | {"reason": chain.reason}


def _handles(executor: ExecutorResult) -> Iterator[Record]:
    own: Record = {"executor": executor.name}
    return (own | row for handle in executor.handles for row in all_records(handle))


def _explained_parts(result: Explanation) -> Iterator[Record]:
    """One row for each part of a response time or latency; those of one object add up to it."""
    yield from _parts_of_response(result)
    yield from _parts_of_latency(result)


def _parts_of_response(result: Explanation) -> Iterator[Record]:
    response = result.process and result.process.process.response
    if not result.process or not response:
        return
    name, shares = result.process.process.name, result.process.shares
    for term, time in response.terms.items():
        if term == "interference" and time == sum(share.time for share in shares):
            yield from (_part(name, term, share.name, share.time, share.jobs) for share in shares)
        else:
            yield _part(name, term, name if term == "own" else None, time)


def _parts_of_latency(result: Explanation) -> Iterator[Record]:
    for hop in result.chain.hops if result.chain else ():
        yield _part(result.name, "wait", hop.process, hop.wait)
        yield _part(result.name, "run", hop.process, hop.run)
    if result.chain and result.chain.overwritten:
        yield _part(result.name, "until overwritten", result.chain.hops[-1].process, result.chain.overwritten)


def _part(name: str, part: str, process: str | None, time: int, jobs: int | None = None) -> Record:
    return {"name": name, "part": part, "process": process, "jobs": jobs, "time_ps": time}


def _drawbacks(result: Improvement) -> str:
    return "; ".join(f"{each.name}: {each.before} -> {each.after}" for each in result.drawbacks)


def _factors(result: Sensitivity) -> Iterator[Record]:
    """The row without a process is the factor on all execution times together."""
    yield {"process": None, "factor": _float(result.everything), "wcet_ps": None, "longest_ps": None}
    for process, factor in result.processes.items():
        wcet, longest = result.execution_times[process], result.longest(process)
        yield {"process": process, "factor": _float(factor), "wcet_ps": wcet, "longest_ps": longest}


def _float(factor: Fraction | None) -> float | None:
    return None if factor is None else float(factor)


def _priorities(result: Proposal) -> Iterator[Record]:
    for task, current in result.current.items():
        yield {
            "processor": result.core,
            "task": task,
            "current": current,
            "proposed": result.priorities.get(task) if result.priorities else None,
            "outcome": str(result.outcome),
            "reason": result.reason,
        }


#: Results with a row for each of their parts, and the parts: rows, or objects with rows of their own.
_PARTS: Mapping[type, Callable[[Any], Iterable[Any]]] = {
    Analysis: lambda result: [result.processes],
    AnalysisResult: lambda result: [result.analysis],
    ExecutorResult: _handles,
    ChainResult: _latencies,
    Explanation: _explained_parts,
    Improvements: list_of(
        "found", ("change", "change.text"), *("before_ps", "after_ps", "claim", "is_safe"), ("drawbacks", _drawbacks)
    ),
    Sensitivity: _factors,
    Proposal: _priorities,
    Impact: lambda result: result.rows,
    WhatIf: lambda result: [result.impact],
    SimulationResult: lambda result: result.simulation.to_records(),
    CampaignResult: lambda result: result.rows,
    SweepResult: lambda result: result.rows,
    DesignProposal: search.demand_rows,
    Optimization: search.proposal_rows,
    Measurement: lambda result: result.series,
    Comparison: lambda result: result.rows,
    Calibration: lambda result: result.values,
    BuildResult: lambda result: json_of(result)["choices"],
    GenerateResult: lambda result: json_of(result)["options"],
    MetaCheck: lambda result: result.findings,
    CheckResult: lambda result: json_of(result)["findings"],
    MigrationResult: lambda result: result.changes,
    MethodBounds: list_of(
        "rows", *("method", "object", "quantity", "value_ps", "analyzed_ps", "claim"), ("comparison", "standing")
    ),
    DiffResult: lambda result: result.changes,
}

#: What has no place in a cell: distributions, and where in the run something was observed.
_LEFT_OUT = ("histogram", "at_min", "at_max")


def flat(values: Mapping[str, object], prefix: str = "") -> Record:
    """Nested values as one record: keys of inner mappings are joined with dots; lists have no place in it."""
    found: Record = {}
    for key, value in values.items():
        name = f"{prefix}{key}"
        if key in _LEFT_OUT or isinstance(value, list):
            continue
        if isinstance(value, Mapping):
            found |= flat(value, f"{name}.")
        elif value is None or isinstance(value, bool | int | float):
            found[name] = value
        else:
            found[name] = str(value)
    return found
