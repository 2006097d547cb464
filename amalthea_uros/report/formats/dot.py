"""The data flow of a system as a graph of Graphviz."""

from __future__ import annotations

from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from amalthea_uros.services.report import ReportContent

RENDERS = ("ReportContent",)


def write(content: ReportContent, stream: IO[str]) -> None:
    """Write the graph."""
    from amalthea_uros.report.writers.graphs import dot

    stream.write(dot(content.system))
