"""JSON for programs; each result has a module in `report/json`. Times are picoseconds under names that end in `_ps`."""

from __future__ import annotations

from typing import IO

from amalthea_uros._version import __version__
from amalthea_uros.report.by_result import module_for, rendered_in
from amalthea_uros.report.escape import write_json

RENDERS = rendered_in("json")


def write(result: object, stream: IO[str]) -> None:
    """Write one object, with the version of the tool."""
    content = module_for(result, "json").content(result)
    write_json({"amuros": __version__, **content}, stream)
