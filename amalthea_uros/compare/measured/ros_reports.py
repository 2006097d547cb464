"""The output of `ros2 topic delay` and `ros2 topic hz`: statistics of the messages of a topic at the host.

    average delay: 0.005
        min: 0.004s max: 0.006s std dev: 0.00041s window: 10

Each report is about all messages of a window that grows up to a limit, 10,000 by default (`--window`), so the last report has the mean
of the most messages; the extremes are those of all reports. `hz` has distances of messages, and their frequency instead of their mean
(ros2/ros2cli, ros2topic/verb/delay.py and hz.py).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

from amalthea_uros.diagnostics import Severity
from amalthea_uros.measure.series import MeasuredKind, Measurement, Series, TimeStatistics
from amalthea_uros.measure.window import MeasurementWindow
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.trace.files import TracePlace, TraceProblems, first_characters, opened_text
from amalthea_uros.units import MILLISECOND, SECOND, Time

#: Python computes numbers of any size; no tool prints one with so many digits.
_NUMBER = r"(-?\d{1,15}(?:\.\d{1,30})?(?:e-?\d{1,2})?)"
_AVERAGE = re.compile(rf"average (delay|rate): {_NUMBER}")
_OTHERS = re.compile(rf"min: {_NUMBER}s max: {_NUMBER}s std dev: {_NUMBER}s window: (\d+)")
#: So much of a file is looked at: tools print warnings before the first report.
_BEGIN = 2000


def is_ros_report(path: Path) -> bool:
    """Whether a file is the output of one of these tools."""
    return any(_AVERAGE.fullmatch(line.strip()) for line in first_characters(path, _BEGIN).splitlines())


def measured_report(path: Path, name: str, window: MeasurementWindow) -> Measurement:
    """The statistics of a topic, under a name; the output does not say which topic it is.

    Raises
    ------
    ReadError : the file cannot be read.
    InvalidArgumentError : a part is to be measured of what has no times.
    """
    window.refuse_part(path.name)
    problems = TraceProblems(path)
    reports: list[tuple[str, TimeStatistics]] = []
    with opened_text(path, problems) as lines:
        for report in _reports(lines, problems):  # the file may be damaged after some of them
            reports.append(report)
    quantity = reports[-1][0] if reports else "duration"
    series = Series(
        kind=MeasuredKind.INTERVAL,
        name=name,
        quantity=quantity,
        statistics=_of_all_reports([statistics for _, statistics in reports]) if reports else None,
        method=f"{len(reports):,} reports of a topic at the host: the mean of the last one",
    )
    return Measurement(
        source=str(path),
        format="statistics of a topic",
        duration=0,
        resolution=MILLISECOND,  # three digits of seconds
        series=(series,),
        findings=problems.findings,
    )


def _reports(lines: Iterator[str], problems: TraceProblems) -> Iterator[tuple[str, TimeStatistics]]:
    average: re.Match[str] | None = None
    for number, line in enumerate(lines, 1):
        text = line.strip()
        before, average = average, _AVERAGE.fullmatch(text) or average
        others = _OTHERS.fullmatch(text)
        if before is None or others is None:
            continue
        average = None
        try:
            yield _report(before, others)
        except (ValueError, ZeroDivisionError):
            message = "a report contradicts itself: its mean is not between its extremes; it is ignored"
            problems.add("MEA009", Severity.ERROR, message, TracePlace(number, 1, text))


def _report(average: re.Match[str], others: re.Match[str]) -> tuple[str, TimeStatistics]:
    low, high, deviation, count = Fraction(others[1]), Fraction(others[2]), Fraction(others[3]), int(others[4])
    is_delay = average[1] == "delay"
    mean = Fraction(average[2]) if is_delay else 1 / Fraction(average[2])
    # The tools round the extremes and the mean each on their own.
    step = Fraction(MILLISECOND, SECOND)
    if not count or not low - step <= mean <= high + step:
        raise ValueError
    statistics = TimeStatistics(
        count=count,
        min=_time(low),
        mean=mean * SECOND,
        max=_time(high),
        variance=(deviation * SECOND) ** 2,
    )
    return ("duration" if is_delay else JobMetric.START_TO_START), statistics


def _time(seconds: Fraction) -> Time:
    return int(seconds * SECOND)


def _of_all_reports(reports: list[TimeStatistics]) -> TimeStatistics:
    last = reports[-1]
    low, high = min(each.min for each in reports), max(each.max for each in reports)
    return TimeStatistics(count=last.count, min=low, mean=last.mean, max=high, variance=last.variance)
