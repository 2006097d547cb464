"""Which constructs a description has."""

from __future__ import annotations

from collections.abc import Iterator

from opponent.executors.descriptions import Section


def constructs_of(content: Section) -> frozenset[str]:
    """The names of the constructs of a description, or of all controllers of a robot."""
    kinds = (_of_loops, _of_messages, _of_wire, _of_processes)
    found = {name for each in content.get("controllers", [content]) for kind in kinds for name in kind(each)}
    return frozenset(found | set(_of_robot(content)))


def _of_robot(content: Section) -> Iterator[str]:
    """What controllers and the host do for each other: messages and services."""
    if "controllers" not in content:
        return
    yield f"{len(content['controllers'])} controllers"
    nodes = content["host"].get("nodes", ())
    for kind, name in (("subscriptions", "messages"), ("services", "a service"), ("timers", "a client")):
        if any(kind in node for node in nodes):
            yield f"{name} on the host"
    served = [
        {each.get("service", each["name"]) for each in controller["application"]["nodes"][0].get("services", ())}
        for controller in content["controllers"]
    ]
    for number, controller in enumerate(content["controllers"]):
        called = {each["service"] for each in controller["application"]["nodes"][0].get("clients", ())}
        if any(called & other for other in served[:number] + served[number + 1 :]):
            yield "a service of another controller"


def _of_loops(content: Section) -> Iterator[str]:
    executors = content["middleware"]["executors"]
    for executor in executors:
        loop = executor.get("loop", {})
        if isinstance(loop, list):
            yield from (f"item of a loop: {next(iter(item))}" for item in loop)
        elif loop:
            kind = next(key for key in ("spin_some", "spin_period", "spin") if key in loop)
            yield f"loop: {kind}" + ((", sleep" if "sleep" in loop else ", no sleep") if kind == "spin_some" else "")
        trigger = executor.get("trigger", "any")
        yield f"trigger: {trigger if isinstance(trigger, str) else next(iter(trigger))}"
        yield f"semantics: {executor.get('semantics', 'ROS')}"
    if len(executors) > 1:
        yield "several executors, one session"
    if "sleep_ticks" in content["os"]:
        yield "sleep in ticks"
    if "overhead" in content["os"]:
        yield "overhead of the operating system"


def _of_messages(content: Section) -> Iterator[str]:
    node, waits = content["application"]["nodes"][0], content["middleware"].get("reliable", {}).get("waits", True)
    names = {
        "subscriptions": "subscription",
        "timers": "timer",
        "guard_conditions": "guard condition",
        "services": "service",
        "clients": "client",
        "action_servers": "action server",
        "action_clients": "action client",
    }
    for plural, name in names.items():
        for section in node.get(plural, ()):
            yield f"handle: {name}"
            yield "phase: stated" if "phase" in section else "phase: not stated"
            if plural == "subscriptions":
                yield f"received {section['reliability']}"
            if "jitter" in section:
                yield "jitter of messages"
            if section.get("invocation") == "always":
                yield "called always"
            if section.get("runs_in") == "own-task":
                yield "callback with a task of its own"
            if "depth" in section:
                yield f"history: {section['history']}, depth {'1' if section['depth'] == 1 else 'more'}"
            if any(int(section.get(key, "0 B").split()[0]) >= 120 for key in ("message_size", "request_size", "response_size")):
                yield "large messages"
    received = {each["topic"] for each in node.get("subscriptions", ())}
    for publisher in node["publishers"]:
        is_reliable = publisher.get("reliability") != "best-effort"
        yield f"published {'reliable' if is_reliable else 'best-effort'}{', waits' if is_reliable and waits else ''}"
        if int(publisher["message_size"].split()[0]) >= 120:
            yield "large messages"
        if publisher["topic"] in received:
            yield "message that comes back from the agent"


def _of_wire(content: Section) -> Iterator[str]:
    middleware = content["middleware"]
    ((name, wire),) = ((key, value) for key, value in middleware["transport"].items() if key != "losses")
    yield f"wire: {name}"
    if "interrupt" in wire:
        yield "interrupt of the wire"
    if wire.get("foreign"):
        yield "foreign frames"
    for direction in ("write", "read"):
        if "driver" in wire:
            yield f"driver: {direction} {wire['driver'][direction]}"
    if "buffer" in wire.get("driver", {}):
        yield "driver: buffer"
    if "losses" in middleware["transport"]:
        yield "messages are lost"
    if "RMW_UXRCE_MAX_HISTORY" in middleware.get("limits", {}):
        yield "few slots"
    if len(middleware["agent"]) < 3:
        yield "agent: not all times stated"


def _of_processes(content: Section) -> Iterator[str]:
    executors = content["middleware"]["executors"]
    for task in content["tasks"]:
        yield "task above" if task["priority"] > max(each.get("priority", 0) for each in executors) else "task below"
        if "locks" in task:
            yield "locks"
        if "sporadic" in task:
            yield "sporadic task"
        if "preemption" in task:
            yield "non-preemptive task"
    if content["isrs"]:
        yield "interrupt service routine"
