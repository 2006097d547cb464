"""Labels: the memory that holds them, and how jobs exchange them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from amalthea_uros.design.changes.key import ISRS, PLACEMENTS, RUNNABLES, TASKS, UNSET, Configuration, Key
from amalthea_uros.design.changes.values import one_of
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.names import require
from amalthea_uros.perf.activities import Activity, Communication, LabelAccess, transformed
from amalthea_uros.perf.mapping import Placement


def _show_memory(configuration: Configuration, label: str) -> str:
    return configuration.system.memory_of.get(label, UNSET)


def _set_memory(configuration: Configuration, label: str, memory: str) -> Configuration:
    """Move a label to another memory, where its address is not known."""
    system = configuration.system
    require("memory", [memory], system.memories)
    if label not in system.memory_of:
        changed = PLACEMENTS.with_item(system, Placement(element=label, memory=memory))
    elif system.memory_of[label] == memory:
        changed = system
    else:
        changed = PLACEMENTS.with_fields(system, label, memory=memory, address=0)
    return configuration._replace(system=changed)


def _show_communication(configuration: Configuration, label: str) -> str:
    """How the accesses communicate; what is not stated counts as implicit, unless the settings say otherwise."""
    accesses = configuration.system.label_accesses.get(label, ())
    return ", ".join(dict.fromkeys(str(each.communication or Communication.IMPLICIT) for each in accesses)) or UNSET


def _set_communication(configuration: Configuration, label: str, communication: Communication) -> Configuration:
    """Change all accesses to a label."""
    system = configuration.system
    if label not in system.label_accesses:
        raise InvalidArgumentError(f"nothing reads or writes the label {label!r}")
    if configuration.settings.communication is not None:
        raise InvalidArgumentError(
            f"all communication is set to {configuration.settings.communication}, so that of {label!r} has no effect; "
            "leave the option --communication out"
        )

    def changed(activity: Activity) -> Activity:
        if isinstance(activity, LabelAccess) and activity.label == label:
            return replace(activity, communication=communication)
        return activity

    for place in (TASKS, ISRS, RUNNABLES):
        system = place.with_each(system, lambda item: _with_activities(item, transformed(item.activities, changed)))
    return configuration._replace(system=system)


def _with_activities(item: Any, activities: tuple[Activity, ...]) -> Any:
    return item if activities == item.activities else replace(item, activities=activities)


MEMORY_KEY = Key(str, _show_memory, _set_memory)
LABEL_KEYS: dict[str, Key[Any]] = {
    "memory": MEMORY_KEY,
    "communication": Key(one_of(Communication), _show_communication, _set_communication),
}
