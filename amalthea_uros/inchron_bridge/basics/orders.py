"""The order of objects: a project has them below their operating systems, where a system has them one after the other.

Which of two equal processes is executed first can depend on it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from operator import attrgetter
from typing import Any, TypeVar

from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.comments import note
from amalthea_uros.perf.system import System

T = TypeVar("T")

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
    """The system with its lists in the order that a comment keeps."""
    stated = content.get(_KEY)
    orders: dict[str, Any] = stated if isinstance(stated, dict) else {}
    parts: dict[str, Any] = {part: getattr(system, part) for part, _, _ in _LISTS}
    for part, field, name in _LISTS:
        items = in_order(getattr(parts[part], field), attrgetter(name), orders.get(f"{part}.{field}"))
        parts[part] = replace(parts[part], **{field: items})
    return replace(system, **parts)


def in_order(items: Iterable[T], name: Callable[[T], Any], order: Any) -> tuple[T, ...]:
    """The items in the order of names that a comment keeps, if it does; those that it does not know come last."""
    places = {each: place for place, each in enumerate(order) if isinstance(each, str)} if isinstance(order, list) else {}
    return tuple(sorted(items, key=lambda item: places.get(name(item), len(places))))
