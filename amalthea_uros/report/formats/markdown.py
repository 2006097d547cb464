"""Markdown, for a wiki, the description of a change, or a comment of a CI system; each result has a module in `report/markdown`."""

from __future__ import annotations

from typing import IO

from amalthea_uros.report.by_result import module_for, rendered_in

RENDERS = rendered_in("markdown")


def write(result: object, stream: IO[str]) -> None:
    """Write the lines of a result."""
    stream.write("\n".join(module_for(result, "markdown").lines(result)) + "\n")
