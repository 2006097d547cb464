"""Random descriptions and robots some of whose services are actions, with goals, results and feedback."""

from __future__ import annotations

from collections.abc import Iterator
from random import Random

from opponent.executors.descriptions import MS, US, Section, random_description, span
from opponent.executors.robots import random_robot

_SIZES = {"request_size": "goal_size", "response_size": "result_size"}


def description_with_actions(seed: int) -> Section:
    """A random description, with an action server more and its feedback in a chain."""
    content, chance = random_description(seed), Random(f"actions {seed}")
    _of_controller(chance, content, {each["name"] for each in _callbacks(content, "services")}, _services(content))
    server = {
        "name": "Move",
        **{key: f"{chance.choice((4, 24))} B" for key in (*_SIZES.values(), "feedback_size")},
        "interval": f"{chance.choice((20, 50, 200))} ms",
        "execution_time": span(chance, 10 * US, 200 * US),
        "runs_in": content["middleware"]["executors"][0]["name"],
    }
    content["application"]["nodes"][0].setdefault("action_servers", []).append(server)
    goals = ["/Move/_action/send_goal/request"] if chance.random() < 0.7 else []
    for part in ("feedback", "get_result/response"):
        path = [*goals, "Move", f"/Move/_action/{part}"]
        content["chains"].append({"name": f"Move-{part}", "path": path, "reaction": f"{chance.choice((10, 30, 100))} ms"})
    return content


def robot_with_actions(seed: int) -> Section:
    """A random robot in which services between controllers and the host are actions; the host takes feedback of some."""
    content, chance = random_robot(seed), Random(f"actions {seed}")
    served = [each["name"] for part in content["controllers"] for each in _callbacks(part, "services")]
    called = [name for part in content["controllers"] for name in _services(part)]
    actions = {name for name in dict.fromkeys([*served, *called]) if chance.random() < 0.8}
    for part in content["controllers"]:
        _of_controller(chance, part, actions, actions)
    for node in content["host"].get("nodes", ()):
        _of_host(node, actions)
    for chain in content["chains"]:
        chain["path"] = [_topic(name, actions) for name in chain["path"]]
    for name in sorted(actions.intersection(served)):
        if chance.random() < 0.5:
            _show_feedback(chance, content, name)
    return content


def _callbacks(part: Section, kind: str) -> list[Section]:
    return [each for node in part["application"]["nodes"] for each in node.get(kind, ())]


def _services(part: Section) -> set[str]:
    return {each["service"] for each in _callbacks(part, "clients")}


def _of_controller(chance: Random, part: Section, served: set[str], called: set[str]) -> None:
    """Make some services and clients of a controller actions."""
    for node in part["application"]["nodes"]:
        for kind, key, names in (("services", "name", served), ("clients", "service", called)):
            found = [each for each in node.get(kind, ()) if each[key] in names]
            node[kind] = [each for each in node.get(kind, ()) if each[key] not in names]
            target = {"services": "action_servers", "clients": "action_clients"}[kind]
            node[target] = list(_actions(chance, found))
            for plural in (kind, target):
                if not node[plural]:
                    del node[plural]


def _actions(chance: Random, services: list[Section]) -> Iterator[Section]:
    for each in services:
        action = {_SIZES.get(key, key): value for key, value in each.items() if key != "service"}
        if "service" in each:
            action["action"] = each["service"]
        yield action | {"feedback_size": f"{chance.choice((4, 24))} B"}


def _of_host(node: Section, actions: set[str]) -> None:
    """Have a node of the host send and take goals, and take and send results, by their services and topics."""
    for timer in node.get("timers", ()):
        timer["calls"] = [f"{name}/_action/send_goal" if name in actions else name for name in timer.get("calls", ())]
    for client in node.get("clients", ()):
        if client["service"] in actions:
            client["service"] += "/_action/get_result"
    for service in node.get("services", ()):
        if (name := service["service"]) in actions:
            service |= {"service": f"{name}/_action/send_goal", "publishes": [f"{name}/_action/get_result/response"]}


def _topic(name: str, actions: set[str]) -> str:
    """The topic of an action instead of that of a service."""
    service, _, end = name.rpartition("/")
    return f"{service}/_action/{'send_goal' if end == 'request' else 'get_result'}/{end}" if service in actions else name


def _show_feedback(chance: Random, content: Section, action: str) -> None:
    host = content["host"]
    thread = {"policy": "fifo", "priority": 50, "core": 0}
    executors = host.setdefault("executors", [{"name": "host", "thread": thread}])
    topic = f"{action}/_action/feedback"
    show = {"name": f"Show_{action}", "topic": topic, "execution_time": span(chance, 10 * US, MS)}
    host.setdefault("nodes", []).append({"name": f"show_{action}", "executor": executors[0]["name"], "subscriptions": [show]})
    part = next(each["name"] for each in content["controllers"] if action in _names(each))
    content["chains"].append({"name": f"feedback of {action}", "path": [f"{part}_{action}", topic, show["name"]]})


def _names(part: Section) -> set[str]:
    return {each["name"] for each in _callbacks(part, "action_servers")}
