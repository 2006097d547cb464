"""Results as rows of tables, with the names of the JSON output."""

from __future__ import annotations

from collections.abc import Mapping
from functools import singledispatch
from typing import Any

from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.shown import Record
from amalthea_uros.analyze.impact import Impact
from amalthea_uros.analyze.results import (
    Analysis,
    CallbackResult,
    ChainResult,
    ProcessorResult,
    ProcessResult,
    RequirementResult,
)
from amalthea_uros.report.json import analysis_result, check_result, diff_result, impact, simulation_result
from amalthea_uros.services.analyze import AnalysisResult
from amalthea_uros.services.check import CheckResult
from amalthea_uros.services.diff import DiffResult
from amalthea_uros.services.simulate import CampaignResult, SimulationResult
from amalthea_uros.services.what_if import WhatIf
from amalthea_uros.simulate.results import (
    ChainObservation,
    CoreObservation,
    LabelObservation,
    ProcessObservation,
    RequirementObservation,
    RunnableObservation,
)


@singledispatch
def records(result: Any) -> list[Record]:
    """The rows of a result; one with parts has a row for each of them.

    Raises
    ------
    TypeError : results of this class have no table.
    """
    raise TypeError(f"{type(result).__name__} has no records")


@records.register
def _(results: Results) -> list[Record]:  # type: ignore[type-arg]
    return [row for result in results for row in records(result)]


@records.register
def _(analysis: Analysis) -> list[Record]:
    return records(analysis.processes)


@records.register
def _(result: AnalysisResult) -> list[Record]:
    return records(result.analysis)


@records.register
def _(processor: ProcessorResult) -> list[Record]:
    return [flat(analysis_result.processor_json(processor))]


@records.register
def _(process: ProcessResult) -> list[Record]:
    return [flat(analysis_result.process_json(process))]


@records.register
def _(callback: CallbackResult) -> list[Record]:
    return [flat(analysis_result.callback_json(callback))]


@records.register
def _(chain: ChainResult) -> list[Record]:
    """One row for each latency; a chain without any has a row with the reason."""
    own: Record = {"name": chain.name, "communication": chain.communication}
    rows = [own | flat(analysis_result.value_json(value)) | {"reason": value.reason} for value in chain.values]
    nothing: Record = dict.fromkeys(("quantity", "value_ps", "claim", "method", "source"))
    return rows or [own | nothing | {"reason": chain.reason}]


@records.register
def _(requirement: RequirementResult) -> list[Record]:
    return [flat(analysis_result.requirement_json(requirement))]


@records.register
def _(result: SimulationResult) -> list[Record]:
    return result.simulation.to_records()


@records.register
def _(result: CampaignResult) -> list[Record]:
    return [dict(row) for row in result.rows]


@records.register
def _(core: CoreObservation) -> list[Record]:
    return [flat(simulation_result.core_json(core))]


@records.register
def _(process: ProcessObservation) -> list[Record]:
    return [flat(simulation_result.process_json(process))]


@records.register
def _(chain: ChainObservation) -> list[Record]:
    return [flat(simulation_result.chain_json(chain))]


@records.register
def _(runnable: RunnableObservation) -> list[Record]:
    return [flat(simulation_result.runnable_json(runnable))]


@records.register
def _(label: LabelObservation) -> list[Record]:
    return [flat(simulation_result.label_json(label))]


@records.register
def _(requirement: RequirementObservation) -> list[Record]:
    return [flat(simulation_result.requirement_json(requirement))]


@records.register
def _(result: CheckResult) -> list[Record]:
    return [flat(finding) for finding in check_result.content(result)["findings"]]


@records.register
def _(result: DiffResult) -> list[Record]:
    return [flat(diff_result.change_json(change)) for change in result.changes]


@records.register
def _(result: Impact) -> list[Record]:
    return [flat(impact.row_json(row)) for row in result.rows]


@records.register
def _(result: WhatIf) -> list[Record]:
    return records(result.impact)


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
