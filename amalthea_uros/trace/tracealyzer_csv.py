"""Reads the event log that Tracealyzer of Percepio exports as text.

There is no public specification: the columns are found by their headings, and the events by the sentences that Tracealyzer shows.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from amalthea_uros.trace.table_log import TableLogReader, headings

_COLUMNS = {
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


def matches(head: str) -> bool:
    """Whether the first characters of a file are of this format."""
    lines = head.splitlines()
    return any(headings(line, _COLUMNS) for line in lines[:50]) and any(map(_mentions_a_switch, lines))


def _mentions_a_switch(line: str) -> bool:
    text = line.lower()
    return "switch" in text or "ready:" in text


class Reader(TableLogReader):
    """Gives the events of an export."""

    columns = _COLUMNS

    def _read_row(self, fields: Mapping[str, str], number: int, text: str) -> None:
        states, event, actor = self._states, fields["event"], fields["actor"]
        digits = re.sub(r"[^0-9]", "", fields.get("core", ""))[:4]
        core = self._core(int(digits or 0))
        if _LOST.fullmatch(event):
            self._lose(number, text)
        elif match := _SWITCH.fullmatch(event):
            self._switch(self._core(int(match[1])) if match[1] else core, match[2].strip())
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
            self._leave_out("an event that is not about scheduling, interrupts or user events", number, text)

    def _switch(self, core: int, name: str) -> None:
        if _IDLE.fullmatch(name):
            self._states.switch_out(core)
        else:
            self._states.switch_in(core, self._task(name))


def _text_of(channel: str, text: str) -> str:
    """The text of a user event with the name of its channel, after the mark of an interval if there is one."""
    mark = text[:2] if text[:2] in ("B|", "E|") else ""
    return f"{mark}{channel} {text[len(mark) :]}"
