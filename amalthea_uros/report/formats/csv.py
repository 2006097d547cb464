"""Comma-separated values; each result has a module in `report/csv` that gives its rows, the header first."""

from __future__ import annotations

import csv
from typing import IO

from amalthea_uros.report.by_result import module_for, rendered_in

RENDERS = rendered_in("csv")


def write(result: object, stream: IO[str]) -> None:
    """Write the rows of a result."""
    csv.writer(stream, lineterminator="\n").writerows(module_for(result, "csv").rows(result))
