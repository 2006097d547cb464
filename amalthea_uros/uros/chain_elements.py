"""The elements of paths and requirements: processes, callbacks and runnables, with what they read, write, send and receive."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from amalthea_uros.perf.activities import AccessKind, Call, LabelAccess, walk
from amalthea_uros.perf.software import Runnable
from amalthea_uros.uros.application.callbacks import Callback, body_name
from amalthea_uros.uros.application.serving import stated_executors
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.assembly.executor_runnables import notification_name
from amalthea_uros.uros.assembly.tasks import PlannedIsr, PlannedTask


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainElement:
    """A process or runnable that a path can contain.

    Attributes
    ----------
    process : the process itself, or the one that calls the runnable
    runnable : None for a process
    reads, writes : labels
    sends, receives : channels of messages
    taken_by : the element that takes its messages; None if it receives none
    """

    process: str | None
    runnable: str | None = None
    reads: frozenset[str] = frozenset()
    writes: frozenset[str] = frozenset()
    sends: frozenset[str] = frozenset()
    receives: frozenset[str] = frozenset()
    taken_by: str | None = None


def chain_elements(context: AssemblyContext, callbacks: Sequence[Callback]) -> Mapping[str, ChainElement]:
    """All elements by name; where a process and a runnable share a name, it is the process."""
    found: dict[str, ChainElement] = {}
    callers: dict[str, str] = {}
    processes: tuple[PlannedTask | PlannedIsr, ...] = (*context.tasks, *context.isrs)
    for process in processes:
        called = [context.runnables[call.runnable] for call in walk(process.activities) if isinstance(call, Call)]
        found[process.name] = _element(process.name, None, called)
        for runnable in called:
            callers.setdefault(runnable.name, process.name)
    for name, caller in callers.items():
        found.setdefault(name, _element(caller, name, [context.runnables[name]]))
    for callback in callbacks:
        # In the executor, a callback is one of its runnables; otherwise it is a task of the same name.
        body = body_name(callback.name)
        element = _with_messages(
            found.get(body if callback.in_executor else callback.name) or _without_task(callback), callback
        )
        found[callback.name] = element
        if callback.in_executor and body in found:
            found[body] = element
    if callbacks:
        for executor in stated_executors(context.description.middleware):
            found.setdefault(executor.name, _without_accesses(executor.name))
    return found


def _without_task(callback: Callback) -> ChainElement:
    """A callback whose task period could not be chosen: that error is already reported, and must not cause others."""
    section = callback.section
    reads = {*section.reads, *([callback.buffer] if callback.buffer else [])}
    return replace(_without_accesses(callback.name), reads=frozenset(reads), writes=frozenset(section.writes))


def _without_accesses(process: str) -> ChainElement:
    return _element(process, None, ())


def _element(process: str, runnable: str | None, parts: Iterable[Runnable]) -> ChainElement:
    activities = [activity for part in parts for activity in walk(part.activities)]
    accesses = [activity for activity in activities if isinstance(activity, LabelAccess)]
    return ChainElement(
        process=process,
        runnable=runnable,
        reads=frozenset(access.label for access in accesses if access.kind is AccessKind.READ),
        writes=frozenset(access.label for access in accesses if access.kind is AccessKind.WRITE),
    )


def _with_messages(element: ChainElement, callback: Callback) -> ChainElement:
    """The element with the messages that its callback sends and receives."""
    return replace(
        element,
        sends=frozenset(message.channel for message in callback.outgoing),
        receives=frozenset([callback.incoming.channel] if callback.incoming else []),
        taken_by=notification_name(callback) if callback.incoming else None,
    )
