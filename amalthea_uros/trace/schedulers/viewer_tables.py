"""Reads tables that viewers of traces export: SystemView of SEGGER, Tracealyzer of Percepio."""

from __future__ import annotations

import csv
import re
from abc import abstractmethod
from collections.abc import Mapping, Sequence

from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.files import TracePlace
from amalthea_uros.trace.schedulers.thread_log import ThreadLogReader, picoseconds
from amalthea_uros.trace.schedulers.thread_states import Leaving

#: What may separate columns.
_DELIMITERS = "\t;,"
#: What viewers put between the digits of numbers: blanks of all kinds and apostrophes.
_GROUPING = re.compile(r"[\s'\u2019_]+")
#: Units in headings, as powers of ten of picoseconds.
_UNITS = {"ns": 3, "us": 6, "µs": 6, "μs": 6, "ms": 9, "s": 12}
_UNIT = re.compile(r"[\[(]\s*(ns|us|µs|μs|ms|s)\s*[\])]|\b(ns|us|ms)\b")


def fields_of(line: str, delimiter: str) -> list[str]:
    """The fields of a line, without the blanks around them."""
    try:
        row = next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [])
    except csv.Error:
        return []
    return [field.strip() for field in row]


def headings(line: str, wanted: Mapping[str, Sequence[str]]) -> tuple[str, dict[str, int]] | None:
    """The delimiter and the places of columns in a line of headings, None if the line is none.

    Parameters
    ----------
    wanted : of each column the words of which its heading contains one, and the first ones are preferred; columns of which the name
        ends in a question mark need not be there
    """
    for delimiter in _DELIMITERS:
        fields = [field.lower() for field in fields_of(line, delimiter)]
        found: dict[str, int] = {}
        for column, words in wanted.items():
            places = (place for word in words for place, field in enumerate(fields) if re.search(rf"\b{word}\b", field))
            place = next((place for place in places if place not in found.values()), None)
            if place is not None:
                found[column.removesuffix("?")] = place
            elif not column.endswith("?"):
                break
        else:
            return delimiter, found
    return None


class TableLogReader(ThreadLogReader):
    """Gives the events of a table with headings.

    Attributes
    ----------
    columns : the words in their headings
    """

    columns: Mapping[str, Sequence[str]] = {}

    _delimiter = ","
    _places: dict[str, int] | None = None
    _exponent = _UNITS["s"]

    @abstractmethod
    def _read_row(self, fields: Mapping[str, str]) -> None:
        """Read a row of which the time is that of the next events."""

    def _read(self, text: str) -> None:
        if self._places is None:
            self._read_heading(text)
            return
        row = fields_of(text, self._delimiter)
        if len(row) <= max(self._places.values()):
            self._reject("a line has fewer fields than the headings")
            return
        fields = {column: row[place] for column, place in self._places.items()}
        time = picoseconds(_plain(fields["time"]), self._exponent)
        if time is None:
            self._reject("the time is not a number")
        elif self._move_to(time):
            self._read_row(fields)

    def _read_heading(self, text: str) -> None:
        found = headings(text, self.columns)
        if found is not None:
            self._delimiter, self._places = found
            heading = fields_of(text, self._delimiter)[self._places["time"]].lower()
            self._exponent = self._unit(heading, text)

    def _unit(self, heading: str, text: str) -> int:
        match = _UNIT.search(heading)
        if match is None:
            message = "the heading of the time has no unit; assuming seconds"
            self._problems.add(
                "TRC005", Severity.INFO, message, TracePlace(None, None, text), "Export with the unit, e.g. Time (us)."
            )
            return _UNITS["s"]
        return _UNITS[match[1] or match[2]]


def _plain(text: str) -> str:
    """A number without the characters that group its digits."""
    digits = _GROUPING.sub("", text).removesuffix("s")
    return digits.replace(",", ".") if digits.count(",") == 1 and "." not in digits else digits


# Reads the list of events that SystemView of SEGGER exports as CSV.
#
# There is no public specification; columns and events are those of exports that public readers understand, and of the manual UM08027.

_SYSTEMVIEW = {"time": ["time"], "context": ["context"], "event": ["event"], "detail": ["details?"], "core?": ["core", "cpu"]}
_MARKER = re.compile(r"(start|stop)\s+marker\s*(.*)|marker\s*(.*)")
#: Events that say nothing of times.
_UNTIMED = re.compile(
    r"(?:trace|recording|system (?:info|description)|task (?:create|terminate)|init|stack|name|resource).*|.*info"
)


def is_systemview(head: str) -> bool:
    """Whether the first characters of a file are of this format."""
    return any(headings(line, _SYSTEMVIEW) for line in head.splitlines()[:50])


