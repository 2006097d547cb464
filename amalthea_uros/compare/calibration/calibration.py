"""Measured values in a description: execution times, periods, intervals and jitters of messages."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from amalthea_uros._internal.file_writing import write_bytes
from amalthea_uros._internal.files import FileError, read_bytes, read_text, reading_once
from amalthea_uros._internal.limits import DESCRIPTION_SIZE
from amalthea_uros._internal.paths import StrPath, is_description
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros._internal.shown import Shown
from amalthea_uros.compare.calibration.agent_times import calibrated_agent_times
from amalthea_uros.compare.calibration.execution_times import calibrated_execution_times
from amalthea_uros.compare.calibration.executor_parts import with_executor_parts
from amalthea_uros.compare.calibration.findings import findings_of
from amalthea_uros.compare.calibration.options import CalibrationOptions
from amalthea_uros.compare.calibration.overheads import calibrated_overheads
from amalthea_uros.compare.calibration.periods import calibrated_periods
from amalthea_uros.compare.calibration.samples import Measured
from amalthea_uros.compare.calibration.values import CalibratedValue, Outcome
from amalthea_uros.compare.calibration.wire_parts import executed_times
from amalthea_uros.design.description import other_folder, text_edits
from amalthea_uros.design.description.assign import apply_assignments
from amalthea_uros.design.description.built_objects import BuiltObjects
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import InvalidArgumentError, ReadError, WriteError
from amalthea_uros.measure.series import Measurement
from amalthea_uros.uros.described import describe_text

_BOM = "\ufeff"


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Calibration(Shown):
    """Measured values in a description.

    Attributes
    ----------
    path : the description
    sources : the traces
    values : all measured values that concern the description
    before, text : the description without and with the values
    findings : those of the measurement, too
    """

    path: Path
    sources: tuple[str, ...]
    options: CalibrationOptions
    values: tuple[CalibratedValue, ...]
    before: str
    text: str
    findings: tuple[Finding, ...]

    def __repr__(self) -> str:
        return f"<Calibration of {self.path}: {len(self.written)} of {len(self.values)} values written>"

    @property
    def written(self) -> tuple[CalibratedValue, ...]:
        """The values that changed the description."""
        return tuple(value for value in self.values if value.outcome is Outcome.WRITTEN)

    @property
    def is_refuted(self) -> bool:
        """Whether something is an error, such as a measured value beyond a stated bound."""
        return any(finding.severity is Severity.ERROR for finding in self.findings)

    def write(self, path: StrPath) -> None:
        """Write the calibrated description, whole or not at all; in another folder, it names the same files.

        Raises
        ------
        WriteError : the file cannot be written.
        """
        try:
            write_bytes(Path(path), other_folder.moved(self.text, self.path, Path(path)).encode())
        except FileError as error:
            finding = Finding("XMI101", Severity.ERROR, error.reason, Location(error.path), error.advice)
            raise WriteError([finding]) from None


@reading_once()
def calibrate_file(path: Path, measurements: Sequence[Measurement], options: CalibrationOptions) -> Calibration:
    """Put measured values into the description of a file; raises as `calibrate_text`."""
    if not is_description(path):
        raise InvalidArgumentError(f"{path}: only an app.yaml is calibrated; the times of a model are changed with --set")
    try:
        mark = _BOM if read_bytes(path, DESCRIPTION_SIZE).startswith(_BOM.encode()) else ""
        text = mark + read_text(path, DESCRIPTION_SIZE)
    except FileError as error:
        raise ReadError([Finding("YML001", Severity.ERROR, error.reason, Location(path), error.advice)]) from None
    return calibrate_text(text, path, measurements, options)


def calibrate_text(text: str, path: Path, measurements: Sequence[Measurement], options: CalibrationOptions) -> Calibration:
    """Put measured values into the text of a description.

    Raises
    ------
    ReadError : something in the description is wrong.
    InvalidArgumentError : nothing was measured, the values cannot be stated together, or there are several controllers.
    """
    if not measurements:
        raise InvalidArgumentError("nothing was measured; give at least one trace")
    mark = _BOM if text.startswith(_BOM) else ""
    before = describe_text(text.removeprefix(_BOM), path)
    if before.controllers:
        raise InvalidArgumentError(
            f"{path} has several controllers; calibrate the description of each one with what was measured on it"
        )
    built = BuiltObjects(before, text.removeprefix(_BOM))
    measured = [Measured(series, measurement) for measurement in measurements for series in measurement.series]
    executors = (choice.period for choice in before.assembly.choices if choice.task == choice.executor)
    period = next(executors, None)
    found = [
        *calibrated_execution_times(
            [*with_executor_parts(measured, built, period)], built, options, executed_times(before.assembly.system)
        ),
        *calibrated_overheads(measured, before, options),
        *calibrated_periods(measured, before, built, options),
        *calibrated_agent_times(measured, text.removeprefix(_BOM), before, options),
    ]
    after, found = _edited(text.removeprefix(_BOM), found)
    _check(after, path)
    values = tuple(_placed(value, text.removeprefix(_BOM), after) for value in found)
    findings = findings_of(path, text, values, measured, before, built, options)
    return Calibration(
        path=path,
        sources=tuple(measurement.source for measurement in measurements),
        options=options,
        values=values,
        before=text,
        text=mark + after,
        findings=(*(finding for each in measurements for finding in each.findings), *findings),
    )


def _edited(text: str, values: Sequence[CalibratedValue]) -> tuple[str, list[CalibratedValue]]:
    """The text with the values, and what became of them: what others share is not written, unless these have got their own by then."""
    pending, reasons = list(values), dict[int, str]()
    while pending:
        refused = []
        for value in pending:
            try:
                text = _with_value(text, value)
            except InvalidArgumentError as error:
                reasons[id(value)] = str(error)
                refused.append(value)
        if len(refused) == len(pending):
            break
        pending = refused
    lost = {id(value) for value in pending}
    return text, [
        replace(value, assignment=None, outcome=Outcome.NOT_WRITTEN, reason=reasons[id(value)]) if id(value) in lost else value
        for value in values
    ]


def _with_value(text: str, value: CalibratedValue) -> str:
    if value.assignment is None:
        return text
    text = apply_assignments(text, [value.assignment])
    return text_edits.with_comment(text, value.assignment.path, f"{value.target}:", value.comment)


def _check(text: str, path: Path) -> None:
    """Read the text again."""
    try:
        describe_text(text, path)
    except ReadError as error:
        reasons = "; ".join(finding.message for finding in error.findings)
        raise InvalidArgumentError(f"the description with the measured values is not valid: {reasons}") from None


def _placed(value: CalibratedValue, before: str, after: str) -> CalibratedValue:
    """The value with its line, and the texts of it."""
    if value.path is None:
        return value
    return replace(
        value,
        line=text_edits.line_of(before, value.path),
        before=text_edits.value_text(before, value.path),
        after=text_edits.value_text(after, value.path) if value.assignment is not None else None,
    )
