"""Random robots: a host, and several controllers with executors that spin in loops, which exchange messages through their agents.

They also call services of each other and of the host, and the host calls theirs.
"""

from __future__ import annotations

from random import Random
from typing import Any

from opponent.executors.descriptions import MS, US, Section, latency, random_description, span

PARTS = "ab", "c", "d"
#: Seeds of applications all of whose handles have a bound, so that what others do with their messages has one, too.
BOUNDED = (
    1,
    7,
    15,
    18,
    39,
    41,
    44,
    61,
    65,
    66,
    71,
    75,
    76,
    85,
    88,
    91,
    92,
    99,
    104,
    110,
    117,
    121,
    122,
    144,
    149,
    153,
    154,
    162,
)


def random_robot(seed: int) -> Section:
    """A robot with two or three controllers; some receive what others publish."""
    chance = Random(f"robot {seed}")
    parts = PARTS[: chance.choice((2, 2, 3))]
    seeds = [chance.choice(BOUNDED) if chance.random() < 0.8 else chance.randrange(10**6) for _ in parts]
    controllers = [controller(part, random_description(own)) for part, own in zip(parts, seeds, strict=True)]
    content: Section = {"amuros": 1, "name": "robot", "controllers": controllers, "chains": []}
    content["host"] = {"ros": "humble", "computers": [{"name": "pc"}], "topics": []}
    if chance.random() < 0.9:
        content["host"]["latency"] = latency(chance, 2 * MS)
    for sender in controllers:
        others = [each for each in controllers if each is not sender]
        _connect(chance, content, sender, chance.choice(others))
        if chance.random() < 0.5:
            call = chance.choice((_call_controller, _call_controller, _call_host, _call_from_host))
            call(chance, content, sender, chance.choice(others))
    for each in controllers:
        if chance.random() < 0.5:
            # Otherwise, who waits for acknowledgements of requests and responses has a bound in few of them.
            each["middleware"]["reliable"] = {"waits": False}
    return content


def controller(part: str, content: Section) -> Section:
    """A description as a controller of a robot, with topics and services of its own."""
    nodes = content["application"]["nodes"]
    content = _renamed(content, {each["name"]: f"{part}_{each['name']}" for node in nodes for each in node.get("services", ())})
    del content["amuros"]
    content["name"] = part
    for node in content["application"]["nodes"]:
        for kind in ("publishers", "subscriptions"):
            for each in node.get(kind, ()):
                each["topic"] = f"{part}_{each['topic']}"
        for each in node.get("clients", ()):
            each["service"] = f"{part}_{each['service']}"
        for callback in _callbacks(node):
            callback["publishes"] = [f"{part}_{topic}" for topic in callback.get("publishes", ())]
    for chain in content["chains"]:
        if "path" in chain:
            chain["path"] = [f"/{part}_{name[1:]}" if name.startswith("/") else name for name in chain["path"]]
    return content


def _renamed(content: Any, names: dict[str, str]) -> Any:
    """A copy of a description in which some names are others."""
    if isinstance(content, dict):
        return {key: _renamed(value, names) for key, value in content.items()}
    return [_renamed(each, names) for each in content] if isinstance(content, list) else names.get(content, content)


def _callbacks(node: Section) -> list[Any]:
    kinds = ("subscriptions", "timers", "guard_conditions", "services", "clients")
    return [each for kind in kinds for each in node.get(kind, ())]


def _connect(chance: Random, content: Section, sender: Section, receiver: Section) -> None:
    """Have a subscription of a controller receive what a timer of another one publishes, at its period or at another one."""
    node, other = sender["application"]["nodes"][0], receiver["application"]["nodes"][0]
    timers = [each for each in node.get("timers", ()) if each["publishes"]]
    subscriptions = [each for each in other.get("subscriptions", ()) if each["topic"].startswith(f"{receiver['name']}_in_")]
    if not timers or not subscriptions:
        return
    timer, subscription = chance.choice(timers), chance.choice(subscriptions)
    old, topic = subscription["topic"], chance.choice(timer["publishes"])
    publisher = next(each for each in node["publishers"] if each["topic"] == topic)
    subscription |= {"topic": topic, "message_size": publisher["message_size"]}
    subscription["reliability"] = publisher.get("reliability", "reliable")
    if chance.random() < 0.8:
        subscription["interval"] = timer["period"]
    receiver["chains"] = [each for each in receiver["chains"] if f"/{old}" not in each.get("path", ())]
    between = [f"/{topic}"]
    if chance.random() < 0.3:
        between += _through_host(chance, content["host"], topic, subscription)
    path = [f"{sender['name']}_{timer['name']}", *between, f"{receiver['name']}_{subscription['name']}"]
    content["chains"].append({"name": f"{sender['name']}-to-{receiver['name']}", "path": path, "reaction": "100 ms"})


