"""Descriptions of applications with looping executors, wires, agents and middlewares, made by chance from their keys."""

from __future__ import annotations

from random import Random
from typing import Any

import yaml

Keys = dict[str, Any]

_HARDWARE = (
    *("esp32", "generic", "nucleo-f446re", "rp2040", "olimex-stm32-e407", "teensy41"),
    {"frequency": "168 MHz", "cores": 1},
    {
        "frequency": "100 MHz",
        "cores": 2,
        "memories": [{"name": "RAM", "kind": "SRAM", "size": "64 KiB"}],
        "ram_budget": "32 KiB",
    },
)
_TIMES = ("1 ms", "5 ms", "10 ms", "20 ms", "50 ms", "100 ms", "1 s")
_COSTS = ("10 us", "50 us", "0.3 ms", "2 ms")
_SIZES = ("1 B", "8 B", "48 B", "320 B", "600 B")
_CALLBACKS = ("subscriptions", "subscriptions", "timers", "timers", "services", "clients", "guard_conditions", "action_servers")


def make_description(rng: Random) -> str:
    """An application whose names fit together; everything else is by chance."""
    executors = [f"Executor_{number}" for number in range(rng.choice((1, 1, 1, 2, 3)))]
    nodes = [_node(rng, f"n{number}", executor) for number, executor in enumerate(executors)]
    description = {
        "amuros": 1,
        "name": "by-chance",
        "hardware": rng.choice(_HARDWARE),
        "middleware": _middleware(rng, executors, nodes),
        "application": {"nodes": nodes},
        "chains": [_chain(rng, f"way_{number}", rng.choice(nodes)) for number in range(rng.choice((0, 1, 2)))],
    }
    if _sometimes(rng):
        tasks = {
            "name": "Idle_Work",
            "period": rng.choice(_TIMES),
            "execution_time": _time(rng),
            "priority": rng.randint(0, 20),
        }
        description["tasks"] = [tasks]
    if _sometimes(rng):
        description["os"] = {"overhead": {"activation": "2 us", "termination": "1 us"}}
    return yaml.safe_dump(description, sort_keys=False, default_flow_style=None, width=130)


def _sometimes(rng: Random, share: float = 0.3) -> bool:
    return rng.random() < share


def _some(rng: Random, **keys: Any) -> Keys:
    """Some of the keys."""
    return {key: value for key, value in keys.items() if _sometimes(rng)}


def _time(rng: Random) -> str | Keys:
    high = rng.choice(_COSTS)
    return high if _sometimes(rng, 0.5) else {"min": "1 us", "max": high}


def _latency(rng: Random) -> str | Keys:
    return rng.choice(("0 s", "1 ms", {"min": 0, "max": "2 ms"}, {"max": "20 ms"}))


def _message_cost(rng: Random) -> str | Keys:
    return rng.choice((rng.choice(_COSTS), {"fixed": "10 us", "per_byte": "100 ns"}, {"per_byte": "50 ns"}))


