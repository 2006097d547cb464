"""Text for people; each result has a module in `report/text`."""

from __future__ import annotations

from typing import IO

from amalthea_uros.report.by_result import module_for, rendered_in
from amalthea_uros.report.terminal import Terminal

RENDERS = rendered_in("text")


def write(result: object, stream: IO[str]) -> None:
    """Write tables and sentences, in colour on a terminal."""
    module_for(result, "text").write(result, Terminal(stream))
