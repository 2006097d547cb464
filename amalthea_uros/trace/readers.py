"""Reading traces of any known format, some events at a time."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from amalthea_uros._internal.files import is_directory
from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.trace.files import first_characters, has_metadata

if TYPE_CHECKING:
    from amalthea_uros.trace.reading import TraceReader

#: The ends of names of files whose contents are looked at, and so many characters of them.
_AMBIGUOUS = (".csv", ".txt", ".log", ".trace", ".ftrace")
_HEAD = 1 << 16


@dataclass(frozen=True, slots=True)
class TraceFormat:
    """A format of traces.

    Attributes
    ----------
    name : for messages
    module, reader : the module in this room that reads it, and the class in it
    suffix : the end of the names of files, which `.gz` may follow; "" for text that is recognised by its first lines
    recogniser : the function of the module that recognises the first characters of a text
    """

    name: str
    module: str
    reader: str
    suffix: str = ""
    recogniser: str = ""

    def attribute(self, name: str) -> Any:
        """A class or function of the module, which is imported only now."""
        return getattr(import_module(f"amalthea_uros.trace.{self.module}"), name)


CTF = TraceFormat("CTF", "ctf.reader", "CtfReader")
#: Recognised by the ends of file names.
BY_NAME = (
    TraceFormat("BTF", "btf_format", "BtfReader", suffix=".btf"),
    TraceFormat("CSV", "csv_format", "CsvReader", suffix=".csv"),
)
#: Recognised by the first lines, whatever the file is called.
BY_CONTENT = (
    TraceFormat("TRACE32 task events", "schedulers.event_lines", "TaskEventReader", recogniser="is_task_events"),
    TraceFormat("ftrace text (NuttX)", "schedulers.event_lines", "FtraceReader", recogniser="is_ftrace"),
    TraceFormat("SystemView CSV", "schedulers.viewer_tables", "SystemviewReader", recogniser="is_systemview"),
    TraceFormat("Tracealyzer CSV", "schedulers.viewer_tables", "TracealyzerReader", recogniser="is_tracealyzer"),
)


def format_of(path: Path) -> TraceFormat | None:
    """The format of a trace, by the name and the first lines of the file; None if it is not known."""
    if is_directory(path) and has_metadata(path):
        return CTF
    name = path.name.lower().removesuffix(".gz")
    if name.endswith(_AMBIGUOUS):
        head = first_characters(path, _HEAD)
        for known in BY_CONTENT:
            if known.attribute(known.recogniser)(head):
                return known
    return next((known for known in BY_NAME if name.endswith(known.suffix)), None)


def open_trace(path: Path) -> TraceReader:
    """A reader for a file or a folder, by its name and content.

    Raises
    ------
    InvalidArgumentError : no reader is known for it.
    ReadError : when events are read, if the file cannot be.
    """
    found = format_of(path)
    if found is None:
        suffixes, names = (", ".join(names) for names in ([f.suffix for f in BY_NAME], [f.name for f in BY_CONTENT]))
        raise InvalidArgumentError(
            f"the format of the trace {path.name!r} is not known; the name of the file must end in one of {suffixes}, "
            "and may be followed by .gz, e.g. run.btf.gz; or it is a folder with a CTF trace, or a text file of one of: "
            f"{names}"
        )
    reader: Callable[[Path], TraceReader] = found.attribute(found.reader)
    return reader(path)