def _middleware(rng: Random, executors: list[str], nodes: list[Keys]) -> Keys:
    described = [_executor(rng, name, node) for name, node in zip(executors, nodes, strict=True)]
    found: Keys = {"executor": described[0]} if len(described) == 1 else {"executors": described}
    found |= {"transport": _transport(rng)} if _sometimes(rng, 0.85) else {}
    found |= {
        "agent": _some(rng, name="Agent", **{key: _latency(rng) for key in ("to_controller", "to_host", "acknowledgement")})
    }
    found |= _some(
        rng,
        multithread=rng.choice((True, False)),
        publish=_message_cost(rng),
        reliable=_some(rng, waits=rng.choice((True, False)), timeout=rng.choice(_TIMES)),
        tasks=[
            {"name": "Reader", "priority": rng.randint(0, 30), **_some(rng, execution_time=_message_cost(rng), stack="2 KiB")}
        ],
        initialisation={"response_time": rng.choice(_TIMES)},
    )
    if _sometimes(rng, 0.15):
        return found | {
            "profile": "zenoh-pico",
            "tasks": [{"name": "zenoh_read", "priority": 3}, {"name": "zenoh_lease", "priority": 2}],
        }
    entities = ("NODES", "PUBLISHERS", "SUBSCRIPTIONS", "SERVICES", "CLIENTS", "TOPICS", "GUARD_CONDITION")
    enough = {f"RMW_UXRCE_MAX_{entity}": 20 for entity in entities}
    sizes = _some(
        rng,
        RMW_UXRCE_MAX_HISTORY=rng.randint(1, 20),
        RMW_UXRCE_STREAM_HISTORY=rng.choice((1, 2, 4, 32)),
        RMW_UXRCE_MAX_PUBLISHERS=rng.randint(0, 5),
        UCLIENT_CUSTOM_TRANSPORT_MTU=rng.choice(("128 B", "512 B", "2048 B")),
    )
    return found | {"limits": enough | sizes}


def _executor(rng: Random, name: str, node: Keys) -> Keys:
    callbacks = [item["name"] for kind in ("subscriptions", "timers") for item in node.get(kind, ()) if "runs_in" not in item]
    triggers = ["any", "all", "always", *({"one": item} for item in callbacks), {"custom": [callbacks]} if callbacks else "any"]
    loops = (
        {"spin_some": rng.choice(("0 s", "100 ns", *_TIMES)), **_some(rng, sleep=rng.choice(_TIMES))},
        {"spin_period": rng.choice(_TIMES), **_some(rng, timeout=rng.choice(_TIMES))},
        {"spin": rng.choice(_TIMES)},
    )
    paced = {"loop": rng.choice(loops)} if _sometimes(rng, 0.85) else {"period": rng.choice(_TIMES)}
    costs = {key: _time(rng) for key in ("base", "per_ready_callback", "per_timer", "per_handle")}
    return {
        "name": name,
        **paced,
        **_some(
            rng,
            priority=rng.randint(0, 24),
            max_handles=rng.randint(4, 30),
            stack=rng.choice(("1 KiB", "16000 B", "1 MiB")),
            execution_time=_some(rng, **costs, per_message=_message_cost(rng)),
            callbacks=rng.choice(("own-task", "in-executor")),
            order=rng.sample(callbacks, rng.randint(0, len(callbacks))),
            semantics=rng.choice(("ROS", "LET")),
            trigger=rng.choice(triggers),
            deadline=rng.choice(_TIMES),
        ),
    }


def _transport(rng: Random) -> Keys:
    bits = {"bitrate": rng.choice(("125 kbit/s", "500 kbit/s", "10 Mbit/s"))}
    parts = _some(rng, driver=_driver(rng), interrupt=rng.choice(("5 us", {"name": "Receive", "execution_time": _time(rng)})))
    foreign = {"name": "Others", "identifier": 0x100, **_some(rng, period=rng.choice(_TIMES), jitter="1 ms")}
    network = bits | parts | _some(rng, latency=_latency(rng), overhead="66 B")
    bus = bits | _some(rng, interrupt="5 us", foreign=[foreign], identifiers={"n0_in_0": 0x80})
    table = [{"size": "64 B", "time": _latency(rng)}, {"size": "600 B", "time": "25 ms"}][rng.randint(0, 1) :]
    wires: Keys = {
        "serial": {"baud_rate": rng.choice((9600, 115200, 2_000_000)), **_some(rng, bits_per_byte=rng.randint(8, 13)), **parts},
        "udp": network,
        "tcp": network,
        "usb_cdc": _some(rng, throughput="480 Mbit/s", latency=_latency(rng)) | parts,
        "can": bus,
        "can_fd": bus | {"data_bitrate": "10 Mbit/s"},
        "custom": {"table": table, **parts, **_some(rng, framing=True)},
    }
    kind = rng.choice(list(wires))
    return {kind: wires[kind], **_some(rng, overhead="12 B", acknowledgement=rng.choice(_TIMES), loses_messages=True)}


