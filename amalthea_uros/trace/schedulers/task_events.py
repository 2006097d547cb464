"""Reads what TRACE32 of Lauterbach writes with `Trace.EXPORT.TASKEVENTS`: time in ns; task; event;

Source: general_ref_t.pdf of TRACE32, and the description of its exports by the project t32perf.
"""

from __future__ import annotations

import re

from amalthea_uros.trace.problems import TracePlace
from amalthea_uros.trace.schedulers.thread_log import ThreadLogReader, picoseconds
from amalthea_uros.trace.schedulers.thread_states import Leaving

_NANOSECOND = 3
_LINE = re.compile(r"\s*([+-]?[0-9]{1,30})\s*;([^;]*);\s*([A-Za-z]+)\s*;.*")
#: What `switch` names if no task executes.
_NO_TASK = frozenset({"NO_TASK", ""})
#: Events that say nothing which the others do not.
_REDUNDANT = frozenset({"schedule"})


def is_task_events(head: str) -> bool:
    """Whether the first characters of a file are of this format."""
    lines = [line for line in head.splitlines() if line.strip() and not line.startswith("#")][:5]
    return bool(lines) and all(map(_LINE.fullmatch, lines))


class TaskEventReader(ThreadLogReader):
    """Gives the events of an export, which are those of one core."""

    def _read(self, text: str, number: int) -> None:
        if text.startswith("#"):
            return
        match = _LINE.fullmatch(text)
        time = picoseconds(match[1], _NANOSECOND) if match else None
        if match is None or time is None:
            self._reject("a line is not an event: time in ns; task; event;", number, text)
        elif self._move_to(time, number, text):
            self._read_event(match[3].lower(), match[2].strip(), TracePlace(number, 1, text))

    def _read_event(self, event: str, name: str, place: TracePlace) -> None:
        core, states = self._core(0), self._states
        if event == "switch":
            self._switch(core, name)
        elif name in _NO_TASK:
            states.switch_out(core)  # as in the first record of exports: the task from which it goes away is not known
        elif event in ("activate", "release"):
            states.make_ready(self._task(name))
        elif event in ("start", "resume"):
            states.switch_in(core, self._task(name))
        elif event == "preempt":
            self._leave(core, name, Leaving.READY)
        elif event in ("terminate", "stop"):
            self._leave(core, name, Leaving.ENDED)
        elif event == "wait":
            self._leave(core, name, Leaving.WAITING)
        elif event == "runnablestart":
            states.start_runnable_on(core, self._runnable(name))
        elif event == "runnablestop":
            states.end_runnable_on(core, self._runnable(name))
        elif event == "isrstart":
            states.enter_interrupt(core, self._interrupt(name))
        elif event == "isrend":
            states.exit_interrupt(core, self._interrupt(name))
        elif event not in _REDUNDANT:
            self._leave_out("an event of an unknown kind", place.line or 0, place.text or "")

    def _switch(self, core: int, name: str) -> None:
        if name in _NO_TASK:
            self._states.switch_out(core)
        else:
            self._states.switch_in(core, self._task(name))

    def _leave(self, core: int, name: str, leaving: Leaving) -> None:
        """A task leaves the core; where the switch has been recorded before, its reason is known now."""
        task = self._task(name)
        if self._states.is_on(core, task):
            self._states.switch_out(core, task, leaving)
        else:
            self._states.block(task, leaving)
