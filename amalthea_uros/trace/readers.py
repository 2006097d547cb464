"""Reading traces of any known format, some events at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, cast

from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.trace.table import Entity, EventTable

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

#: The modules that read a format, by the ends of file names. `.gz` may follow each of them.
READERS = {".btf": "btf_reader", ".csv": "csv_reader"}


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


def open_trace(path: Path) -> TraceReader:
    """A reader for a file, by the end of its name.

    Raises
    ------
    InvalidArgumentError : no reader is known for it.
    ReadError : when events are read, if the file cannot be.
    """
    name = path.name.lower().removesuffix(".gz")
    module = next((module for suffix, module in READERS.items() if name.endswith(suffix)), None)
    if module is None:
        raise InvalidArgumentError(
            f"the format of the trace {path.name!r} is not known; the name of the file must end in one of {', '.join(READERS)}, "
            "and may be followed by .gz, e.g. run.btf.gz"
        )
    return cast("Callable[[Path], TraceReader]", import_module(f"amalthea_uros.trace.{module}").Reader)(path)
