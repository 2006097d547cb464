"""The order of objects: a project has them below their operating systems, where a system has them one after the other.

Which of two equal processes is executed first can depend on it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.comments import note
from amalthea_uros.perf.system import System

#: Lists of a system: its part, the field, and the field of an item that identifies it.
_LISTS = (
    ("software", "tasks", "name"),
    ("software", "isrs", "name"),
    ("software", "runnables", "name"),
    ("software", "labels", "name"),
    ("software", "mode_labels", "name"),
    ("stimuli", "stimuli", "name"),
    ("mapping", "tasks", "task"),
    ("mapping", "isrs", "isr"),
    ("mapping", "placements", "element"),
    ("events", "chains", "name"),
    ("network", "transmissions", "name"),
)
_KEY = "order"


def keep_orders(model: ProjectObject, system: System) -> None:
    """Keep the orders of lists with several objects, where no object stands twice."""
    result = {}
    for part, field, name in _LISTS:
        names = [getattr(item, name) for item in getattr(getattr(system, part), field)]
        if len(names) > 1:
            result[f"{part}.{field}"] = names
    if result:
        note(model, **{_KEY: result})


def in_kept_order(system: System, content: Mapping[str, Any]) -> System:
    """The system with its lists in the order that a comment keeps; objects that it does not know come last."""
    stated = content.get(_KEY)
    orders: dict[str, Any] = stated if isinstance(stated, dict) else {}
    parts: dict[str, Any] = {part: getattr(system, part) for part, _, _ in _LISTS}
    for part, field, name in _LISTS:
        names = orders.get(f"{part}.{field}")
        if isinstance(names, list):
            places = {each: place for place, each in enumerate(names) if isinstance(each, str)}
            items = getattr(parts[part], field)
            ordered = sorted(items, key=partial(_place, places=places, name=name))
            parts[part] = replace(parts[part], **{field: tuple(ordered)})
    return replace(system, **parts)


def _place(item: Any, places: Mapping[str, int], name: str) -> int:
    return places.get(getattr(item, name), len(places))
