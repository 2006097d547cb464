"""Measured values in a description: execution times, periods, intervals and jitters of messages."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path

from amalthea_uros._internal.one_or_several import one_or_several
from amalthea_uros._internal.paths import TEXT, StrPath
from amalthea_uros.compare.calibration.calibration import Calibration, calibrate_file, calibrate_text
from amalthea_uros.compare.calibration.options import AgentFit, CalibrationOptions, Form, parse_fit
from amalthea_uros.compare.shares import parse_share
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.measure.series import Measurement
from amalthea_uros.services.measure import measure


def calibrate(
    description: StrPath,
    trace: StrPath | Measurement | Iterable[StrPath | Measurement],
    *,
    form: Form | str = Form.BOUNDS,
    margin: Fraction | float | str = "20%",
    tighten: bool = False,
    judge_on: Fraction | float | str = 0,
    fits: Iterable[str] = (),
) -> Calibration:
    """Put measured execution times, periods and jitters into a description.

    Comments and layout stay as they are; a comment above each value says where it comes from. Nothing is written: see
    `Calibration.write`.

    Parameters
    ----------
    description : an `app.yaml`, or its text
    trace : traces, or what was measured in them
    form : of execution times: "bounds", "mean" (bounds with the mean) or "histogram"
    margin : by which share measured minima are lowered and maxima raised; not for histograms
    tighten : narrow values of the description that are wider than the measurement
    judge_on : the share of the values, the last ones, on which the result is judged instead
    fits : times in the agent that are fitted to measured round trips, e.g. "agent=round-trip"

    Raises
    ------
    ReadError : a file cannot be read, or something in the description is wrong.
    InvalidArgumentError : an option is wrong, or the values cannot be stated together.
    """
    options = CalibrationOptions(
        form=_form(form),
        margin=parse_share(margin, "margin"),
        tighten=tighten,
        judge_on=parse_share(judge_on, "judge_on"),
        fits=tuple(map(_fit, one_or_several(fits))),
    )
    traces = [trace] if isinstance(trace, str | Path | Measurement) or not isinstance(trace, Iterable) else list(trace)
    measurements = [each if isinstance(each, Measurement) else measure(each) for each in traces]
    if isinstance(description, str) and "\n" in description:
        return calibrate_text(description, TEXT, measurements, options)
    return calibrate_file(Path(description), measurements, options)


def _form(form: Form | str) -> Form:
    if form not in tuple(Form):
        raise InvalidArgumentError(f"unknown form {form!r}; expected one of {', '.join(Form)}")
    return Form(form)


def _fit(text: str) -> AgentFit:
    try:
        return parse_fit(text)
    except ValueError as error:
        raise InvalidArgumentError(str(error)) from None
