"""The longest contents that an application sends and receives over XRCE-DDS, and the buffers that they need."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from amalthea_uros.perf.named import Brief
from amalthea_uros.spec.application import Application, Node
from amalthea_uros.units import DataSize

#: Headers of a message and a submessage, without the four bytes that precede the content (eProsima/Micro-XRCE-DDS-Client
#: src/c/core/session/write_access.c).
_HEADERS = 8
#: Of a request that arrives and of the response to it: the identity of the sample; of a response that arrives.
_SAMPLE_IDENTITY, _REPLY = 24, 4


@dataclass(frozen=True, slots=True, kw_only=True)
class Content(Brief):
    """A message, with the bytes of its content and what precedes it in a service."""

    length: int
    reliable: bool
    incoming: bool


def contents_of(application: Application) -> list[Content]:
    """All messages of an application; those of parameters and lifecycles have no stated length."""
    return [content for node in application.nodes for content in _contents(node)]


def _contents(node: Node) -> Iterator[Content]:
    for each in node.subscriptions:
        yield _content(each.message_size, reliable=each.reliability == "reliable", incoming=True)
    for publisher in node.publishers:
        yield _content(publisher.message_size, reliable=publisher.reliability == "reliable", incoming=False)
    for service in node.services:
        yield _content(service.request_size, _SAMPLE_IDENTITY, incoming=True)
        yield _content(service.response_size, _SAMPLE_IDENTITY, incoming=False)
    for client in node.clients:
        yield _content(client.request_size, incoming=False)
        yield _content(client.response_size, _REPLY, incoming=True)
    for server in node.action_servers:
        yield _content(server.goal_size, _SAMPLE_IDENTITY, incoming=True)
        yield _content(server.result_size, _SAMPLE_IDENTITY, incoming=False)
        yield _content(server.feedback_size, incoming=False)
    for action in node.action_clients:
        yield _content(action.goal_size, incoming=False)
        yield _content(action.result_size, _REPLY, incoming=True)
        yield _content(action.feedback_size, incoming=True)


def _content(size: DataSize, more: int = 0, *, incoming: bool, reliable: bool = True) -> Content:
    return Content(length=-(-size // 8) + more, reliable=reliable, incoming=incoming)


def least_mtu(contents: list[Content]) -> int:
    """The smallest MTU for all best-effort messages, which are never divided: with headers, padded to four bytes."""
    return max((_HEADERS + -(-(4 + each.length) // 4) * 4 for each in contents if not each.reliable), default=0)


def fragments(content: Content, mtu: int) -> int | None:
    """The buffers that a reliable message needs; None if no number of them is enough."""
    if content.length <= mtu - 16:
        return 1
    return -(-(content.length + 8) // (mtu - 12)) if mtu > 12 else None
