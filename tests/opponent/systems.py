"""Random systems in the plain form that ../shared/vectors/constructs/README.md describes: their items, constructs and text."""

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


# Which constructs a system has, by names.


def constructs_of(system: PlainSystem) -> frozenset[str]:
    """The names of the constructs in a system, for statistics."""
    processes, items = system["processes"], items_of(system)
    found = {
        "non-interruptible group": any(not item.get("interruptible", True) for item in items),
        "unordered group": any(not item.get("ordered", True) for item in items),
        "group": any("group" in item for item in items),
        "switch": any("switch" in item for item in items),
        "call": any("call" in item for item in items),
        "counter of a call": any("call" in item and "prescaler" in item for item in items),
        "counter of a trigger": any("trigger" in item and "prescaler" in item for item in items),
        "counter of a stimulus": any("prescaler" in process["arrival"].get("trigger", ()) for process in processes),
        "schedule point": any("point" in item for item in items),
        "trigger": any("trigger" in item for item in items),
        "offset": any("offset" in given for p in processes for kind, given in p["arrival"].items() if kind != "trigger"),
        "jitter": any("jitter" in p["arrival"].get("periodic", ()) for p in processes),
        "sporadic": any("sporadic" in p["arrival"] for p in processes),
        "interrupt service routine": any(p["kind"] == "isr" for p in processes),
        "variable times": any("execute" in item and item["execute"][0] < item["execute"][1] for item in items),
        "equal priorities": len({(p["core"], p["kind"], p["priority"]) for p in processes}) < len(processes),
        "two cores": len(system["cores"]) > 1,
    }
    requested = {item["request"] for item in items if "request" in item}
    found["semaphore with ceiling"] = any(system["semaphores"][name]["ceiling"] for name in requested)
    found["semaphore without ceiling"] = any(not system["semaphores"][name]["ceiling"] for name in requested)
    names = {name for name, is_there in found.items() if is_there}
    names |= {p["preemption"] for p in processes if p["kind"] == "task"}
    names |= {f"chain {system['chain']['communication']}"} if "chain" in system else set()
    return frozenset(names | set(system["cores"].values()))
