"""Smaller systems that still show a failure."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from copy import deepcopy
from typing import Any

from opponent.systems import Item, PlainSystem, items_of


def shrink(system: PlainSystem, fails: Callable[[PlainSystem], bool]) -> PlainSystem:
    """A system that fails as well, from which nothing can be left out."""
    smaller: PlainSystem | None = system
    while smaller is not None:
        system = smaller
        smaller = next((candidate for candidate in _smaller(system) if _is_sensible(candidate) and fails(candidate)), None)
    return system


def _is_sensible(system: PlainSystem) -> bool:
    """Whether something is activated by time, and every process executes something."""
    executing = all(any("execute" in item for item in items_of(system, p["body"])) for p in system["processes"])
    return executing and any("trigger" not in p["arrival"] for p in system["processes"])


def _smaller(system: PlainSystem) -> Iterator[PlainSystem]:
    """Systems with one thing less, the big things first."""
    if "chain" in system:
        yield _tidy({key: value for key, value in deepcopy(system).items() if key != "chain"})
    for index in range(len(system["processes"])):
        smaller = deepcopy(system)
        removed = smaller["processes"].pop(index)["name"]
        if removed not in smaller.get("chain", {}).get("processes", ()) and smaller["processes"]:
            yield _tidy(smaller)
    for number in range(_count(system)):
        yield from _with_less_at(system, number)
    for index, process in enumerate(system["processes"]):
        for arrival in _simpler_arrivals(process["arrival"]):
            smaller = deepcopy(system)
            smaller["processes"][index]["arrival"] = arrival
            yield smaller
        if process["kind"] == "isr" or process["preemption"] != "preemptive":
            smaller = deepcopy(system)
            smaller["processes"][index] |= {"preemption": "preemptive"}
            yield smaller


def _bodies(system: PlainSystem) -> Iterator[list[Item]]:
    """All lists of items, outer before inner."""
    waiting = [*(process["body"] for process in system["processes"]), *system["runnables"].values()]
    while waiting:
        body = waiting.pop(0)
        yield body
        for item in body:
            waiting += [item["group"]] if "group" in item else []
            waiting += [branch for _, branch in item.get("switch", ())]


def _count(system: PlainSystem) -> int:
    return sum(len(body) for body in _bodies(system))


def _with_less_at(system: PlainSystem, number: int) -> Iterator[PlainSystem]:
    """Systems in which an item, found by its number, is left out, or is simpler."""
    for change in (_leave_out, _open, _drop_counter, _shorten, _fix):
        smaller = deepcopy(system)
        left = number
        for body in _bodies(smaller):
            if left < len(body):
                if change(smaller, body, left):
                    yield _tidy(smaller)
                break
            left -= len(body)


def _leave_out(system: PlainSystem, body: list[Item], index: int) -> bool:
    item = body[index]
    if "release" in item or ("chain" in system and ("read" in item or "write" in item)):
        return False
    if "request" in item:
        end = next(i for i in range(index, len(body)) if body[i].get("release") == item["request"])
        del body[end]
    del body[index]
    return True


def _open(system: PlainSystem, body: list[Item], index: int) -> bool:
    """What is inside, instead of a group, a switch or a call."""
    item = body[index]
    if "group" in item and not any("request" in inner for inner in item["group"]):
        body[index : index + 1] = item["group"]
    elif "switch" in item:
        body[index : index + 1] = item["switch"][-1][1]
    elif "call" in item:
        body[index : index + 1] = deepcopy(system["runnables"][item["call"]])
    else:
        return False
    return True


def _drop_counter(system: PlainSystem, body: list[Item], index: int) -> bool:
    item = body[index]
    item.pop("offset", None)
    return item.pop("prescaler", None) is not None


def _shorten(system: PlainSystem, body: list[Item], index: int) -> bool:
    times = body[index].get("execute")
    if times is None or times == [1, 1]:
        return False
    body[index]["execute"] = [max(1, time - 1) for time in times]
    return True


def _fix(system: PlainSystem, body: list[Item], index: int) -> bool:
    times = body[index].get("execute")
    if times is None or times[0] == times[1]:
        return False
    times[0] = times[1]
    return True


def _simpler_arrivals(arrival: dict[str, Any]) -> Iterator[dict[str, Any]]:
    (kind, given), *_ = arrival.items()
    if kind == "sporadic":
        yield {"periodic": {"period": given["least"], "offset": given["offset"]}}
    if kind == "trigger" and given:
        yield {"trigger": {}}
    for key in ("offset", "jitter"):
        if kind == "periodic" and given.get(key):
            yield {kind: {k: v for k, v in given.items() if k != key}}
            yield {kind: given | {key: given[key] // 2}}


def _tidy(system: PlainSystem) -> PlainSystem:
    """Without triggers that lead nowhere, processes that nothing triggers, and what is not used."""
    while True:
        names = {process["name"] for process in system["processes"]}
        for body in _bodies(system):
            body[:] = [item for item in body if item.get("trigger", next(iter(names), "")) in names]
        triggered = {item["trigger"] for p in system["processes"] for item in items_of(system, p["body"]) if "trigger" in item}
        kept = [p for p in system["processes"] if "trigger" not in p["arrival"] or p["name"] in triggered]
        if len(kept) == len(system["processes"]):
            break
        system["processes"] = kept
    called = {item["call"] for p in system["processes"] for item in items_of(system, p["body"]) if "call" in item}
    system["runnables"] = {name: body for name, body in system["runnables"].items() if name in called}
    requested = {item["request"] for item in items_of(system) if "request" in item}
    system["semaphores"] = {name: given for name, given in system["semaphores"].items() if name in requested}
    system["cores"] = {core: policy for core, policy in system["cores"].items() if any(p["core"] == core for p in kept)}
    return system