class SystemviewReader(TableLogReader):
    """Gives the events of an export."""

    columns = _SYSTEMVIEW

    def _unit(self, heading: str, text: str) -> int:
        return 12  # SystemView shows seconds

    def _read_row(self, fields: Mapping[str, str]) -> None:
        states, context, detail = self._states, fields["context"], fields["detail"]
        event = " ".join(fields["event"].lower().split())
        core = self._core(_core_number(fields.get("core", "")))
        if "overflow" in event or "*** OVERFLOW ***" in detail:
            self._lose()
            if "overflow" in event:
                return
        if event == "task run":
            states.switch_in(core, self._task(context))
        elif event == "system idle":
            states.switch_out(core)
        elif event == "task stop":
            states.switch_out(core, self._task(context), Leaving.BLOCKED)
        elif event in ("task ready", "task block"):
            self._change_state(event, _task_of(detail))
        elif event == "isr enter":
            states.enter_interrupt(core, self._interrupt(context))
        elif event == "isr exit" or event.startswith("isr exit to scheduler"):
            states.exit_interrupt(core, self._interrupt(context))
        elif match := _MARKER.fullmatch(event):
            self._read_marker(core, match, detail)
        elif not _UNTIMED.fullmatch(event):
            self._leave_out("an event that is not about tasks, interrupts or markers")

    def _change_state(self, event: str, name: str) -> None:
        """Of these events the context is what causes them; the task is in the detail."""
        if not name:
            self._reject("the detail does not name the task")
        elif event == "task ready":
            self._states.make_ready(self._task(name))
        else:
            self._states.block(self._task(name))

    def _read_marker(self, core: int, match: re.Match[str], detail: str) -> None:
        name = f"Marker {match[2] or match[3] or detail}".strip()
        if match[1] == "start":
            self._states.start_runnable_on(core, self._runnable(name))
        elif match[1] == "stop":
            self._states.end_runnable_on(core, self._runnable(name))
        else:
            self._states.mark_moment(core, self._runnable(name))


def _task_of(detail: str) -> str:
    """The name at the begin of a detail such as `Sensor, runs after 771.063 us`."""
    return detail.split(",", 1)[0].strip().strip('"')


def _core_number(core: str) -> int:
    digits = re.sub(r"[^0-9]", "", core)[:4]
    return int(digits) if digits else 0


# Reads the event log that Tracealyzer of Percepio exports as text.
#
# There is no public specification: the columns are found by their headings, and the events by the sentences that Tracealyzer shows.

_TRACEALYZER = {
    "time": ["timestamp", "time"],
    "actor": ["actor", "task", "thread", "context"],
    "event": ["event text", "event", "text", "description"],
    "core?": ["core", "cpu"],
}
_SWITCH = re.compile(r"(?:context switch|task[- ]switch)(?: on (?:cpu|core) ([0-9]{1,4}))? to (.+)", re.IGNORECASE)
_READY = re.compile(r"(?:actor|task|thread) ready: *(.+)", re.IGNORECASE)
_BLOCK = re.compile(r".*\bblocks?(?:\b.*)?", re.IGNORECASE | re.DOTALL)
_BEGIN = re.compile(r"isr (?:begin|enter)(?: *: *(.+))?", re.IGNORECASE)
_END = re.compile(r"isr (?:end|exit|return).*", re.IGNORECASE)
_USER = re.compile(r"(?:\[([^\]]+)\]|user event:?) *(.*)", re.IGNORECASE | re.DOTALL)
_LOST = re.compile(r".*(?:missed|lost|dropped) events?.*", re.IGNORECASE | re.DOTALL)
_IDLE = re.compile(r"idle(?: ?task)?[ 0-9]*|\(?startup\)?", re.IGNORECASE)


def is_tracealyzer(head: str) -> bool:
    """Whether the first characters of a file are of this format."""
    lines = head.splitlines()
    return any(headings(line, _TRACEALYZER) for line in lines[:50]) and any(map(_mentions_a_switch, lines))


def _mentions_a_switch(line: str) -> bool:
    text = line.lower()
    return "switch" in text or "ready:" in text


class TracealyzerReader(TableLogReader):
    """Gives the events of an export."""

    columns = _TRACEALYZER

    def _read_row(self, fields: Mapping[str, str]) -> None:
        states, event, actor = self._states, fields["event"], fields["actor"]
        core = self._core(_core_number(fields.get("core", "")))
        if _LOST.fullmatch(event):
            self._lose()
        elif match := _SWITCH.fullmatch(event):
            name = match[2].strip()
            self._switch_to(self._core(int(match[1])) if match[1] else core, name, _IDLE.fullmatch(name) is not None)
        elif match := _READY.fullmatch(event):
            if not _IDLE.fullmatch(match[1].strip()):
                states.make_ready(self._task(match[1].strip()))
        elif match := _BEGIN.fullmatch(event):
            states.enter_interrupt(core, self._interrupt((match[1] or actor).strip()))
        elif _END.fullmatch(event):
            states.exit_interrupt(core)
        elif match := _USER.fullmatch(event):
            self._mark(core, _text_of(match[1] or "", match[2]))
        elif _BLOCK.fullmatch(event) and actor and not _IDLE.fullmatch(actor):
            states.block(self._task(actor))
        else:
            self._leave_out("an event that is not about scheduling, interrupts or user events")


def _text_of(channel: str, text: str) -> str:
    """The text of a user event with the name of its channel, after the mark of an interval if there is one."""
    mark = text[:2] if text[:2] in ("B|", "E|") else ""
    return f"{mark}{channel} {text[len(mark) :]}"
