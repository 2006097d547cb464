"""Random descriptions of applications with executors that spin in loops, on every kind of wire."""

from __future__ import annotations

from random import Random
from typing import Any

Section = dict[str, Any]

US, MS = 1_000, 1_000_000
PERIODS = (5, 10, 20, 25, 50, 100)
WIRES = "serial", "serial", "usb_cdc", "udp", "tcp", "can_fd", "can", "custom"
KINDS = ("subscription",) * 6 + ("timer",) * 5 + ("guard", "guard", "service", "client")


def span(chance: Random, low: int, high: int) -> str | Section:
    """A time of a range in nanoseconds: one value, or a least and a greatest one."""
    least, most = sorted((chance.randint(low, high), chance.randint(low, high)))
    return f"{most} ns" if chance.random() < 0.4 or least == 0 else {"min": f"{least} ns", "max": f"{most} ns"}


def latency(chance: Random, most: int) -> Section:
    """A time that can also be zero."""
    low, high = sorted((chance.choice((0, chance.randint(0, most))), chance.randint(1, most)))
    return {"min": f"{low} ns", "max": f"{high} ns"}


def random_description(seed: int) -> Section:
    """A description in which most, but not all, is stated."""
    chance = Random(seed)
    names = [f"E{number}" for number in range(chance.choice((1, 1, 1, 1, 2, 2, 3)))]
    middleware = _middleware(chance, names)
    is_can = not {"can", "can_fd"}.isdisjoint(middleware["transport"])
    content: Section = {
        "amuros": 1,
        "name": "drawn",
        "hardware": {"platform": "single-core", "frequency": "1 GHz"},
        "os": _os(chance),
        "middleware": middleware,
        "application": {"nodes": [_node(chance, names, (4, 24, 40) if is_can else (4, 24, 40, 120, 400))]},
        "labels": {"command": "4 B", "motor": "4 B"},
    }
    _processes(chance, content)
    _orders_and_triggers(chance, content)
    content["chains"] = list(_chains(chance, content))
    content["requirements"] = list(_requirements(chance, content))
    return content


def _os(chance: Random) -> Section:
    section: Section = {"tick": f"{chance.choice((1, 1, 10))} ms"}
    if chance.random() < 0.25:
        section["sleep_ticks"] = {"early": chance.choice((0, 1)), "late": chance.choice((0, 1))}
    if chance.random() < 0.2:
        overhead = {"activation": span(chance, 1 * US, 4 * US), "termination": span(chance, 1 * US, 4 * US)}
        section["overhead"] = {**overhead, "activations_run_in": chance.choice(("task", "interrupt"))}
    return section


def _middleware(chance: Random, names: list[str]) -> Section:
    wire = chance.choice(WIRES)
    section: Section = {
        "executors": [_executor(chance, name, 50 - number) for number, name in enumerate(names)],
        "multithread": len(names) > 1,
        "transport": {wire: _wire(chance, wire)},
        "agent": {},
    }
    for key, odds in (("to_controller", 0.95), ("to_host", 0.9), ("acknowledgement", 0.95)):
        if chance.random() < odds:
            section["agent"][key] = latency(chance, chance.choice((MS, 5 * MS)))
    if chance.random() < 0.5:
        section["publish"] = {"fixed": span(chance, 5 * US, 80 * US), "per_byte": f"{chance.choice((0, 10, 100))} ns"}
    if chance.random() < 0.35:
        section["reliable"] = {"waits": False}
    elif chance.random() < 0.4:
        section["reliable"] = {"timeout": f"{chance.choice((5, 20, 100))} ms"}
    if chance.random() < 0.3:
        section["limits"] = {"RMW_UXRCE_MAX_HISTORY": chance.choice((1, 2, 4))}
    return section


def _executor(chance: Random, name: str, priority: int) -> Section:
    cost: Section = {"base": span(chance, 5 * US, 200 * US)}
    for key in ("per_handle", "per_message", "per_timer"):
        if chance.random() < 0.4:
            cost[key] = span(chance, 1 * US, 30 * US)
    section: Section = {"name": name, "priority": priority, "execution_time": cost, "loop": _loop(chance)}
    if chance.random() < 0.3:
        section["semantics"] = "LET"
    return section


def _loop(chance: Random) -> Section:
    timeout = f"{chance.choice((0, 1, 2, 10, 20, 100)) * 1000 + chance.choice((0, 0, 300))} us"
    match chance.choice(("sleep", "sleep", "sleep", "bare", "period", "spin", "spin")):
        case "sleep":
            return {"spin_some": timeout, "sleep": f"{chance.choice((1, 2, 5, 10))} ms"}
        case "bare":
            return {"spin_some": timeout}
        case "period":
            return {"spin_period": f"{chance.choice((5, 10, 20))} ms", "timeout": f"{chance.choice((1, 2, 5, 30))} ms"}
    return {"spin": f"{chance.choice((1, 10, 100, 1000))} ms"}


