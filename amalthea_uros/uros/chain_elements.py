"""The elements of paths and requirements: processes, callbacks and runnables, with what they read, write and trigger."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from amalthea_uros.perf.software import AccessKind, Call, LabelAccess, Runnable, Trigger, walk
from amalthea_uros.uros.application import body_name
from amalthea_uros.uros.callbacks import Callback
from amalthea_uros.uros.context import AssemblyContext
from amalthea_uros.uros.tasks import PlannedIsr, PlannedTask


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainElement:
    """A process or runnable that a path can contain.

    Attributes
    ----------
    process : the process itself, or the one that calls the runnable
    runnable : None for a process
    reads, writes : labels
    activates : processes that it triggers
    sends, receives : topics
    """

    process: str | None
    runnable: str | None = None
    reads: frozenset[str] = frozenset()
    writes: frozenset[str] = frozenset()
    activates: frozenset[str] = frozenset()
    sends: frozenset[str] = frozenset()
    receives: frozenset[str] = frozenset()


def chain_elements(context: AssemblyContext, callbacks: Sequence[Callback]) -> Mapping[str, ChainElement]:
    """All elements by name; where a process and a runnable share a name, it is the process."""
    by_stimulus = {name: task.name for task in context.tasks for name in task.stimuli}
    found: dict[str, ChainElement] = {}
    callers: dict[str, str] = {}
    processes: tuple[PlannedTask | PlannedIsr, ...] = (*context.tasks, *context.isrs)
    for process in processes:
        called = [context.runnables[call.runnable] for call in process.activities if isinstance(call, Call)]
        found[process.name] = _element(process.name, None, called, by_stimulus)
        for runnable in called:
            callers.setdefault(runnable.name, process.name)
    for name, caller in callers.items():
        found.setdefault(name, _element(caller, name, [context.runnables[name]], by_stimulus))
    for callback in callbacks:
        # In the executor, a callback is one of its runnables; otherwise it is a task of the same name.
        element = found.get(body_name(callback) if callback.in_executor else callback.name)
        found[callback.name] = _with_topics(element or _without_task(callback), [callback])
    executor = context.description.middleware.executor.name
    if callbacks:
        found[executor] = _with_topics(found.get(executor) or _without_accesses(executor), callbacks)
    return found


def _without_task(callback: Callback) -> ChainElement:
    """A callback whose task period could not be chosen: that error is already reported, and must not cause others."""
    section = callback.section
    reads = {*section.reads, *([callback.buffer] if callback.buffer else [])}
    return replace(_without_accesses(callback.name), reads=frozenset(reads), writes=frozenset(section.writes))


def _without_accesses(process: str) -> ChainElement:
    return _element(process, None, (), {})


def _element(process: str, runnable: str | None, parts: Iterable[Runnable], by_stimulus: Mapping[str, str]) -> ChainElement:
    activities = [activity for part in parts for activity in walk(part.activities)]
    accesses = [activity for activity in activities if isinstance(activity, LabelAccess)]
    fired = [activity.stimulus for activity in activities if isinstance(activity, Trigger)]
    return ChainElement(
        process=process,
        runnable=runnable,
        reads=frozenset(access.label for access in accesses if access.kind is AccessKind.READ),
        writes=frozenset(access.label for access in accesses if access.kind is AccessKind.WRITE),
        activates=frozenset(by_stimulus[stimulus] for stimulus in fired if stimulus in by_stimulus),
    )


def _with_topics(element: ChainElement, callbacks: Iterable[Callback]) -> ChainElement:
    """The element with the topics on which callbacks send and receive."""
    callbacks = tuple(callbacks)
    return replace(
        element,
        sends=frozenset(message.topic for callback in callbacks for message in callback.outgoing),
        receives=frozenset(callback.incoming.topic for callback in callbacks if callback.incoming),
    )
