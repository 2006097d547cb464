"""The order of objects: a project has them below their operating systems, where a system has them one after the other.

Which of two equal processes is executed first can depend on it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.comments import note
from amalthea_uros.perf.system import System

#: Lists of a system: its part, the field, and the field of an item that tells it from the others.
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


def note_orders(model: ProjectObject, system: System) -> None:
    """Keep the orders of lists with several objects, where no object stands twice."""
    found = {}
    for part, field, name in _LISTS:
        names = [getattr(item, name) for item in getattr(getattr(system, part), field)]
        if len(names) > 1:
            found[f"{part}.{field}"] = names
    if found:
        note(model, **{_KEY: found})


def in_noted_order(system: System, content: Mapping[str, Any]) -> System:
    """The system with its lists in the order that a comment keeps; objects that it does not know come last."""
    orders = content.get(_KEY)
    parts: dict[str, Any] = {part: getattr(system, part) for part, _, _ in _LISTS}
    for part, field, name in _LISTS if isinstance(orders, dict) else ():
        names = orders.get(f"{part}.{field}")
        if isinstance(names, list):
            places = {each: place for place, each in enumerate(names) if isinstance(each, str)}
            items = getattr(parts[part], field)
            ordered = sorted(items, key=lambda item, name=name, places=places: places.get(getattr(item, name), len(places)))
            parts[part] = replace(parts[part], **{field: tuple(ordered)})
    return replace(system, **parts)
