"""Text logs with an event in each line: TRACE32 of Lauterbach, and `trace dump` of NuttX."""

from __future__ import annotations

import re

from amalthea_uros.trace.schedulers.thread_log import ThreadLogReader, picoseconds
from amalthea_uros.trace.schedulers.thread_states import Leaving

# What TRACE32 writes with `Trace.EXPORT.TASKEVENTS`: time in ns; task; event;
# Source: general_ref_t.pdf of TRACE32, and the description of its exports by the project t32perf.

_NANOSECOND = 3
_TASK_EVENT = re.compile(r"\s*([+-]?[0-9]{1,30})\s*;([^;]*);\s*([A-Za-z]+)\s*;.*")
#: What `switch` names if no task executes.
_NO_TASK = frozenset({"NO_TASK", ""})
#: Events that say nothing which the others do not.
_REDUNDANT = frozenset({"schedule"})


def is_task_events(head: str) -> bool:
    """Whether the first characters of a file are of this format."""
    lines = [line for line in head.splitlines() if line.strip() and not line.startswith("#")][:5]
    return bool(lines) and all(map(_TASK_EVENT.fullmatch, lines))


class TaskEventReader(ThreadLogReader):
    """Gives the events of an export, which are those of one core."""

    def _read(self, text: str) -> None:
        if text.startswith("#"):
            return
        match = _TASK_EVENT.fullmatch(text)
        time = picoseconds(match[1], _NANOSECOND) if match else None
        if match is None or time is None:
            self._reject("a line is not an event: time in ns; task; event;")
        elif self._move_to(time):
            self._read_event(match[3].lower(), match[2].strip())

    def _read_event(self, event: str, name: str) -> None:
        core, states = self._core(0), self._states
        if event == "switch":
            self._switch_to(core, name, name in _NO_TASK)
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
            self._leave_out("an event of an unknown kind")

    def _leave(self, core: int, name: str, leaving: Leaving) -> None:
        """A task leaves the core; where the switch has been recorded before, its reason is known now."""
        task = self._task(name)
        if self._states.is_on(core, task):
            self._states.switch_out(core, task, leaving)
        else:
            self._states.block(task, leaving)


# What `trace dump` of NuttX prints: text like that of ftrace of Linux, of which scheduling, interrupts and marks are used.
# Source: drivers/note/noteram_driver.c and the guide "Task Trace" of NuttX.


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

    def _read(self, text: str) -> None:
        match = _LINE.fullmatch(text)
        if match is None:
            self._read_other(text)
            return
        core, stamp, event, colon, arguments = match.groups()
        time = picoseconds(stamp)
        if time is None:
            self._reject("the time is not a number of seconds")
        elif event.startswith("sys_") or not colon:
            return  # system calls, of which the times are in the dump as well
        elif self._move_to(time):
            self._read_event(event, self._core(int(core)), arguments)

    def _read_other(self, text: str) -> None:
        lost = _LOST.fullmatch(text)
        if lost is not None:
            self._lose(int(lost[1]))
        elif not text.lstrip().startswith("#"):
            self._reject("a line is not an event: task-pid [core] seconds: event: arguments")

    def _read_event(self, event: str, core: int, arguments: str) -> None:
        if event == "sched_switch" and (match := _SWITCH.fullmatch(arguments)):
            self._switch(core, match)
        elif event in _WAKING and (match := _WAKE.fullmatch(arguments)):
            if (thread := self._thread(match[1], match[2])) is not None:
                if event == "sched_wakeup_new":
                    self._states.make_known(thread)
                self._states.make_ready(thread)
        elif event == "irq_handler_entry" and (match := _ENTRY.fullmatch(arguments)):
            name = self._names.name(("irq", match[1]), match[2] or "", match[1], "IRQ")
            self._states.enter_interrupt(core, self._interrupt(name))
        elif event == "irq_handler_exit" and arguments.startswith("irq="):
            self._states.exit_interrupt(core)
        elif event in ("tracing_mark_write", "print") and (match := _MARK.fullmatch(arguments)):
            kind, text = match[1] or match[3], (match[2] or "").strip()
            self._mark(core, text if kind == "I" else f"{kind}|{text}")
        else:
            self._leave_out("an event of another kind, or with other arguments")

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


def _leaving(state: str) -> Leaving:
    """What `prev_state` says: R is ready, X and Z have ended, all others wait for something."""
    letter = state[0]
    return Leaving.READY if letter == "R" else Leaving.ENDED if letter in "XZ" else Leaving.BLOCKED
