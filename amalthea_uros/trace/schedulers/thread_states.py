"""From what a scheduler records of threads and interrupts to the events of jobs.

A job of a thread goes from where the thread becomes ready to where it blocks, since recorders know no other begin and end. A thread
that blocks within a runnable (a callback, a marked interval) waits, and its job goes on. What has not been recorded is not made up:
without a record that a thread became ready its job has no activation, a thread that is seen for the first time, or for the first time
after a loss of events, on a core goes on with a job of which the start is unknown, and the activation of an interrupt is unknown.
"""

from __future__ import annotations

from enum import Enum

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.files import TracePlace, TraceProblems
from amalthea_uros.trace.reading import BLOCK, EventRows
from amalthea_uros.trace.table import NO_NOTE, EventKind, EventTable

#: So many rows wait at most for the event that decides about one of them.
_MOST_UNDECIDED = 8 * BLOCK


class Leaving(Enum):
    """Why a thread leaves its core: it is still ready, or blocks for a reason that is not said, or waits, or its job ends."""

    READY = 0
    BLOCKED = 1
    WAITING = 2
    ENDED = 3


class ThreadState(Enum):
    """Of the last job of a thread."""

    UNKNOWN = 0
    ENDED = 1
    ACTIVE = 2
    RUNNING = 3
    READY = 4
    WAITING = 5


@dataclass(slots=True, eq=False)
class _TracedThread:
    """A thread or an interrupt.

    Attributes
    ----------
    job : the number of its last job
    leaving : it is on a core and has said that, and why, it will leave it
    left : the row in which it has left the core, while it is not decided whether it is still ready
    runnables : in which it is, and their instances, the outer one first
    """

    entity: int
    state: ThreadState = ThreadState.UNKNOWN
    job: int = -1
    leaving: Leaving | None = None
    left: list[int] | None = None
    runnables: list[tuple[int, int]] = field(default_factory=list)

    @property
    def instance(self) -> int:
        return max(self.job, 0)


@dataclass(slots=True)
class _TracedCore:
    """A core: the thread that it executes apart from interrupts, and the interrupts, the outer one first."""

    entity: int
    thread: _TracedThread | None = None
    interrupts: list[_TracedThread] = field(default_factory=list)


