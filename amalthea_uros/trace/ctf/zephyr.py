"""The events of Zephyr, of older and newer releases (subsys/tracing/ctf of Zephyr).

Semaphores, mutexes and timers are not used: that a thread blocks and becomes ready is recorded for itself. Interrupts are recorded
without their numbers, so all of them are one ISR.
"""

from __future__ import annotations

import re
from typing import ClassVar

from amalthea_uros.trace.ctf.interpreter import Handler, Interpreter
from amalthea_uros.trace.ctf.streams import CtfEvent
from amalthea_uros.trace.event_rows import EventRows
from amalthea_uros.trace.problems import Problems
from amalthea_uros.trace.table import EntityKind
from amalthea_uros.trace.thread_log import add_mark
from amalthea_uros.trace.thread_states import Leaving, ThreadStates
from amalthea_uros.trace.unique_names import UniqueNames

_IDLE = re.compile(r"idle(?: ?[0-9]{1,3})?", re.IGNORECASE)


class Zephyr(Interpreter):
    """Takes the events of Zephyr."""

    def __init__(self, rows: EventRows, states: ThreadStates, problems: Problems, names: UniqueNames) -> None:
        super().__init__(rows, states, problems, names)
        self._created_threads: set[int] = set()

    def finish(self) -> None:
        """Nothing: all is known when it happens."""

    def _switched_in(self, event: CtfEvent) -> None:
        core, thread = self._core_of(event), self._thread(event)
        if thread is None:
            self._states.switch_out(core)
        else:
            self._states.switch_in(core, thread)

    def _switched_out(self, event: CtfEvent) -> None:
        thread = self._thread(event)
        if thread is not None:
            self._states.switch_out(self._core_of(event), thread)

    def _created(self, event: CtfEvent) -> None:
        """A thread gets its name after its creation, so it is known by the next event that has one."""
        self._created_threads.add(event.fields.get("thread_id", 0))

    def _ready(self, event: CtfEvent) -> None:
        thread = self._thread(event)
        if thread is not None:
            self._states.make_ready(thread)

    def _pending(self, event: CtfEvent) -> None:
        thread = self._thread(event)
        if thread is not None:
            self._states.block(thread)

    def _aborted(self, event: CtfEvent) -> None:
        thread = self._thread(event)
        if thread is not None:
            self._states.block(thread, Leaving.ENDED)

    def _isr_enter(self, event: CtfEvent) -> None:
        self._states.enter_interrupt(self._core_of(event), self._entity(EntityKind.ISR, "ISR"))

    def _isr_exit(self, event: CtfEvent) -> None:
        self._states.exit_interrupt(self._core_of(event))

    def _idle(self, event: CtfEvent) -> None:
        self._states.switch_out(self._core_of(event))

    def _named(self, event: CtfEvent) -> None:
        text = str(event.fields.get("name", ""))
        add_mark(self._states, self._core_of(event), text, lambda name: self._entity(EntityKind.RUNNABLE, name))

    def _core_of(self, event: CtfEvent) -> int:
        return self._core(event.fields.get("core_id", event.context.get("core_id", event.core)))

    def _thread(self, event: CtfEvent) -> int | None:
        """The thread of an event, None if it is one that executes while there is nothing to do."""
        number, name = event.fields.get("thread_id", 0), str(event.fields.get("name", ""))
        if _IDLE.fullmatch(name):
            return None
        known = "" if name == "unknown" else name
        # The number is an address, at which there can be another thread later.
        thread = self._entity(EntityKind.TASK, self._names.name((number, known), known, f"{number:#x}", "thread"))
        if number in self._created_threads:
            self._created_threads.remove(number)
            self._states.make_known(thread)
        return thread

    handlers: ClassVar[dict[str, Handler]] = {
        "thread_switched_in": _switched_in,
        "thread_switched_out": _switched_out,
        "thread_create": _created,
        "thread_ready": _ready,
        "thread_pending": _pending,
        "thread_suspend": _pending,
        "thread_abort": _aborted,
        "isr_enter": _isr_enter,
        "isr_exit": _isr_exit,
        "isr_exit_to_scheduler": _isr_exit,
        "idle": _idle,
        "named_event": _named,
    }
    characteristic = frozenset({"thread_switched_in", "thread_switched_out", "isr_enter", "named_event"})
