"""How the functions that the application defines are declared and called."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.spec.application import Publisher, Subscription
from amalthea_uros.uros.firmware.entities import CodeHandler, CodeMessage

#: What a callback about a goal is given first: the goal, and whether it is accepted.
_GOAL = ("rclc_action_goal_handle_t *", "goal")
_OF_GOALS = {"action_server": [_GOAL], "action_client": [_GOAL, ("bool", "is_accepted")]}


def parameters(handler: CodeHandler) -> str:
    """The parameters of a function: its message or goal, and the messages that it fills in."""
    listed = [f"{kind} {name}" for kind, name in _OF_GOALS.get(handler.kind, ())]
    listed += [f"{kind} * {message.variable}" for kind, message in _inputs(handler)]
    listed += [f"{message.c_type} * {message.variable}" for message in _outputs(handler)]
    return ", ".join(listed) or "void"


def arguments(handler: CodeHandler) -> str:
    """The arguments in its callback."""
    received = ["request", "response"] if handler.kind == "service" else ["response" if handler.kind == "client" else "message"]
    given = [name for _, name in _OF_GOALS.get(handler.kind, ())]
    given += [f"({kind} *) {name}" for (kind, _), name in zip(_inputs(handler), received, strict=False)]
    return ", ".join([*given, *(f"&{message.variable}" for message in _outputs(handler))])


def _inputs(handler: CodeHandler) -> Iterator[tuple[str, CodeMessage]]:
    match handler.kind:
        case "subscription":
            yield f"const {handler.messages[0].c_type}", handler.messages[0]
        case "service":
            yield f"const {handler.messages[0].c_type}", handler.messages[0]
            yield handler.messages[1].c_type, handler.messages[1]
        case "client":
            yield f"const {handler.messages[1].c_type}", handler.messages[1]


def _outputs(handler: CodeHandler) -> Iterator[CodeMessage]:
    for publisher in handler.publishes:
        yield publisher.message
    for client in handler.requests:
        yield client.messages[0]


def quality(section: Publisher | Subscription) -> str:
    """The end of the function that creates something with a quality of service."""
    return "default" if section.reliability == "reliable" else "best_effort"