class ThreadStates:
    """Follows threads and interrupts, which are given as indices of entities."""

    def __init__(self, rows: EventRows, problems: TraceProblems) -> None:
        self._rows, self._problems = rows, problems
        self._threads: dict[int, _TracedThread] = {}
        self._cores: dict[int, _TracedCore] = {}
        self._undecided: dict[int, _TracedThread] = {}
        self._executions: dict[int, int] = {}

    def take(self, is_end: bool = False) -> EventTable | None:
        """The events that are decided, if there are enough of them or no more come."""
        count = len(self._rows)
        if not is_end:
            if count < BLOCK:
                return None
            decided = self._rows.before([each.left for each in self._undecided.values() if each.left is not None])
            count = decided if count < _MOST_UNDECIDED else count
        if count == len(self._rows):
            for thread in self._undecided.values():
                # How this job goes on cannot be said any more.
                thread.state, thread.left = ThreadState.UNKNOWN, None
            self._undecided.clear()
        return self._rows.take(count)

    def job(self, thread: int) -> int:
        """The number of the present job of a thread."""
        return self._thread(thread).instance

    def make_ready(self, entity: int) -> None:
        """A thread can execute from now on."""
        thread = self._thread(entity)
        if thread.state is ThreadState.RUNNING and thread.leaving is not None:
            self._go_on_without_a_switch(thread)
        elif thread.state is ThreadState.WAITING:
            self._release(thread)
        elif (
            thread.state is ThreadState.READY
            and thread.left is not None
            and (thread.leaving or not self._is_interrupted(thread))
        ):
            # It left the core without a reason, and would not become ready if it were: it had blocked.
            self._decide(thread, thread.leaving or Leaving.BLOCKED)
            self.make_ready(entity)
        elif thread.state in (ThreadState.UNKNOWN, ThreadState.ENDED):
            self._activate(thread)

    def make_known(self, entity: int) -> None:
        """A thread has been created and has not executed yet."""
        thread = self._thread(entity)
        if thread.state is ThreadState.UNKNOWN:
            thread.state = ThreadState.ENDED

    def block(self, entity: int, leaving: Leaving = Leaving.BLOCKED) -> None:
        """A thread cannot execute any more; if it is on a core, it leaves it with the next switch."""
        thread = self._thread(entity)
        if thread.state is ThreadState.RUNNING or self._is_interrupted(thread):
            thread.leaving = leaving
        elif thread.state is ThreadState.READY and thread.left is not None:
            self._decide(thread, leaving)

    def switch_in(self, core_entity: int, entity: int) -> None:
        """A core executes a thread from now on."""
        core, thread = self._core(core_entity), self._thread(entity)
        if core.thread is thread:
            return
        if core.thread is not None:
            self._leave(core, core.thread, None)
        if thread.state is ThreadState.RUNNING:
            self.lose("a thread is on two cores")
        core.thread = thread
        if not core.interrupts:
            self._enter(core, thread)

    def switch_out(self, core_entity: int, entity: int | None = None, leaving: Leaving | None = None) -> None:
        """A core no longer executes a thread.

        Parameters
        ----------
        entity : the thread; None: the present one
        leaving : None if the reason is not said, then the next event of the thread decides
        """
        core = self._core(core_entity)
        if entity is None:
            if core.thread is not None:
                self._leave(core, core.thread, leaving)
            return
        thread = self._thread(entity)
        if core.thread is not thread and (
            core.thread is not None or thread.state not in (ThreadState.UNKNOWN, ThreadState.READY)
        ):
            self.lose("another thread than the one on the core leaves it")
        self._leave(core, thread, leaving)

    def enter_interrupt(self, core_entity: int, entity: int) -> None:
        """An interrupt begins."""
        core, interrupt = self._core(core_entity), _TracedThread(entity)
        before = core.interrupts[-1] if core.interrupts else core.thread
        if before is not None and before.state is ThreadState.RUNNING:
            self._suspend(before)
            before.left = self._add(EventKind.PREEMPT, core, before)
            before.state = ThreadState.READY
            if before is core.thread:
                self._undecided[before.entity] = before
        interrupt.job = self._executions[entity] = self._executions.get(entity, -1) + 1
        core.interrupts.append(interrupt)
        self._add(EventKind.START, core, interrupt)
        interrupt.state = ThreadState.RUNNING

    def exit_interrupt(self, core_entity: int, entity: int | None = None) -> None:
        """An interrupt ends.

        Parameters
        ----------
        entity : None: the innermost one
        """
        core = self._core(core_entity)
        if not core.interrupts:
            self._report("the end of an interrupt without its begin")
            return
        if entity is not None and core.interrupts[-1].entity != entity:
            self.lose("another interrupt than the innermost one ends")
            return
        self._add(EventKind.TERMINATE, core, core.interrupts.pop())
        before = core.interrupts[-1] if core.interrupts else core.thread
        if before is not None:
            self._enter(core, before)

    def is_on(self, core_entity: int, entity: int) -> bool:
        """Whether a core executes a thread, interrupted or not."""
        return self._core(core_entity).thread is self._thread(entity)

    def start_runnable(self, entity: int, runnable: int) -> None:
        """A thread begins with a runnable."""
        self._start(self._thread(entity), runnable)

    def end_runnable(self, entity: int, runnable: int) -> None:
        """A thread is at the end of a runnable."""
        self._end(self._thread(entity), runnable)

    def start_runnable_on(self, core_entity: int, runnable: int) -> None:
        """What a core executes begins with a runnable."""
        thread = self._executing(core_entity)
        if thread is None:
            self._report("a runnable while it is not known which thread executes")
        else:
            self._start(thread, runnable)

    def mark_moment(self, core_entity: int, runnable: int) -> None:
        """What a core executes marks a moment."""
        self.start_runnable_on(core_entity, runnable)
        if self._executing(core_entity) is not None:
            self.end_runnable_on(core_entity, runnable)

    def end_runnable_on(self, core_entity: int, runnable: int | None) -> None:
        """What a core executes is at the end of a runnable; None: of the innermost one."""
        thread = self._executing(core_entity)
        if thread is None:
            self._report("the end of a runnable without its begin")
        else:
            self._end(thread, runnable)

    def _executing(self, core_entity: int) -> _TracedThread | None:
        core = self._core(core_entity)
        return core.interrupts[-1] if core.interrupts else core.thread

    def _start(self, thread: _TracedThread, runnable: int) -> None:
        if any(runnable == each for each, _ in thread.runnables):
            self.lose("a runnable begins again before its end")
        instance = self._executions[runnable] = self._executions.get(runnable, -1) + 1
        thread.runnables.append((runnable, instance))
        self._rows.add(EventKind.RUNNABLE_START, thread.entity, thread.instance, runnable, instance)

    def _end(self, thread: _TracedThread, runnable: int | None) -> None:
        if not any(runnable in (None, each) for each, _ in thread.runnables):
            self._report("the end of a runnable without its begin")
            return
        inner, instance = thread.runnables.pop()
        while runnable not in (None, inner):
            self._report("a runnable that does not end before the one in which it began", "; it is dropped")
            inner, instance = thread.runnables.pop()
        self._rows.add(EventKind.RUNNABLE_TERMINATE, thread.entity, thread.instance, inner, instance)

    def lose(self, reason: str = "", lost: int = NO_NOTE) -> None:
        """Events have been lost: nothing that is open goes on.

        Parameters
        ----------
        reason : how it shows that they are missing, if that has not been reported
        lost : their number
        """
        if reason:
            self._report(reason, "; the intervals that are open are dropped")
        self._rows.add_gap(lost)
        for thread in self._threads.values():
            thread.state, thread.leaving, thread.left = ThreadState.UNKNOWN, None, None
            thread.runnables.clear()
        for core in self._cores.values():
            core.thread = None
            core.interrupts.clear()
        self._undecided.clear()

    def _report(self, what: str, effect: str = "; it is ignored") -> None:
        message = f"{what}{effect}"
        self._problems.add(
            "TRC021", Severity.WARNING, message, TracePlace(), "Record with a larger buffer, or fewer kinds of events."
        )

    def _thread(self, entity: int) -> _TracedThread:
        return self._threads.get(entity) or self._threads.setdefault(entity, _TracedThread(entity))

    def _core(self, entity: int) -> _TracedCore:
        return self._cores.get(entity) or self._cores.setdefault(entity, _TracedCore(entity))

    def _add(self, kind: EventKind, core: _TracedCore, thread: _TracedThread) -> list[int]:
        return self._rows.add(kind, core.entity, 0, thread.entity, thread.instance)

    def _activate(self, thread: _TracedThread) -> None:
        thread.job += 1
        thread.state = ThreadState.ACTIVE
        self._rows.add(EventKind.ACTIVATE, thread.entity, thread.job, thread.entity, thread.job)

    def _release(self, thread: _TracedThread) -> None:
        self._rows.add(EventKind.RELEASE, thread.entity, thread.job, thread.entity, thread.job)
        thread.state = ThreadState.READY

    def _enter(self, core: _TracedCore, thread: _TracedThread) -> None:
        if thread.state is ThreadState.WAITING:
            self._release(thread)
        if thread.state in (ThreadState.UNKNOWN, ThreadState.ENDED):
            thread.job += 1
        is_start = thread.state in (ThreadState.ENDED, ThreadState.ACTIVE)
        self._add(EventKind.START if is_start else EventKind.RESUME, core, thread)
        if not is_start:
            for runnable in thread.runnables:
                self._rows.add(EventKind.RUNNABLE_RESUME, thread.entity, thread.instance, *runnable)
        thread.state, thread.left = ThreadState.RUNNING, None
        self._undecided.pop(thread.entity, None)

    def _leave(self, core: _TracedCore, thread: _TracedThread, leaving: Leaving | None) -> None:
        core.thread = None
        leaving = leaving or thread.leaving
        thread.leaving = None
        if thread.state is ThreadState.UNKNOWN:
            thread.job += 1
        if thread.state is not ThreadState.READY:
            self._suspend(thread)
            thread.left = self._add(EventKind.PREEMPT, core, thread)
            thread.state = ThreadState.READY
        if leaving is None:
            self._undecided[thread.entity] = thread
        else:
            self._decide(thread, leaving)

    def _suspend(self, thread: _TracedThread) -> None:
        for runnable in reversed(thread.runnables):
            self._rows.add(EventKind.RUNNABLE_SUSPEND, thread.entity, thread.instance, *runnable)

    def _decide(self, thread: _TracedThread, leaving: Leaving) -> None:
        """Say why a thread has left its core."""
        if leaving is Leaving.BLOCKED:
            leaving = Leaving.WAITING if thread.runnables else Leaving.ENDED
        if leaving is Leaving.ENDED:
            thread.runnables.clear()
        if leaving is not Leaving.READY:
            thread.state = ThreadState.WAITING if leaving is Leaving.WAITING else ThreadState.ENDED
            if thread.left is not None:
                self._rows.change_kind(thread.left, EventKind.WAIT if leaving is Leaving.WAITING else EventKind.TERMINATE)
        thread.left = thread.leaving = None
        self._undecided.pop(thread.entity, None)

    def _is_interrupted(self, thread: _TracedThread) -> bool:
        """Whether only an interrupt keeps a thread from executing."""
        return any(core.thread is thread and bool(core.interrupts) for core in self._cores.values())

    def _go_on_without_a_switch(self, thread: _TracedThread) -> None:
        """A thread that was about to leave its core is ready again before it does."""
        core = next(core for core in self._cores.values() if core.thread is thread)
        self._leave(core, thread, None)
        self.make_ready(thread.entity)
        core.thread = thread
        if not core.interrupts:
            self._enter(core, thread)
