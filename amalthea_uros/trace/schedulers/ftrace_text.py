"""Reads what `trace dump` of NuttX prints: text like that of ftrace of Linux, of which scheduling, interrupts and marks are used.

Source: drivers/note/noteram_driver.c and the guide "Task Trace" of NuttX.
"""

from __future__ import annotations

import re

from amalthea_uros.trace.problems import TracePlace
from amalthea_uros.trace.schedulers.thread_log import ThreadLogReader, picoseconds
from amalthea_uros.trace.schedulers.thread_states import Leaving

_LINE = re.compile(
    r"\s*.*-[0-9]{1,10}\s+(?:\([ 0-9-]+\)\s+)?\[([0-9]{1,4})\]\s+(?:[^\s:]{3,6}\s+)?([0-9]+\.[0-9]+):\s+(\w+)(:?)\s*(.*)"
)
_LOST = re.compile(r".*\[LOST ([0-9]{1,18}) EVENTS\].*")
_SWITCH = re.compile(
    r"prev_comm=(.*) prev_pid=([0-9]+)(?: prev_prio=\S+)? prev_state=(\S+) ==> next_comm=(.*) next_pid=([0-9]+)(?: next_prio=\S+)?\s*"
)
_WAKE = re.compile(r"comm=(.*) pid=([0-9]+)(?: .*)?")
_ENTRY = re.compile(r"irq=([0-9]+)(?: name=(.*))?")
_MARK = re.compile(r"(?:[0-9a-fx_]+: )?([BEI])\|[0-9]*(?:\|(.*))?|([BE])")
_IDLE = re.compile(r"(?:CPU[0-9]+ )?IDLE(?: Task)?|Idle_Task|swapper(?:/[0-9]+)?|<idle>", re.IGNORECASE)
_WAKING = frozenset({"sched_waking", "sched_wakeup", "sched_wakeup_new"})


def is_ftrace(head: str) -> bool:
    """Whether the first characters of a file are of this format."""
    lines = [line for line in head.splitlines() if line.strip()][:50]
    return any(_LINE.fullmatch(line) and ("sched_switch" in line or "sched_wak" in line or "irq_" in line) for line in lines)


class FtraceReader(ThreadLogReader):
    """Gives the events of a dump."""

    def _read(self, text: str, number: int) -> None:
        match = _LINE.fullmatch(text)
        if match is None:
            self._read_other(text, number)
            return
        core, stamp, event, colon, arguments = match.groups()
        time = picoseconds(stamp)
        if time is None:
            self._reject("the time is not a number of seconds", number, text)
        elif event.startswith("sys_") or not colon:
            return  # system calls, of which the times are in the dump as well
        elif self._move_to(time, number, text):
            self._read_event(event, self._core(int(core)), arguments, TracePlace(number, 1, text))

    def _read_other(self, text: str, number: int) -> None:
        lost = _LOST.fullmatch(text)
        if lost is not None:
            self._lose(number, text, int(lost[1]))
        elif not text.lstrip().startswith("#"):
            self._reject("a line is not an event: task-pid [core] seconds: event: arguments", number, text)

    def _read_event(self, event: str, core: int, arguments: str, place: TracePlace) -> None:
        if event == "sched_switch" and (match := _SWITCH.fullmatch(arguments)):
            self._switch(core, match)
        elif event in _WAKING and (match := _WAKE.fullmatch(arguments)):
            if (thread := self._thread(match[1], match[2])) is not None:
                if event == "sched_wakeup_new":
                    self._states.make_known(thread)
                self._states.make_ready(thread)
        elif event == "irq_handler_entry" and (match := _ENTRY.fullmatch(arguments)):
            self._states.enter_interrupt(core, self._interrupt_of(match))
        elif event == "irq_handler_exit" and arguments.startswith("irq="):
            self._states.exit_interrupt(core)
        elif event in ("tracing_mark_write", "print") and (match := _MARK.fullmatch(arguments)):
            self._mark_of(core, match)
        else:
            self._leave_out("an event of another kind, or with other arguments", place.line or 0, place.text or "")

    def _switch(self, core: int, match: re.Match[str]) -> None:
        before, state, after = self._thread(match[1], match[2]), match[3], self._thread(match[4], match[5])
        if before is not None:
            self._states.switch_out(core, before, _leaving(state))
        if after is not None:
            self._states.switch_in(core, after)

    def _thread(self, name: str, pid: str) -> int | None:
        """The thread with a name and a number, None for those that execute while there is nothing to do."""
        if pid == "0" or _IDLE.fullmatch(name):
            return None
        return self._task(self._names.name(pid, "" if name == "<noname>" else name, pid, "thread"))

    def _interrupt_of(self, match: re.Match[str]) -> int:
        return self._interrupt(self._names.name(("irq", match[1]), match[2] or "", match[1], "IRQ"))

    def _mark_of(self, core: int, match: re.Match[str]) -> None:
        kind, text = match[1] or match[3], (match[2] or "").strip()
        self._mark(core, text if kind == "I" else f"{kind}|{text}")


def _leaving(state: str) -> Leaving:
    """What `prev_state` says: R is ready, X and Z have ended, all others wait for something."""
    letter = state[0]
    return Leaving.READY if letter == "R" else Leaving.ENDED if letter in "XZ" else Leaving.BLOCKED
