"""JSON for programs: the fields that the class of a result declares. Times are picoseconds under names that end in `_ps`."""

from __future__ import annotations

from importlib import import_module
from typing import IO, Any

from amalthea_uros._version import __version__
from amalthea_uros.report.basics.json_text import write_json
from amalthea_uros.report.fields import FIELDS
from amalthea_uros.report.fields.declaration import json_of


def content(result: object) -> dict[str, Any]:
    """The fields of a result."""
    import_module(f"amalthea_uros.report.fields.{FIELDS[type(result).__name__]}")
    found: dict[str, Any] = json_of(result)
    return found


def write(result: object, stream: IO[str]) -> None:
    """Write one object, with the version of the tool."""
    write_json({"amuros": __version__, **content(result)}, stream)
