"""Which constructs a system has, by names."""

from __future__ import annotations

from opponent.systems import PlainSystem, items_of


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
