"""What understands the events of operating systems in CTF traces: Linux and Zephyr."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import ClassVar, TypeAlias

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.trace.ctf.streams import CtfEvent
from amalthea_uros.trace.files import TraceProblems
from amalthea_uros.trace.reading import EventRows
from amalthea_uros.trace.schedulers.thread_log import UniqueNames, add_mark
from amalthea_uros.trace.schedulers.thread_states import Leaving, ThreadStates
from amalthea_uros.trace.table import EntityKind

Handler: TypeAlias = Callable[..., None]


class Interpreter:
    """Takes events of one origin.

    Attributes
    ----------
    handlers : the methods for the events, by the names of the events
    characteristic : only traces that have one of these events are of this origin
    """

    handlers: ClassVar[dict[str, Handler]] = {}
    characteristic: ClassVar[frozenset[str]] = frozenset()

    def __init__(self, rows: EventRows, states: ThreadStates, problems: TraceProblems, names: UniqueNames) -> None:
        self._rows, self._states, self._problems, self._names = rows, states, problems, names
        self._entities: dict[tuple[EntityKind, str], int] = {}

    @classmethod
    def events(cls, names: Iterable[str]) -> list[str]:
        """Those of some names of events that are understood."""
        known = [name for name in names if name in cls.handlers]
        return known if cls.characteristic.intersection(known) else []

    def add(self, event: CtfEvent) -> None:
        """Take an event."""
        self.handlers[event.name](self, event)

    def _thread_of(self, number: object, name: str) -> int:
        """The task of a thread of an operating system with numbers of threads."""
        return self._entity(EntityKind.TASK, self._names.name(("thread", number), name, str(number), "thread"))

    def _core(self, number: object) -> int:
        return self._entity(EntityKind.CORE, f"Core {number if isinstance(number, int) else 0}")

    def _entity(self, kind: EntityKind, name: str) -> int:
        found = self._entities.get((kind, name))
        if found is None:
            found = self._entities[kind, name] = self._rows.index.index(kind, name)
        return found


# The scheduler of Linux, as the kernel tracer of LTTng records it.


@dataclass(slots=True)
class LinuxThread:
    """How a thread was seen to be scheduled.

    Attributes
    ----------
    priorities : those of the kernel less 100, as LTTng records them (lttng-modules, events/sched.h): from 0 on, without a real-time
        priority; -1 to -100, with the real-time priorities 0 to 99; -101, with a deadline
    cores : on which it was switched in
    ran : how long it has run, up to `since`
    since : when it was switched in; None if it does not run, or if that is not known
    """

    priorities: set[int] = field(default_factory=set)
    cores: set[int] = field(default_factory=set)
    ran: int = 0
    since: int | None = None

    def leave(self, time: int) -> None:
        """It is switched out."""
        self.ran += 0 if self.since is None else time - self.since
        self.since = None

    def ran_until(self, time: int) -> int | None:
        """How long it has run, None if it is not known to run now."""
        return None if self.since is None else self.ran + time - self.since


#: Of `prev_state`: 0 is ready, and so is what the kernel adds for a preemption; ended threads have these bits.
_PREEMPTED = 0x100
_ENDED = 0x10 | 0x20 | 0x80


class LinuxScheduler(Interpreter):
    """Takes the events of the scheduler and of interrupts.

    Attributes
    ----------
    threads : by their numbers
    """

    def __init__(self, rows: EventRows, states: ThreadStates, problems: TraceProblems, names: UniqueNames) -> None:
        super().__init__(rows, states, problems, names)
        self.threads: dict[int, LinuxThread] = {}

    def _switch(self, event: CtfEvent) -> None:
        fields, core = event.fields, self._core(event.core)
        before, after = self._thread(fields, "prev_"), self._thread(fields, "next_")
        self._note(event)
        if before is not None:
            self._states.switch_out(core, before, _leaving(fields.get("prev_state", 0)))
        if after is not None:
            self._states.switch_in(core, after)

    def lose(self) -> None:
        """Forget which threads run."""
        for thread in self.threads.values():
            thread.since = None

    def _note(self, event: CtfEvent) -> None:
        before, after = (event.fields.get(f"{prefix}_tid") for prefix in ("prev", "next"))
        if isinstance(before, int) and before in self.threads:
            self.threads[before].leave(event.time)
        if isinstance(after, int) and after:
            thread = self.threads.setdefault(after, LinuxThread())
            thread.since, priority = event.time, event.fields.get("next_prio")
            thread.priorities |= {priority} if isinstance(priority, int) else set()
            thread.cores |= {event.core} if event.core is not None else set()

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


# The events of Zephyr, of older and newer releases (subsys/tracing/ctf of Zephyr).
#
# Semaphores, mutexes and timers are not used: that a thread blocks and becomes ready is recorded for itself. Interrupts are recorded
# without their numbers, so all of them are one ISR.

_IDLE = re.compile(r"idle(?: ?[0-9]{1,3})?", re.IGNORECASE)


class Zephyr(Interpreter):
    """Takes the events of Zephyr."""

    def __init__(self, rows: EventRows, states: ThreadStates, problems: TraceProblems, names: UniqueNames) -> None:
        super().__init__(rows, states, problems, names)
        self._created_threads: set[int] = set()

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
