"""Reading traces of any known format, some events at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, cast

from amalthea_uros._internal.files import is_directory
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.trace.ctf.folders import has_metadata
from amalthea_uros.trace.file_heads import first_characters
from amalthea_uros.trace.table import Entity, EventTable

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

#: The modules that read a format, by the ends of file names. `.gz` may follow each of them.
READERS = {".btf": "btf_reader", ".csv": "csv_reader"}
#: The modules of text formats that are recognised by the first lines, whatever the file is called, and what they are called.
RECOGNISED = {
    "task_events": "TRACE32 task events",
    "ftrace_text": "ftrace text (NuttX)",
    "systemview_csv": "SystemView CSV",
    "tracealyzer_csv": "Tracealyzer CSV",
}
#: The names of formats by the modules that read them.
FORMATS = {"btf_reader": "BTF", "csv_reader": "CSV", **RECOGNISED, "ctf.reader": "CTF"}
#: The ends of names of files whose contents are looked at, and so many characters of them.
_AMBIGUOUS = (".csv", ".txt", ".log", ".trace", ".ftrace")
_HEAD = 1 << 16


class TraceReader(Protocol):
    """Gives the events of a trace; it can be used once.

    Attributes
    ----------
    entities : complete when all events have been read
    findings : the problems met so far; everything else has been read
    """

    @property
    def entities(self) -> Sequence[Entity]:
        """The entities so far."""

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The problems so far."""

    def __iter__(self) -> Iterator[EventTable]:
        """The events, in consecutive tables."""

    def numbered(self) -> Iterator[tuple[EventTable, NDArray[np.int64]]]:
        """The same, with the number of the line of each event."""


def format_of(path: Path) -> str | None:
    """The module that reads a trace, a key of `FORMATS`, by the name and the first lines of the file; None if no one does."""
    if is_directory(path) and has_metadata(path):
        return "ctf.reader"
    name = path.name.lower().removesuffix(".gz")
    if name.endswith(_AMBIGUOUS):
        head = first_characters(path, _HEAD)
        for module in RECOGNISED:
            if import_module(f"amalthea_uros.trace.{module}").matches(head):
                return module
    return next((module for suffix, module in READERS.items() if name.endswith(suffix)), None)


def format_name(path: Path) -> str:
    """What the format of a trace is called; "" if no reader is known for it."""
    module = format_of(path)
    return "" if module is None else FORMATS[module]


def open_trace(path: Path) -> TraceReader:
    """A reader for a file or a folder, by its name and content.

    Raises
    ------
    InvalidArgumentError : no reader is known for it.
    ReadError : when events are read, if the file cannot be.
    """
    module = format_of(path)
    if module is None:
        raise InvalidArgumentError(
            f"the format of the trace {path.name!r} is not known; the name of the file must end in one of {', '.join(READERS)}, "
            "and may be followed by .gz, e.g. run.btf.gz; or it is a folder with a CTF trace, or a text file of one of: "
            f"{', '.join(RECOGNISED.values())}"
        )
    return cast("Callable[[Path], TraceReader]", import_module(f"amalthea_uros.trace.{module}").Reader)(path)
