"""Which semaphores a process holds where it writes a label.

As in the analysis of blocking, a graph is read from its start to its end: what is requested is held until it is released, whatever the
branches are.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from amalthea_uros.metamodel.classes import (
    IExecutable,
    Label,
    LabelAccess,
    LabelAccessEnum,
    Process,
    Runnable,
    RunnableCall,
    Semaphore,
    SemaphoreAccess,
    SemaphoreAccessEnum,
    SenderReceiverWrite,
)
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.execution import called, order
from amalthea_uros.validate.graphs import bottom_up

Write = LabelAccess | SenderReceiverWrite


class Writing(NamedTuple):
    """A process at a write access, and the semaphores that it holds there."""

    process: Process
    label: Label
    write: Write
    held: frozenset[Semaphore]


@dataclass(frozen=True, slots=True)
class _Change:
    """What became of the semaphores that were held at the start of something."""

    gained: frozenset[Semaphore] = frozenset()
    lost: frozenset[Semaphore] = frozenset()

    def of(self, held: frozenset[Semaphore]) -> frozenset[Semaphore]:
        return (held - self.lost) | self.gained

    def then(self, other: _Change) -> _Change:
        return _Change(other.of(self.gained), (self.lost - other.gained) | other.lost)


@dataclass(slots=True)
class _Passage:
    """One way through a process or runnable: what has changed at its writes, at its calls, and at its end."""

    writes: list[tuple[Write, _Change]] = field(default_factory=list)
    calls: list[tuple[Runnable, _Change]] = field(default_factory=list)
    end: _Change = field(default_factory=_Change)


def writings(context: Context) -> Mapping[Label, list[Writing]]:
    """The writes to each label in the jobs of processes."""
    return context.once(_writings)


def _writings(context: Context) -> dict[Label, list[Writing]]:
    passages: dict[IExecutable, _Passage] = {}
    for executable in order(context):
        passages[executable] = _passage(executable, passages)
    found: dict[Label, list[Writing]] = {}
    for process in context.all(Process):
        for writing in _in_jobs_of(process, passages, context):
            found.setdefault(writing.label, []).append(writing)
    return found


def _passage(executable: IExecutable, known: Mapping[IExecutable, _Passage]) -> _Passage:
    found = _Passage()
    for item in executable.activity_graph.walk() if executable.activity_graph is not None else ():
        match item:
            case LabelAccess(access=LabelAccessEnum.WRITE) | SenderReceiverWrite():
                found.writes.append((item, found.end))
            case RunnableCall(runnable=Runnable() as runnable):
                found.calls.append((runnable, found.end))
                found.end = found.end.then(known[runnable].end if runnable in known else _Change())
            case SemaphoreAccess(semaphore=Semaphore() as semaphore):
                found.end = found.end.then(_change(item, semaphore))
    return found


def _change(access: SemaphoreAccess, semaphore: Semaphore) -> _Change:
    one = frozenset((semaphore,))
    if access.access is SemaphoreAccessEnum.RELEASE:
        return _Change(lost=one)
    # With room for several users it keeps nobody away, unless it is wanted alone. 0 is an old default.
    is_alone = access.access is SemaphoreAccessEnum.EXCLUSIVE or semaphore.effective("max_value") <= 1
    return _Change(gained=one) if is_alone else _Change()


def _in_jobs_of(process: Process, passages: Mapping[IExecutable, _Passage], context: Context) -> Iterator[Writing]:
    # What is held whenever a job comes to something, however it comes there.
    held: dict[IExecutable, frozenset[Semaphore]] = {process: frozenset()}
    start: IExecutable = process
    for executable in reversed(bottom_up([start], lambda caller: called(caller, context))):
        passage = passages[executable]
        for runnable, change in passage.calls:
            here = change.of(held[executable])
            held[runnable] = held.get(runnable, here) & here
        for write, change in passage.writes:
            label = write.data if isinstance(write, LabelAccess) else write.label
            if label is not None:
                yield Writing(process, label, write, change.of(held[executable]))
