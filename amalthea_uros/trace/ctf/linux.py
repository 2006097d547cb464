"""The scheduler of Linux, as the kernel tracer of LTTng records it."""

from __future__ import annotations

from typing import ClassVar

from amalthea_uros.trace.ctf.interpreter import Handler, Interpreter
from amalthea_uros.trace.ctf.streams import CtfEvent
from amalthea_uros.trace.table import EntityKind
from amalthea_uros.trace.thread_states import Leaving

#: Of `prev_state`: 0 is ready, and so is what the kernel adds for a preemption; ended threads have these bits.
_PREEMPTED = 0x100
_ENDED = 0x10 | 0x20 | 0x80


class LinuxScheduler(Interpreter):
    """Takes the events of the scheduler and of interrupts."""

    def finish(self) -> None:
        """Nothing: all is known when it happens."""

    def _switch(self, event: CtfEvent) -> None:
        fields, core = event.fields, self._core(event.core)
        before, after = self._thread(fields, "prev_"), self._thread(fields, "next_")
        if before is not None:
            self._states.switch_out(core, before, _leaving(fields.get("prev_state", 0)))
        if after is not None:
            self._states.switch_in(core, after)

    def _waking(self, event: CtfEvent) -> None:
        thread = self._thread(event.fields, "")
        if thread is not None:
            self._states.make_ready(thread)

    def _irq_entry(self, event: CtfEvent) -> None:
        number = event.fields.get("irq", 0)
        name = self._names.name(("irq", number), str(event.fields.get("name", "")), str(number), "IRQ")
        self._states.enter_interrupt(self._core(event.core), self._entity(EntityKind.ISR, name))

    def _irq_exit(self, event: CtfEvent) -> None:
        self._states.exit_interrupt(self._core(event.core))

    def _thread(self, fields: dict[str, object], prefix: str) -> int | None:
        """The thread in some fields, None for those that execute while there is nothing to do."""
        number = fields.get(f"{prefix}tid", 0)
        return None if number == 0 else self._thread_of(number, str(fields.get(f"{prefix}comm", "")))

    handlers: ClassVar[dict[str, Handler]] = {
        "sched_switch": _switch,
        "sched_waking": _waking,
        "irq_handler_entry": _irq_entry,
        "irq_handler_exit": _irq_exit,
    }
    characteristic = frozenset({"sched_switch"})


def _leaving(state: object) -> Leaving:
    number = state if isinstance(state, int) else 0
    if number in (0, _PREEMPTED):
        return Leaving.READY
    return Leaving.ENDED if number & _ENDED else Leaving.BLOCKED
