"""The callbacks of nodes of the host: kinds, and the topics that call them and that they publish; services are two topics each."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.perf.network import plain_topic, request_topic, response_topic
from amalthea_uros.spec import host as spec

AnyCallback = spec.HostSubscription | spec.HostTimer | spec.HostService | spec.HostClient


def callbacks_of(node: spec.HostNodeSection) -> list[AnyCallback]:
    """The callbacks of a node; kinds have an order of their own in a ready set anyway."""
    return [*node.timers, *node.subscriptions, *node.services, *node.clients]


def kind_of(section: AnyCallback) -> HandleKind:
    """The kind of a callback."""
    if isinstance(section, spec.HostTimer):
        return HandleKind.TIMER
    if isinstance(section, spec.HostService):
        return HandleKind.SERVICE
    return HandleKind.CLIENT if isinstance(section, spec.HostClient) else HandleKind.SUBSCRIPTION


def topic_of(section: AnyCallback) -> str | None:
    """The topic whose messages call a callback; None of a timer."""
    if isinstance(section, spec.HostService):
        return request_topic(section.service)
    if isinstance(section, spec.HostClient):
        return response_topic(section.service)
    return plain_topic(section.topic) if isinstance(section, spec.HostSubscription) else None


def published_by(section: AnyCallback) -> Iterator[str]:
    """The topics that a callback publishes at its end, with its requests and its response."""
    yield from map(plain_topic, section.publishes)
    yield from map(request_topic, section.calls)
    if isinstance(section, spec.HostService):
        yield response_topic(section.service)
