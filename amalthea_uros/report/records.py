"""Results as rows of tables, with the names of the JSON output."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import singledispatch
from typing import Any

from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.shown import Record
from amalthea_uros.analyze.impact import Impact
from amalthea_uros.analyze.priorities.assignment import Proposal
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import ChainResult
from amalthea_uros.analyze.results.processes import CallbackResult, ProcessorResult, ProcessResult
from amalthea_uros.analyze.results.requirements import RequirementResult
from amalthea_uros.analyze.sensitivity import Sensitivity
from amalthea_uros.compare.results import Comparison, ComparisonRow, DistributionRow, MeasuredLimit
from amalthea_uros.executors.results import ExecutorResult, HandleResult, Hop
from amalthea_uros.measure.series import Measurement
from amalthea_uros.report.json import (
    analysis_result,
    build_result,
    calibration,
    check_result,
    comparison,
    diff_result,
    generate_result,
    impact,
    measurement,
    meta_check,
    migration_result,
    optimization,
    simulation_result,
)
from amalthea_uros.report.json.executors import handle_json, hop_json
from amalthea_uros.services.analyze import AnalysisResult, Explanation
from amalthea_uros.services.build import BuildResult
from amalthea_uros.services.calibrate import Calibration
from amalthea_uros.services.check import CheckResult
from amalthea_uros.services.diff import DiffResult
from amalthea_uros.services.generate import GenerateResult, MetaCheck
from amalthea_uros.services.improvements import Improvements
from amalthea_uros.services.migrate import MigrationResult
from amalthea_uros.services.optimize import DesignProposal, Optimization
from amalthea_uros.services.simulate import CampaignResult, SimulationResult
from amalthea_uros.services.sweep import SweepResult
from amalthea_uros.services.what_if import WhatIf
from amalthea_uros.simulate.observations import (
    ChainObservation,
    CoreObservation,
    LabelObservation,
    ProcessObservation,
    RequirementObservation,
    RunnableObservation,
)

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


@singledispatch
def all_records(result: Any) -> list[Record]:
    """The rows of a result with all columns; one with parts has a row for each of them.

    Raises
    ------
    TypeError : results of this class have no table.
    """
    raise TypeError(f"{type(result).__name__} has no records")


@all_records.register
def _(results: Results) -> list[Record]:  # type: ignore[type-arg]
    return [row for result in results for row in all_records(result)]


@all_records.register
def _(analysis: Analysis) -> list[Record]:
    return all_records(analysis.processes)


@all_records.register
def _(result: AnalysisResult) -> list[Record]:
    return all_records(result.analysis)


@all_records.register
def _(processor: ProcessorResult) -> list[Record]:
    return [flat(analysis_result.processor_json(processor))]


@all_records.register
def _(process: ProcessResult) -> list[Record]:
    return [flat(analysis_result.process_json(process))]


@all_records.register
def _(callback: CallbackResult) -> list[Record]:
    return [flat(analysis_result.callback_json(callback))]


@all_records.register
def _(executor: ExecutorResult) -> list[Record]:
    """One row for each handle."""
    own: Record = {"executor": executor.name}
    return [own | row for handle in executor.handles for row in all_records(handle)]


@all_records.register
def _(handle: HandleResult) -> list[Record]:
    return [flat({name: value for name, value in handle_json(handle).items() if name != "terms"})]


@all_records.register
def _(hop: Hop) -> list[Record]:
    return [flat({name: value for name, value in hop_json(hop).items() if name != "parts"})]


@all_records.register
def _(chain: ChainResult) -> list[Record]:
    """One row for each latency; a chain without any has a row with the reason."""
    own: Record = {"name": chain.name, "communication": chain.communication}
    rows = [own | flat(analysis_result.value_json(value)) | {"reason": value.reason} for value in chain.values]
    nothing: Record = dict.fromkeys(("quantity", "value_ps", "claim", "method", "source"))
    return rows or [own | nothing | {"reason": chain.reason}]


@all_records.register
def _(requirement: RequirementResult) -> list[Record]:
    return [flat(analysis_result.requirement_json(requirement))]


@all_records.register
def _(result: SimulationResult) -> list[Record]:
    return result.simulation.to_records()


@all_records.register
def _(proposal: DesignProposal) -> list[Record]:
    """One row for each requirement and limit."""
    return [flat(row) for row in optimization.demands_json(proposal)]


@all_records.register
def _(result: Optimization) -> list[Record]:
    """One row for each proposal."""
    return [flat(row) for row in optimization.rows_json(result)]


@all_records.register
def _(result: CampaignResult) -> list[Record]:
    return [dict(row) for row in result.rows]


@all_records.register
def _(result: SweepResult) -> list[Record]:
    return [dict(row) for row in result.rows]


@all_records.register
def _(core: CoreObservation) -> list[Record]:
    return [flat(simulation_result.core_json(core))]


@all_records.register
def _(process: ProcessObservation) -> list[Record]:
    return [flat(simulation_result.process_json(process))]


@all_records.register
def _(chain: ChainObservation) -> list[Record]:
    return [flat(simulation_result.chain_json(chain))]


@all_records.register
def _(runnable: RunnableObservation) -> list[Record]:
    return [flat(simulation_result.runnable_json(runnable))]


@all_records.register
def _(label: LabelObservation) -> list[Record]:
    return [flat(simulation_result.label_json(label))]


@all_records.register
def _(requirement: RequirementObservation) -> list[Record]:
    return [flat(simulation_result.requirement_json(requirement))]


@all_records.register
def _(result: GenerateResult) -> list[Record]:
    """One row for each build option."""
    return [flat(option) for option in generate_result.content(result)["options"]]


@all_records.register
def _(result: MetaCheck) -> list[Record]:
    return [flat(finding) for finding in meta_check.content(result)["findings"]]


@all_records.register
def _(result: CheckResult) -> list[Record]:
    return [flat(finding) for finding in check_result.content(result)["findings"]]


@all_records.register
def _(result: BuildResult) -> list[Record]:
    """The periods that were chosen, with reasons."""
    return [flat(choice) for choice in build_result.content(result)["choices"]]


@all_records.register
def _(result: Calibration) -> list[Record]:
    """The measured values."""
    return [flat(calibration.value_json(value)) for value in result.values]


@all_records.register
def _(result: Measurement) -> list[Record]:
    """The series, without histograms."""
    return [flat({**measurement.series_json(series), "histogram": None}) for series in result.series]


@all_records.register
def _(result: MigrationResult) -> list[Record]:
    """The objects that were changed."""
    return [flat(change) for change in migration_result.content(result)["changes"]]


@all_records.register
def _(result: DiffResult) -> list[Record]:
    return [flat(diff_result.change_json(change)) for change in result.changes]


@all_records.register
def _(result: Comparison) -> list[Record]:
    return [row for each in result.rows for row in all_records(each)]


@all_records.register
def _(row: ComparisonRow) -> list[Record]:
    return [flat(comparison.row_json(row))]


@all_records.register
def _(row: DistributionRow) -> list[Record]:
    return [flat({name: value for name, value in comparison.distribution_json(row).items() if name != "quantiles"})]


@all_records.register
def _(limit: MeasuredLimit) -> list[Record]:
    return [flat(comparison.limit_json(limit))]


@all_records.register
def _(result: Impact) -> list[Record]:
    return [flat(impact.row_json(row)) for row in result.rows]


@all_records.register
def _(result: WhatIf) -> list[Record]:
    return all_records(result.impact)


@all_records.register
def _(result: Explanation) -> list[Record]:
    """One row for each part of a response time or latency; those of one object add up to it."""
    return [*_parts_of_response(result), *_parts_of_latency(result)]


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


@all_records.register
def _(result: Improvements) -> list[Record]:
    return [
        {
            "change": each.change.text,
            "before_ps": each.before,
            "after_ps": each.after,
            "claim": str(each.claim),
            "is_safe": each.is_safe,
            "drawbacks": "; ".join(f"{drawback.name}: {drawback.before} -> {drawback.after}" for drawback in each.drawbacks),
        }
        for each in result.found
    ]


@all_records.register
def _(result: Sensitivity) -> list[Record]:
    """The row without a process is the factor on all execution times together."""
    rows: list[Record] = [{"process": None, "factor": _float(result.everything), "wcet_ps": None, "longest_ps": None}]
    for process, factor in result.processes.items():
        wcet, longest = result.execution_times[process], result.longest(process)
        rows.append({"process": process, "factor": _float(factor), "wcet_ps": wcet, "longest_ps": longest})
    return rows


def _float(factor: Fraction | None) -> float | None:
    return None if factor is None else float(factor)


@all_records.register
def _(result: Proposal) -> list[Record]:
    return [
        {
            "processor": result.core,
            "task": task,
            "current": current,
            "proposed": result.priorities.get(task) if result.priorities else None,
            "outcome": str(result.outcome),
            "reason": result.reason,
        }
        for task, current in result.current.items()
    ]


#: What has no place in a cell: distributions, and where in the run something was observed.
_LEFT_OUT = ("histogram", "at_min", "at_max", "routes")


def flat(values: Mapping[str, object], prefix: str = "") -> Record:
    """Nested values as one record: keys of inner mappings are joined with dots."""
    found: Record = {}
    for key, value in values.items():
        name = f"{prefix}{key}"
        if key in _LEFT_OUT:
            continue
        if isinstance(value, Mapping):
            found |= flat(value, f"{name}.")
        elif value is None or isinstance(value, bool | int | float):
            found[name] = value
        else:
            found[name] = str(value)
    return found
