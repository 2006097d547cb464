"""Reads the list of events that SystemView of SEGGER exports as CSV.

There is no public specification; columns and events are those of exports that public readers understand, and of the manual UM08027.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from amalthea_uros.trace.table_log import TableLogReader, headings
from amalthea_uros.trace.thread_states import Leaving

_COLUMNS = {"time": ["time"], "context": ["context"], "event": ["event"], "detail": ["details?"], "core?": ["core", "cpu"]}
_MARKER = re.compile(r"(start|stop)\s+marker\s*(.*)|marker\s*(.*)")
#: Events that say nothing of times.
_IGNORED = re.compile(
    r"(?:trace|recording|system (?:info|description)|task (?:create|terminate)|init|stack|name|resource).*|.*info"
)


def matches(head: str) -> bool:
    """Whether the first characters of a file are of this format."""
    return any(headings(line, _COLUMNS) for line in head.splitlines()[:50])


class Reader(TableLogReader):
    """Gives the events of an export."""

    columns = _COLUMNS

    def _unit(self, heading: str, text: str) -> int:
        return 12  # SystemView shows seconds

    def _read_row(self, fields: Mapping[str, str], number: int, text: str) -> None:
        states, context, detail = self._states, fields["context"], fields["detail"]
        event = " ".join(fields["event"].lower().split())
        core = self._core(_number(fields.get("core", "")))
        if "overflow" in event or "*** OVERFLOW ***" in detail:
            self._lose(number, text)
            if "overflow" in event:
                return
        if event == "task run":
            states.switch_in(core, self._task(context))
        elif event == "system idle":
            states.switch_out(core)
        elif event == "task stop":
            states.switch_out(core, self._task(context), Leaving.BLOCKED)
        elif event in ("task ready", "task block"):
            self._change_state(event, _task_of(detail), number, text)
        elif event == "isr enter":
            states.enter_interrupt(core, self._interrupt(context))
        elif event == "isr exit" or event.startswith("isr exit to scheduler"):
            states.exit_interrupt(core, self._interrupt(context))
        elif match := _MARKER.fullmatch(event):
            self._read_marker(core, match, detail)
        elif not _IGNORED.fullmatch(event):
            self._leave_out("an event that is not about tasks, interrupts or markers", number, text)

    def _change_state(self, event: str, name: str, number: int, text: str) -> None:
        """Of these events the context is what causes them; the task is in the detail."""
        if not name:
            self._reject("the detail does not name the task", number, text)
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


def _number(core: str) -> int:
    digits = re.sub(r"[^0-9]", "", core)[:4]
    return int(digits) if digits else 0
