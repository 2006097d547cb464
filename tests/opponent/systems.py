"""Random systems in the plain form that ../shared/vectors/constructs/README.md describes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

#: A system, and an item of a body, as they are in systems.json.
PlainSystem = dict[str, Any]
Item = dict[str, Any]


def items_of(system: PlainSystem, body: list[Item] | None = None) -> list[Item]:
    """All items of a body with those inside calls, groups and switches; without a body, those of the whole system."""
    if body is not None:
        return list(_walk(system, body))
    bodies = [*system["runnables"].values(), *(process["body"] for process in system["processes"])]
    return [item for body in bodies for item in _walk(system, body, follows_calls=False)]


def _walk(system: PlainSystem, body: list[Item], *, follows_calls: bool = True) -> Iterator[Item]:
    for item in body:
        yield item
        inner = [item["group"]] if "group" in item else []
        inner += [branch for _, branch in item.get("switch", ())]
        if follows_calls and "call" in item:
            inner.append(system["runnables"][item["call"]])
        for part in inner:
            yield from _walk(system, part, follows_calls=follows_calls)


def has_open_choices(system: PlainSystem) -> bool:
    """Whether execution times, releases, branches or orders are left to chance."""
    if any("sporadic" in p["arrival"] or "jitter" in p["arrival"].get("periodic", ()) for p in system["processes"]):
        return True
    return any(
        "switch" in item or not item.get("ordered", True) or ("execute" in item and item["execute"][0] != item["execute"][1])
        for item in items_of(system)
    )
