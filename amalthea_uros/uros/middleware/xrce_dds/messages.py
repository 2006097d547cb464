"""Messages of XRCE-DDS: what precedes their content, their fragments, and how long they can be.

As src/c/core/session/session_info_internal.h, submessage_internal.h, write_access.c and stream/output_reliable_stream.c of
eProsima/Micro-XRCE-DDS-Client lay them out. A message that does not fit into a buffer of a reliable stream is cut into fragments, each
of which is a message with a header.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import repeat

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.named import Brief
from amalthea_uros.spec.application import Application, NodeSection
from amalthea_uros.units import DataSize
from amalthea_uros.uros.application.messages import SENT, MessageKind
from amalthea_uros.uros.middleware.profile import MessagePart, Profile, whole_bytes
from amalthea_uros.uros.middleware.xrce_dds.build import XrceBuild

#: What some messages have before their content, beside the identifier of the entity.
_EXTRA = {
    MessageKind.REQUEST_IN: "sample_identity",
    MessageKind.RESPONSE_OUT: "sample_identity",
    MessageKind.RESPONSE_IN: "reply_header",
}

#: The figures of questions to the agent, and of its replies.
_ASKED = {MessageKind.PING: ("ping", "ping_reply"), MessageKind.SYNC: ("sync", "sync_reply")}


@dataclass(frozen=True, slots=True, kw_only=True)
class MessageContent(Brief):
    """A message, with the bytes of its content."""

    kind: MessageKind
    length: int
    reliable: bool = True

    @property
    def incoming(self) -> bool:
        """Whether it arrives."""
        return self.kind not in SENT


def contents_of(application: Application) -> list[MessageContent]:
    """All messages of an application; those of parameters and lifecycles have no stated length."""
    return [
        MessageContent(kind=kind, length=whole_bytes(length), reliable=reliability == "reliable")
        for node in application.nodes
        for kind, length, reliability in _messages(node)
    ]


def _messages(node: NodeSection) -> Iterator[tuple[MessageKind, DataSize, str]]:
    for each in node.subscriptions:
        yield MessageKind.DELIVERY, each.message_size, each.reliability
    for publisher in node.publishers:
        yield MessageKind.PUBLICATION, publisher.message_size, publisher.reliability
    for service in node.services:
        yield MessageKind.REQUEST_IN, service.request_size, "reliable"
        yield MessageKind.RESPONSE_OUT, service.response_size, "reliable"
    for client in node.clients:
        yield MessageKind.REQUEST_OUT, client.request_size, "reliable"
        yield MessageKind.RESPONSE_IN, client.response_size, "reliable"
    for server in node.action_servers:
        yield MessageKind.REQUEST_IN, server.goal_size, "reliable"
        yield MessageKind.RESPONSE_OUT, server.result_size, "reliable"
        yield MessageKind.PUBLICATION, server.feedback_size, "reliable"
    for action in node.action_clients:
        yield MessageKind.REQUEST_OUT, action.goal_size, "reliable"
        yield MessageKind.RESPONSE_IN, action.result_size, "reliable"
        yield MessageKind.DELIVERY, action.feedback_size, "reliable"


@dataclass(frozen=True, slots=True)
class MessageLayout(Profile):
    """The lengths of messages in bytes, by the figures of a profile and the build options of a description."""

    @property
    def build(self) -> XrceBuild:
        """The values of its build options."""
        return XrceBuild(self.middleware, self.data.options)

    def parts(self, kind: MessageKind, content: int, *, reliable: bool) -> Sequence[MessagePart]:
        """What is sent for a message; one that cannot be sent is a single part, which is longer than the MTU allows."""
        if kind in _ASKED:
            asked, reply = map(self.size, _ASKED[kind])
            return (MessagePart(length=asked, acknowledgement=reply),)
        acknowledgement = self.size("acknowledgement") if reliable else None
        before, body = self.headers, self.payload(kind, content)
        is_whole = before + body <= self.capacity(reliable=True)
        if not reliable or is_whole or body > self.size("longest_payload"):
            return (MessagePart(length=before + body, acknowledgement=acknowledgement),)
        most = max(1, self.fragment)
        full, rest = divmod(self.size("submessage_header") + body, most)
        lengths = [*repeat(most, full), *([rest] if rest else [])]
        return tuple(MessagePart(length=before + length, acknowledgement=acknowledgement) for length in lengths)

    def largest_content(self, kind: MessageKind, *, reliable: bool) -> int:
        """The longest content of a message; 0 if not even an empty one can be sent."""
        payload = self.capacity(reliable=reliable) - self.headers
        if reliable:
            payload = max(payload, self._longest_fragmented(kind))
        alignment = self._alignment(kind)
        return max(0, payload // alignment * alignment - self._fixed(kind))

    def least_mtu(self, contents: Iterable[MessageContent]) -> int:
        """The smallest MTU for all messages: whole ones if they are best effort; a fragment needs room for more than its headers."""
        smallest = self.size("buffer_header") + self.headers + 1
        return max((smallest if each.reliable else self._whole(each) for each in contents), default=0)

    def fragments(self, content: MessageContent) -> int | None:
        """The buffers that a reliable message needs; None if no number of them is enough."""
        whole = self._whole(content)
        if whole <= self.capacity(reliable=True):
            return 1
        return -(-(whole - self.size("message_header")) // self.fragment) if self.fragment > 0 else None

    @property
    def headers(self) -> int:
        """The headers of a message and its submessage."""
        return self.size("message_header") + self.size("submessage_header")

    @property
    def fragment(self) -> int:
        """What a fragment carries; not positive if the MTU has no room for one."""
        return self.capacity(reliable=True) - self.headers

    def capacity(self, *, reliable: bool) -> int:
        """The longest message that is not cut into fragments."""
        return self.build.mtu - (self.size("buffer_header") if reliable else 0)

    def payload(self, kind: MessageKind, content: int) -> int:
        """The payload of the submessage, aligned."""
        alignment = self._alignment(kind)
        return -(-(self._fixed(kind) + content) // alignment) * alignment

    def _whole(self, content: MessageContent) -> int:
        return self.headers + self.payload(content.kind, content.length)

    def _longest_fragmented(self, kind: MessageKind) -> int:
        """The longest payload in fragments: as many as there are buffers, or any number if full buffers can be emptied in between.

        That is not possible in builds for several threads: see `uxr_prepare_output_stream_fragmented`.
        """
        if kind in SENT and self.sending.waits and not self.middleware.multithread:
            return self.size("longest_payload")
        received, sent = self.build.histories
        history = sent if kind in SENT else received
        return max(1, self.fragment) * history - self.size("submessage_header")

    def _fixed(self, kind: MessageKind) -> int:
        """The part of the payload that is not content; all headers together are what the description states as `overhead`."""
        transport = self.middleware.transport
        if transport.states("overhead"):
            return whole_bytes(transport.overhead) - self.headers
        return self.size("object") + (self.size(_EXTRA[kind]) if kind in _EXTRA else 0)

    def _alignment(self, kind: MessageKind) -> int:
        is_aligned = kind in SENT and not self.middleware.transport.states("overhead")
        return max(1, self.size("alignment")) if is_aligned else 1
