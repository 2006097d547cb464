"""A plain system as short text."""

from __future__ import annotations

from typing import Any

from opponent.systems import Item, PlainSystem


def described(system: PlainSystem) -> str:
    """A line for each process and runnable."""
    lines = [f"{process['name']}: {_process(system, process)}" for process in system["processes"]]
    lines += [f"{name}: {_body(body)}" for name, body in system["runnables"].items()]
    if "chain" in system:
        lines.append(f"chain: {' > '.join(system['chain']['processes'])}, {system['chain']['communication']}")
    without = [name for name, given in system["semaphores"].items() if not given["ceiling"]]
    lines += [f"without ceiling: {', '.join(without)}"] if without else []
    return "\n".join(lines)


def _process(system: PlainSystem, process: dict[str, Any]) -> str:
    core = process["core"] if len(system["cores"]) > 1 else ""
    (kind, given), *_ = process["arrival"].items()
    arrival = " ".join(f"{key} {value}" for key, value in given.items())
    rank = f"{process['kind']} {process['preemption'] if process['kind'] == 'task' else ''} {system['cores'][process['core']]} {core}"
    urgency = f"deadline {process['deadline']}" if "deadline" in process else f"priority {process['priority']}"
    time_slice = f", slice {process['slice']}" if "slice" in process else ""
    return f"{' '.join(rank.split())}, {urgency}{time_slice}, {kind} {arrival}: {_body(process['body'])}"


def _body(body: list[Item]) -> str:
    return " ".join(_item(item) for item in body)


def _item(item: Item) -> str:
    counter = f"/{item['prescaler']}+{item['offset']}" if "prescaler" in item else ""
    match item:
        case {"execute": [least, most]}:
            return str(least) if least == most else f"{least}..{most}"
        case {"call": runnable}:
            return f"{runnable}(){counter}"
        case {"group": body}:
            mark = "" if item.get("ordered", True) else "unordered"
            return f"{mark}[{_body(body)}]" if item.get("interruptible", True) else f"{mark}![{_body(body)}]"
        case {"switch": branches}:
            return f"<{' | '.join(_body(branch) for _, branch in branches)}>"
        case {"request": semaphore}:
            return f"({semaphore}"
        case {"release": semaphore}:
            return f"{semaphore})"
        case {"trigger": process}:
            return f"->{process}{counter}"
        case {"point": _}:
            return "."
    kind, label = next(iter(item.items()))
    return f"{kind} {label}"
