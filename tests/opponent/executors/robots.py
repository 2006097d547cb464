"""Random robots: a host, and several controllers with executors that spin in loops, which exchange messages through their agents."""

from __future__ import annotations

from copy import deepcopy
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
    return content


def controller(part: str, content: Section) -> Section:
    """A description as a controller of a robot, with topics and services of its own."""
    content = deepcopy(content)
    del content["amuros"]
    content["name"] = part
    for node in content["application"]["nodes"]:
        for kind in ("publishers", "subscriptions"):
            for each in node.get(kind, ()):
                each["topic"] = f"{part}_{each['topic']}"
        for kind in ("services", "clients"):
            for each in node.get(kind, ()):
                each["service"] = f"{part}_{each.get('service', each['name'])}"
        for callback in _callbacks(node):
            callback["publishes"] = [f"{part}_{topic}" for topic in callback.get("publishes", ())]
    for chain in content["chains"]:
        if "path" in chain:
            chain["path"] = [f"/{part}_{name[1:]}" if name.startswith("/") else name for name in chain["path"]]
    return content


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
    thread = {"policy": "fifo", "priority": 50, "core": 0}
    executors = host.setdefault("executors", [{"name": "host", "thread": thread}])
    own = {"name": name, "topic": topic, "publishes": [answer], "execution_time": span(chance, 10 * US, 2 * MS)}
    host.setdefault("nodes", []).append({"name": f"node_{topic}", "executor": executors[0]["name"], "subscriptions": [own]})
    subscription["topic"] = answer
    return [name, f"/{answer}"]
