"""A report as one HTML page."""

from __future__ import annotations

from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from amalthea_uros.services.report import ReportContent

RENDERS = ("ReportContent",)


def write(content: ReportContent, stream: IO[str]) -> None:
    """Write the page."""
    from amalthea_uros.report.writers.html import render

    stream.write(render(content))