def _through_host(chance: Random, host: Section, topic: str, subscription: Section) -> list[str]:
    """Have a callback of the host receive a topic and publish another one, which a subscription receives instead; both in a path."""
    name, answer = f"On_{topic}", f"{topic}_on"
    own = {"name": name, "topic": topic, "publishes": [answer], "execution_time": span(chance, 10 * US, 2 * MS)}
    _add_node(host, f"node_{topic}", subscriptions=[own])
    subscription["topic"] = answer
    return [name, f"/{answer}"]


def _add_node(host: Section, name: str, **callbacks: list[Section]) -> None:
    thread = {"policy": "fifo", "priority": 50, "core": 0}
    executors = host.setdefault("executors", [{"name": "host", "thread": thread}])
    host.setdefault("nodes", []).append({"name": name, "executor": executors[0]["name"], **callbacks})


# Services.


def _call_controller(chance: Random, content: Section, caller: Section, other: Section) -> None:
    """Have a controller call a service of another one."""
    service = f"of_{other['name']}_for_{caller['name']}"
    client = _add_client(chance, content, caller, service, f"{other['name']}_{service}")
    _add_service(chance, other, service, client)


def _call_host(chance: Random, content: Section, caller: Section, _: Section) -> None:
    """Have a controller call a service of the host."""
    service = f"of_host_for_{caller['name']}"
    own = {"name": f"Serve_{caller['name']}", "service": service, "execution_time": span(chance, 10 * US, 2 * MS)}
    _add_client(chance, content, caller, service, own["name"])
    _add_node(content["host"], f"node_{service}", services=[own])


def _call_from_host(chance: Random, content: Section, _: Section, other: Section) -> None:
    """Have a timer of the host call a service of a controller; another callback there gets the responses."""
    service = f"of_{other['name']}_for_host_{len(content['chains'])}"
    period = f"{chance.choice((50, 100, 200))} ms"
    timer = {"name": f"Call_{service}", "period": period, "execution_time": span(chance, 10 * US, MS), "calls": [service]}
    got = {"name": f"Got_{service}", "service": service, "execution_time": span(chance, 10 * US, MS)}
    _add_node(content["host"], f"node_{service}", timers=[timer], clients=[got])
    _add_service(chance, other, service, {**_sizes(chance), "interval": period})
    _add_call(content, service, timer["name"], f"{other['name']}_{service}", got["name"])


def _sizes(chance: Random) -> Section:
    return {"request_size": f"{chance.choice((4, 24))} B", "response_size": f"{chance.choice((4, 24))} B"}


def _add_client(chance: Random, content: Section, caller: Section, service: str, server: str) -> Section:
    """Have a slow timer of a controller call a service, and another callback there get the responses."""
    node, part, period = caller["application"]["nodes"][0], caller["name"], f"{chance.choice((50, 100, 200))} ms"
    client = {"name": f"Got_{service}", "service": service, **_sizes(chance), "interval": period}
    client["execution_time"] = span(chance, 10 * US, 200 * US)
    timer = {"name": f"Call_{service}", "period": period, "execution_time": span(chance, 10 * US, 200 * US)}
    node.setdefault("timers", []).append({**timer, "requests": [client["name"]]})
    node.setdefault("clients", []).append(client)
    _add_call(content, service, f"{part}_{timer['name']}", server, f"{part}_{client['name']}")
    return client


def _add_service(chance: Random, other: Section, service: str, client: Section) -> None:
    """Have a controller serve what a client asks for, at its interval or at another one."""
    sizes = {key: client[key] for key in ("request_size", "response_size")}
    interval = client["interval"] if chance.random() < 0.8 else "50 ms"
    section = {"name": service, **sizes, "interval": interval, "execution_time": span(chance, 10 * US, 200 * US)}
    other["application"]["nodes"][0].setdefault("services", []).append(section)


def _add_call(content: Section, service: str, caller: str, server: str, client: str) -> None:
    path = [caller, f"{service}/request", server, f"{service}/response", client]
    content["chains"].append({"name": f"call of {service}", "path": path, "reaction": "200 ms"})
