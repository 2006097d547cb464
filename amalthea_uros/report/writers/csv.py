"""A measurement as the table of its values, which `amuros measure` reads again."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from itertools import repeat
from typing import IO

from amalthea_uros._internal.csv_cells import safe_cell
from amalthea_uros.measure.series import Measurement


def write(measurement: Measurement, stream: IO[str]) -> None:
    """Write a row for each value; series of which only statistics are known have none."""
    csv.writer(stream, lineterminator="\n").writerows(_rows(measurement))


def _rows(measurement: Measurement) -> Iterator[Sequence[object]]:
    yield ("object", "kind", "quantity", "time_ps", "value_ps")
    for series in measurement.series:
        if series.values is not None:
            name = safe_cell(series.name)
            times = repeat("", len(series.values)) if series.times is None else series.times.tolist()
            for time, value in zip(times, series.values.tolist(), strict=True):
                yield name, series.kind, series.quantity, time, value