def _wire(chance: Random, wire: str) -> Section:
    section: Section = {}
    if chance.random() < 0.5:
        section["interrupt"] = {"name": "Receive", "execution_time": span(chance, 1 * US, 10 * US), "priority": 5}
    if wire in ("serial", "usb_cdc", "udp", "tcp", "custom") and chance.random() < 0.5:
        driver: Section = {"write": chance.choice(("dma", "interrupt", "polling", "blocking"))}
        driver["read"] = chance.choice(("dma", "interrupt", "polling", "blocking"))
        for key in ("write_cost", "read_cost"):
            if chance.random() < 0.3:
                driver[key] = {"fixed": span(chance, 1 * US, 20 * US), "per_byte": "10 ns"}
        if chance.random() < 0.3:
            driver["buffer"] = f"{chance.choice((64, 256, 2048))} B"
        section["driver"] = driver
    match wire:
        case "serial":
            section["baud_rate"] = chance.choice((115_200, 460_800, 921_600, 2_000_000))
        case "usb_cdc" | "udp" | "tcp":
            if wire != "usb_cdc":
                section["bitrate"] = f"{chance.choice((1, 10, 100))} Mbit/s"
            if chance.random() < 0.95:
                section["latency"] = latency(chance, 2 * MS)
        case "custom":
            section["table"] = [{"size": "512 B", "time": latency(chance, 2 * MS)}]
            section["framing"] = chance.random() < 0.3
        case _:
            section["bitrate"] = f"{chance.choice((500, 1000))} kbit/s"
            if wire == "can_fd":
                section["data_bitrate"] = f"{chance.choice((2, 5))} Mbit/s"
            section["foreign"] = [
                {"name": f"foreign_{number}", "identifier": 16 + number, "bytes": 8, "period": f"{chance.choice((5, 20))} ms"}
                for number in range(chance.randrange(3))
            ]
    return section


def _node(chance: Random, names: list[str], sizes: tuple[int, ...]) -> Section:
    node: Section = {"name": "node", "publishers": []}
    sections: list[Section] = []
    rates = chance.choice((PERIODS[:3], PERIODS[1:5], PERIODS[3:]))
    for number in range(max(len(names), chance.choice((1, 2, 2, 3, 4, 5)))):
        kind, name = chance.choice(KINDS), f"C{number}"
        section: Section = {"name": name, "execution_time": span(chance, 5 * US, chance.choice((100 * US, 800 * US)))}
        period = f"{chance.choice(rates) * 1000 + chance.choice((0, 0, 137))} us"
        if chance.random() < 0.4:
            section["phase"] = f"{chance.randint(0, 20_000)} us"
        if len(names) > 1:
            section["runs_in"] = names[number] if number < len(names) else chance.choice(names)
        elif chance.random() < 0.05 and number:
            section["runs_in"] = "own-task"
        _of_kind(chance, kind, section, period, sizes)
        if chance.random() < 0.5:
            section["writes"] = ["command"]
        elif chance.random() < 0.5:
            section |= {"reads": ["command"], "writes": ["motor"]}
        plural = {"guard": "guard_conditions"}.get(kind, f"{kind}s")
        node.setdefault(plural, []).append(section)
        sections.append(section)
    for number in range(chance.choice((0, 1, 1, 2, 3))):
        publisher: Section = {"topic": f"out{number}", "message_size": f"{chance.choice(sizes)} B"}
        if chance.random() < 0.55:
            publisher["reliability"] = "best-effort"
            if publisher["message_size"] == "400 B" and chance.random() < 0.9:
                publisher["message_size"] = "200 B"
        node["publishers"].append(publisher)
        chance.choice(sections).setdefault("publishes", []).append(publisher["topic"])
    _relay(chance, node)
    for client in node.get("clients", ()):
        if node.get("timers"):
            timer = node["timers"][-1]
            timer["period"], client["interval"] = "100 ms", "5 ms"
            timer.setdefault("requests", []).append(client["name"])
    return node


def _relay(chance: Random, node: Section) -> None:
    """Have a timer publish what a subscription receives, whose stated interval holds with any jitter of the timer."""
    if chance.random() < 0.2 and node.get("timers") and node.get("subscriptions"):
        timer, subscription = node["timers"][0], node["subscriptions"][0]
        timer["period"], subscription["interval"] = f"{chance.choice((50, 100))} ms", "5 ms"
        subscription.pop("jitter", None)
        topic = {key: subscription[key] for key in ("topic", "message_size", "reliability")}
        node["publishers"].append(topic)
        timer.setdefault("publishes", []).append(topic["topic"])


