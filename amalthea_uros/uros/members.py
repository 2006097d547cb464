"""What paths and requirements can name: processes, callbacks and functions, with what they read, write and trigger."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from amalthea_uros.perf.software import AccessKind, Call, LabelAccess, Runnable, Trigger, walk
from amalthea_uros.uros.application import body_name
from amalthea_uros.uros.callbacks import Callback
from amalthea_uros.uros.chains import Member
from amalthea_uros.uros.tasks import PlannedIsr, PlannedTask
from amalthea_uros.uros.work import Work


def members_of(work: Work, callbacks: Sequence[Callback]) -> Mapping[str, Member]:
    """All of them by name; where a process and a function share one, it is the process."""
    by_stimulus = {name: task.name for task in work.tasks for name in task.stimuli}
    found: dict[str, Member] = {}
    callers: dict[str, str] = {}
    processes: tuple[PlannedTask | PlannedIsr, ...] = (*work.tasks, *work.isrs)
    for process in processes:
        called = [work.runnables[call.runnable] for call in process.activities if isinstance(call, Call)]
        found[process.name] = _member(process.name, None, called, by_stimulus)
        for runnable in called:
            callers.setdefault(runnable.name, process.name)
    for name, caller in callers.items():
        found.setdefault(name, _member(caller, name, [work.runnables[name]], by_stimulus))
    for callback in callbacks:
        # Inside the executor, a callback is one of its functions; otherwise it is a task of the same name.
        member = found.get(body_name(callback) if callback.in_executor else callback.name)
        found[callback.name] = _with_topics(member or _without_task(callback), [callback])
    executor = work.description.middleware.executor.name
    if callbacks:
        found[executor] = _with_topics(found.get(executor) or _nothing(executor), callbacks)
    return found


def _without_task(callback: Callback) -> Member:
    """A callback for which no task was found, of which there is an error already: no other one shall follow from that."""
    section = callback.section
    reads = {*section.reads, *([callback.buffer] if callback.buffer else [])}
    return replace(_nothing(callback.name), reads=frozenset(reads), writes=frozenset(section.writes))


def _nothing(process: str) -> Member:
    return _member(process, None, (), {})


def _member(process: str, runnable: str | None, parts: Iterable[Runnable], by_stimulus: Mapping[str, str]) -> Member:
    activities = [activity for part in parts for activity in walk(part.activities)]
    accesses = [activity for activity in activities if isinstance(activity, LabelAccess)]
    fired = [activity.stimulus for activity in activities if isinstance(activity, Trigger)]
    return Member(
        process=process,
        runnable=runnable,
        reads=frozenset(access.label for access in accesses if access.kind is AccessKind.READ),
        writes=frozenset(access.label for access in accesses if access.kind is AccessKind.WRITE),
        activates=frozenset(by_stimulus[stimulus] for stimulus in fired if stimulus in by_stimulus),
    )


def _with_topics(member: Member, callbacks: Iterable[Callback]) -> Member:
    """The member with the topics by which callbacks send and receive."""
    callbacks = tuple(callbacks)
    return replace(
        member,
        sends=frozenset(message.topic for callback in callbacks for message in callback.outgoing),
        receives=frozenset(callback.incoming.topic for callback in callbacks if callback.incoming),
    )
