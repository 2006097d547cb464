"""The longest contents that an application sends and receives over XRCE-DDS, and the buffers that they need."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from amalthea_uros.perf.named import Brief
from amalthea_uros.spec.application import Application, Node
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.profiles import ProfileData
from amalthea_uros.units import DataSize
from amalthea_uros.uros.middleware.figures import size
from amalthea_uros.uros.middleware.profile import MessageKind
from amalthea_uros.uros.middleware.xrce_dds.headers import SENT, capacity, headers, payload, piece


@dataclass(frozen=True, slots=True, kw_only=True)
class Content(Brief):
    """A message, with the bytes of its content."""

    kind: MessageKind
    length: int
    reliable: bool = True

    @property
    def incoming(self) -> bool:
        """Whether it arrives."""
        return self.kind not in SENT


def contents_of(application: Application) -> list[Content]:
    """All messages of an application; those of parameters and lifecycles have no stated length."""
    return [content for node in application.nodes for content in _contents(node)]


def _contents(node: Node) -> Iterator[Content]:
    for each in node.subscriptions:
        yield _content(MessageKind.DELIVERY, each.message_size, each.reliability)
    for publisher in node.publishers:
        yield _content(MessageKind.PUBLICATION, publisher.message_size, publisher.reliability)
    for service in node.services:
        yield _content(MessageKind.REQUEST_IN, service.request_size)
        yield _content(MessageKind.RESPONSE_OUT, service.response_size)
    for client in node.clients:
        yield _content(MessageKind.REQUEST_OUT, client.request_size)
        yield _content(MessageKind.RESPONSE_IN, client.response_size)
    for server in node.action_servers:
        yield _content(MessageKind.REQUEST_IN, server.goal_size)
        yield _content(MessageKind.RESPONSE_OUT, server.result_size)
        yield _content(MessageKind.PUBLICATION, server.feedback_size)
    for action in node.action_clients:
        yield _content(MessageKind.REQUEST_OUT, action.goal_size)
        yield _content(MessageKind.RESPONSE_IN, action.result_size)
        yield _content(MessageKind.DELIVERY, action.feedback_size)


def _content(kind: MessageKind, length: DataSize, reliability: str = "reliable") -> Content:
    return Content(kind=kind, length=-(-length // 8), reliable=reliability == "reliable")


def least_mtu(contents: Iterable[Content], middleware: Middleware, data: ProfileData) -> int:
    """The smallest MTU for all messages: whole ones if they are best effort; a fragment needs room for more than its headers."""
    smallest = size(data, "buffer_header") + headers(data) + 1
    return max((smallest if each.reliable else _whole(each, middleware, data) for each in contents), default=0)


def fragments(content: Content, mtu: int, middleware: Middleware, data: ProfileData) -> int | None:
    """The buffers that a reliable message needs; None if no number of them is enough."""
    whole = _whole(content, middleware, data)
    if whole <= capacity(True, mtu, data):
        return 1
    most = piece(mtu, data)
    return -(-(whole - size(data, "message_header")) // most) if most > 0 else None


def _whole(content: Content, middleware: Middleware, data: ProfileData) -> int:
    return headers(data) + payload(content.kind, content.length, middleware, data)