def _of_kind(chance: Random, kind: str, section: Section, period: str, sizes: tuple[int, ...]) -> None:
    if kind == "timer":
        section["period"] = period
        return
    section["interval"] = period
    if kind == "guard":
        return
    section |= {"depth": chance.choice((1, 1, 2, 5, 10)), "history": chance.choice(("keep-last", "keep-last", "keep-all"))}
    if kind == "subscription":
        section |= {"topic": f"in_{section['name']}", "message_size": f"{chance.choice(sizes)} B"}
        section["reliability"] = chance.choice(("reliable", "best-effort", "best-effort"))
        if section["reliability"] == "best-effort" and section["message_size"] == "400 B":
            section["message_size"] = "200 B"
        if chance.random() < 0.3 and "interval" in section:
            section["jitter"] = f"{chance.randint(1, 9)} ms" if int(period.split()[0]) > 10_000 else "1 ms"
        if chance.random() < 0.08:
            section["invocation"] = "always"
        return
    section |= {"request_size": f"{chance.choice(sizes[:4])} B", "response_size": f"{chance.choice(sizes[:4])} B"}
    if kind == "client":
        section["service"] = f"service_{section['name']}"


def _callbacks(content: Section) -> list[Section]:
    node = content["application"]["nodes"][0]
    found = [each for value in node.values() if isinstance(value, list) for each in value]
    return sorted((each for each in found if "execution_time" in each), key=lambda each: each["name"])


def _processes(chance: Random, content: Section) -> None:
    """Tasks and interrupts of the application, with or without locks."""
    tasks, isrs = [], []
    for number in range(chance.choice((0, 1, 1, 2, 3))):
        period = chance.choice((1, 2, 5, 10))
        task: Section = {
            "name": f"T{number}",
            "priority": chance.choice((60, 61, 62)) + number if chance.random() < 0.6 else 30 + number,
            "execution_time": span(chance, 2 * US, period * 100 * US),
        }
        if chance.random() < 0.2:
            task["sporadic"] = {"min": f"{period} ms", "max": f"{period * chance.choice((1, 3))} ms"}
        else:
            task["period"] = f"{period} ms"
            if chance.random() < 0.2:
                task["jitter"] = f"{chance.randint(1, period * 300)} us"
        if chance.random() < 0.5:
            task["reads"] = [chance.choice(("command", "motor"))]
        if chance.random() < 0.2:
            task["locks"] = ["bus"]
        if chance.random() < 0.1:
            task["preemption"] = "non-preemptive"
        tasks.append(task)
    if chance.random() < 0.25:
        isrs.append({"name": "I0", "period": f"{chance.choice((1, 2))} ms", "execution_time": span(chance, 1 * US, 50 * US)})
    content |= {"tasks": tasks, "isrs": isrs}


def _orders_and_triggers(chance: Random, content: Section) -> None:
    callbacks = _callbacks(content)
    for executor in content["middleware"]["executors"]:
        first = content["middleware"]["executors"][0]["name"]
        names = [each["name"] for each in callbacks if each.get("runs_in", first) == executor["name"]]
        if not names:
            continue
        if chance.random() < 0.5:
            executor["order"] = chance.sample(names, len(names))
        match chance.choice(("any",) * 12 + ("all", "always", "one", "custom")):
            case "one":
                executor["trigger"] = {"one": chance.choice(names)}
            case "custom":
                sets = [chance.sample(names, chance.randint(1, len(names))) for _ in range(2)]
                executor["trigger"] = {"custom": sets}
            case "any":
                pass
            case kind:
                executor["trigger"] = kind


def _chains(chance: Random, content: Section) -> Any:
    """Ways from messages and timers to labels, tasks and topics."""
    callbacks = {each["name"]: each for each in _callbacks(content)}
    readers = [task["name"] for task in content["tasks"] if "command" in task.get("reads", ())]
    for name, callback in callbacks.items():
        before = [f"/{callback['topic']}"] if "topic" in callback and "interval" in callback and chance.random() < 0.8 else []
        for topic in callback.get("publishes", ()):
            if before == [f"/{topic}"]:
                continue
            yield {"name": f"{name}-{topic}", "path": [*before, name, f"/{topic}"]}
        if callback.get("writes") == ["command"]:
            yield {"name": f"{name}-command", "path": [*before, name, "command"]}
            for reader in readers[:1]:
                yield {"name": f"{name}-{reader}", "path": [*before, name, "command", reader]}
            for other, reading in callbacks.items():
                if "command" in reading.get("reads", ()) and other != name:
                    yield {"name": f"{name}-{other}-motor", "path": [*before, name, "command", other, "motor"]}


def _requirements(chance: Random, content: Section) -> Any:
    """Limits of some chains, and of some processes."""
    for chain in content["chains"]:
        if chance.random() < 0.7:
            chain[chance.choice(("reaction", "age"))] = f"{chance.choice((10, 30, 100, 300))} ms"
    for name in [each["name"] for each in (*content["tasks"], *_callbacks(content))]:
        if chance.random() < 0.3:
            yield {"process": name, "response_time": f"{chance.choice((1, 5, 20, 50))} ms"}
