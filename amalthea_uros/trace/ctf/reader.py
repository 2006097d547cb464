"""Reads CTF traces: the events of all streams in the order of time, for what understands them (Zephyr, Linux, ROS 2)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from heapq import merge
from pathlib import Path

from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.trace.ctf.interpreters import Interpreter, LinuxScheduler, Zephyr
from amalthea_uros.trace.ctf.metadata import Metadata, read_metadata
from amalthea_uros.trace.ctf.ros2 import Ros2
from amalthea_uros.trace.ctf.streams import CtfEvent, PacketStream
from amalthea_uros.trace.files import METADATA, TracePlace, TraceProblems, UnreadableError, stream_files, trace_folders
from amalthea_uros.trace.reading import BLOCK, EventRows, TraceReader
from amalthea_uros.trace.schedulers.thread_log import UniqueNames
from amalthea_uros.trace.schedulers.thread_states import ThreadStates
from amalthea_uros.trace.table import NO_NOTE, EventKind, EventTable


class CtfReader(TraceReader):
    """Gives the events of the traces in a folder.

    Attributes
    ----------
    ros2, scheduler : what the events of ROS 2 and of Linux say, when they have been read; None if there are none
    computers : the names of those that were recorded, as keys
    """

    #: Those of ROS 2 begin with a publication.
    begin_of_chains = EventKind.CHAIN_STEP

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self.ros2: Ros2 | None = None
        self.scheduler: LinuxScheduler | None = None
        self.computers: dict[str, None] = {}
        self._of_files: list[TraceProblems] = []
        self._rows = EventRows(self._index, self._problems)
        self._states = ThreadStates(self._rows, self._problems)

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The problems so far."""
        return tuple(finding for problems in (*self._of_files, self._problems) for finding in problems.findings)

    def __iter__(self) -> Iterator[EventTable]:
        """The events, in consecutive tables.

        Raises
        ------
        ReadError : no metadata can be read.
        """
        traces = list(self._traces())
        if not traces:
            raise ReadError(self.findings)
        interpreters = _interpreters(self._rows, self._states, self._problems, [metadata for _, metadata in traces])
        self._keep(interpreters.values())
        self.computers |= dict.fromkeys(str(each.environment.get("hostname", "")) for _, each in traces)
        streams = [
            PacketStream(path, metadata, self._problems_of(path))
            for folder, metadata in traces
            for path in stream_files(folder)
        ]
        for number, event in enumerate(merge(*streams, key=lambda each: each.time), 1):
            self._add(event, interpreters)
            if number % BLOCK == 0 and (table := self._states.take()) is not None:
                yield table
        if (table := self._states.take(is_end=True)) is not None:
            yield table

    def _add(self, event: CtfEvent, interpreters: dict[str, Interpreter]) -> None:
        if not event.name:
            if self._rows.move_to(event.time, TracePlace()):
                self._states.lose(lost=NO_NOTE if event.lost is None else event.lost)
            self._lose()
            return
        interpreter = interpreters.get(event.name)
        if interpreter is None:
            return
        if self._rows.move_to(event.time, TracePlace()):
            interpreter.add(event)
        else:
            self._states.lose()
            self._lose()

    def _lose(self) -> None:
        for each in (self.ros2, self.scheduler):
            if each is not None:
                each.lose()

    def _keep(self, interpreters: Iterable[Interpreter]) -> None:
        for each in interpreters:
            if isinstance(each, Ros2):
                self.ros2 = each
            elif isinstance(each, LinuxScheduler):
                self.scheduler = each
        if self.ros2 is not None and self.scheduler is not None:
            self.ros2.threads = self.scheduler.threads

    def _traces(self) -> Iterator[tuple[Path, Metadata]]:
        for folder in trace_folders(self._path):
            path = folder / METADATA
            try:
                yield folder, read_metadata(path)
            except UnreadableError as error:
                advice = "Use the metadata of the very build that was recorded."
                self._problems_of(path).add(
                    "TRC024", Severity.ERROR, f"the metadata are wrong: {error}", TracePlace(error.line), advice
                )
            except OSError as error:
                self._problems_of(path).add("TRC001", Severity.ERROR, f"the file cannot be read: {error.strerror or error}")

    def _problems_of(self, path: Path) -> TraceProblems:
        self._of_files.append(TraceProblems(path))
        return self._of_files[-1]


def _interpreters(
    rows: EventRows, states: ThreadStates, problems: TraceProblems, traces: Sequence[Metadata]
) -> dict[str, Interpreter]:
    """What understands the events of some traces, by the names of the events."""
    names = {event.name for metadata in traces for stream in metadata.streams.values() for event in stream.events.values()}
    makers, unique = (Zephyr, LinuxScheduler, Ros2), UniqueNames()
    found: dict[str, Interpreter] = {}
    for maker in makers:
        known = maker.events(names)
        if known:
            found |= dict.fromkeys(known, maker(rows, states, problems, unique))
    if not found:
        message = "the trace has no events of Zephyr, of the scheduler of Linux, or of ros2_tracing"
        problems.add(
            "TRC003",
            Severity.WARNING,
            f"{message}; its events are ignored",
            advice="Convert it to CSV.",
        )
    return found