def _driver(rng: Random) -> Keys:
    modes = ("dma", "interrupt", "polling", "blocking")
    return _some(
        rng,
        write=rng.choice(modes),
        read=rng.choice(modes),
        tick=rng.choice(_TIMES),
        write_cost=_message_cost(rng),
        read_cost=_message_cost(rng),
        buffer=rng.choice(("0 B", "64 B", "2 KiB")),
    )


def _node(rng: Random, name: str, executor: str) -> Keys:
    topics = [f"{name}_out_{number}" for number in range(rng.randint(0, 3))]
    node: Keys = {"name": name, "runs_in": executor}
    node["publishers"] = [{"topic": topic, "message_size": rng.choice(_SIZES), **_reliability(rng)} for topic in topics]
    node["subscriptions"] = [_callback(rng, name, "subscriptions", 0, topics)]
    for number in range(1, rng.randint(1, 6)):
        kind = rng.choice(_CALLBACKS)
        node.setdefault(kind, []).append(_callback(rng, name, kind, number, topics))
    answering = {"execution_time": _time(rng), "rate": "1 Hz"}
    return node | {key: answering for key in ("parameter_server", "lifecycle") if _sometimes(rng, 0.1)}


def _callback(rng: Random, node: str, kind: str, number: int, topics: list[str]) -> Keys:
    name = f"{node}_{kind}_{number}"
    found: Keys = {"name": name, "execution_time": _time(rng), **_sizes(rng, kind)}
    found |= {"publishes": rng.sample(topics, rng.randint(0, len(topics))), "reads": ["state"], "writes": ["state"]}
    found |= _some(rng, deadline=rng.choice(_TIMES))
    found |= {"runs_in": "own-task"} if number and _sometimes(rng, 0.15) else {}
    if kind == "timers":
        return found | {"period": rng.choice(_TIMES)}
    found |= {"interval": rng.choice(_TIMES)} if _sometimes(rng, 0.98) else {}
    if kind in ("subscriptions", "services", "clients"):
        found |= _some(rng, depth=rng.randint(1, 20), history=rng.choice(("keep-last", "keep-all")))
    if kind == "subscriptions":
        found |= {"topic": f"{node}_in_{number}", **_reliability(rng)}
        found |= _some(rng, invocation=rng.choice(("on-new-data", "always")), jitter="0.5 ms")
    return found


def _sizes(rng: Random, kind: str) -> Keys:
    keys = {
        "subscriptions": ("message_size",),
        "services": ("request_size", "response_size"),
        "clients": ("request_size", "response_size"),
        "action_servers": ("goal_size", "result_size", "feedback_size"),
    }.get(kind, ())
    return {key: rng.choice(_SIZES) for key in keys} | ({"service": "elsewhere"} if kind == "clients" else {})


def _reliability(rng: Random) -> Keys:
    return _some(rng, reliability=rng.choice(("reliable", "best-effort")))


def _chain(rng: Random, name: str, node: Keys) -> Keys:
    """From a topic or a callback, through labels, to a callback or a topic that it publishes."""
    callbacks = [callback for kind in sorted(set(_CALLBACKS)) for callback in node.get(kind, ())]
    path = [node["subscriptions"][0], *rng.sample(callbacks, rng.randint(0, len(callbacks)))]
    path = path[:1] + [callback for callback in path[1:] if callback is not path[0]]
    received = [path[0]["topic"]] if _sometimes(rng, 0.6) else []
    sent = path[-1]["publishes"][:1] if _sometimes(rng, 0.6) else []
    members = [*received, *(callback["name"] for callback in path), *sent]
    return {"name": name, "path": members, **_some(rng, reaction=rng.choice(_TIMES), age=rng.choice(_TIMES), jitter="5 ms")}
