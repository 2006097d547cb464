"""Trigger conditions: which handles have to be ready before the callbacks of an iteration are called.

See `rclc_executor_trigger_*` in ros2/rclc `rclc/src/rclc/executor.c`.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from itertools import chain

from amalthea_uros.perf.executors import TriggerCondition, TriggerKind
from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.uros.application.notes import Notes


def trigger_of(executor: ExecutorSection, handles: Mapping[str, Sequence[str]], notes: Notes) -> TriggerCondition:
    """The trigger condition of an executor.

    Parameters
    ----------
    handles : the names of the handles of each callback that it serves
    """
    section = executor.trigger
    if section.custom is not None:
        for names in section.custom:
            _check(names, handles, executor, "custom", notes)
        sets = (frozenset(chain.from_iterable(handles.get(name, ()) for name in names)) for names in section.custom)
        return TriggerCondition(kind=TriggerKind.CUSTOM, sets=tuple(sets))
    if section.one is not None:
        _check([section.one], handles, executor, "one", notes)
        return TriggerCondition(kind=TriggerKind.ONE, sets=(frozenset(handles.get(section.one, ())),))
    return TriggerCondition(kind=TriggerKind(section.when))


def _check(names: Collection[str], known: Collection[str], executor: ExecutorSection, key: str, notes: Notes) -> None:
    for name in names:
        if name not in known:
            owner = f"the executor {executor.name!r}"
            notes.undefined("callback", name, known, executor.trigger.location(key), owner=owner)
