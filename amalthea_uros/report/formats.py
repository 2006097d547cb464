"""The output formats: which results each of them can write, and what writes them.

Classes and modules are named and not imported, because commands list the formats when they start.
"""

from __future__ import annotations

from collections.abc import Container, Mapping
from importlib import import_module
from pathlib import Path
from typing import IO

from amalthea_uros._internal.garbage import paused_garbage_collection
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.report.documents import DOCUMENTS
from amalthea_uros.report.fields import FIELDS

#: The format that people read; the default of every command.
TEXT = "text"
_CHECK, _REPORT = ("CheckResult",), ("ReportContent",)

#: Formats, the functions of `report.writers` that write them, and the classes of the results.
FORMATS: Mapping[str, tuple[str, Container[str]]] = {
    TEXT: ("text.write", DOCUMENTS.keys() - _REPORT),
    "csv": ("csv.write", ("Measurement",)),
    "dot": ("graphs.write_dot", _REPORT),
    "github": ("github.write", _CHECK),
    "html": ("html.write", _REPORT),
    "json": ("json.write", FIELDS),
    "junit": ("junit.write", _CHECK),
    "markdown": ("markdown.write", ("Comparison", "Measurement", "MigrationResult", *_REPORT)),
    "mermaid": ("graphs.write_mermaid", _REPORT),
    "sarif": ("sarif.write", _CHECK),
}
#: The formats of reports by the suffixes of their files.
SUFFIXES = {".html": "html", ".md": "markdown", ".mmd": "mermaid", ".dot": "dot"}


def formats_for(result: str) -> list[str]:
    """The names of the formats that can write a result, by the name of its class, text first."""
    return [name for name, (_, results) in FORMATS.items() if result in results]


def write(name: str, result: object, stream: IO[str]) -> None:
    """Write a result in a format."""
    module, _, function = FORMATS[name][0].partition(".")
    with paused_garbage_collection():
        getattr(import_module(f"amalthea_uros.report.writers.{module}"), function)(result, stream)


def format_of(path: Path) -> str:
    """The format of the file of a report.

    Raises
    ------
    InvalidArgumentError : another suffix.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise InvalidArgumentError(f"the suffix of {str(path)!r} says no format; expected one of {', '.join(SUFFIXES)}")
    return SUFFIXES[path.suffix.lower()]
