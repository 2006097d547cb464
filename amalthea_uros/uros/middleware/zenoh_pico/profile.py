"""The profile of zenoh-pico, with rmw_zenoh_pico.

Messages are as src/protocol/codec of eclipse-zenoh/zenoh-pico lays them out, with what rmw_zenoh attaches to each message. Variable
lengths are the longest ones. A message that does not fit into a batch is cut into fragments; the receiver joins them up to
`FRAG_MAX_SIZE`. There are no pools: entities, received messages and fragments are on the heap, without a limit.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import repeat
from pathlib import Path

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.network import Direction
from amalthea_uros.spec.application import Application
from amalthea_uros.units import MILLISECOND, DataSize, Time
from amalthea_uros.uros.application.messages import MessageKind
from amalthea_uros.uros.middleware.options import Option, OptionRow, option_rows
from amalthea_uros.uros.middleware.profile import Heartbeat, MemoryUse, MessagePart, Profile, Sending, whole_bytes

#: In each lease (`Z_TRANSPORT_LEASE_EXPIRE_FACTOR` in CMakeLists.txt of eclipse-zenoh/zenoh-pico).
_KEEP_ALIVES = 3
_MESSAGE = ("push_header", "key", "put_header", "attachment", "encapsulation")
_FRAME = ("frame_header", "sequence_number")
#: Each byte of a length carries 7 bits of it.
_BITS_OF_LENGTH = 7
#: What a message carries besides its content, at most: the encapsulation header of CDR, the attachment of ROS 2 and the headers of a
#: push and a put with numbers of full length (eclipse-zenoh/zenoh-pico src/protocol/codec; esol-community/rmw_zenoh_pico).
_HEADERS = 50
#: Of a serial link, in bytes (eclipse-zenoh/zenoh-pico include/zenoh-pico/system/link/serial.h).
_SERIAL_MTU = 1500
#: rmw_zenoh_pico/src of esol-community/rmw_zenoh_pico: the depth of a history is not enforced.
_HEAP = "not known: entities, fragments, and messages that wait, in any number"


@dataclass(frozen=True, slots=True)
class ZenohPico(Profile):
    """zenoh-pico with rmw_zenoh_pico, whose subscribers put messages into queues for an rclc executor.

    The queues are lists on the heap, without a limit, and nobody keeps messages until they are acknowledged.
    """

    @property
    def sending(self) -> Sending:
        """How messages are sent: the transport acknowledges them, nobody waits for that."""
        how, stated = self.data.sending, self.middleware.reliable.timeout
        return Sending(
            waits=how.waits and self.middleware.reliable.waits,
            timeout=self._value("Z_CONFIG_SOCKET_TIMEOUT") * MILLISECOND if stated is None else stated,
            resends_after=None,
            holds_session_while_waiting=how.holds_session_while_waiting,
            drops_when_busy=how.drops_when_busy,
            is_protected=how.is_protected,
        )

    def heartbeat(self, direction: Direction) -> Heartbeat:
        """Messages that keep the connection alive."""
        interval = self._value("Z_TRANSPORT_LEASE") * MILLISECOND // _KEEP_ALIVES
        return Heartbeat(self.size("heartbeat"), interval, is_answered=False)

    @property
    def option_table(self) -> Mapping[str, OptionRow]:
        """What is known of its build options."""
        return option_rows(Path(__file__).parent)

    def parts(self, kind: MessageKind, content: int, *, reliable: bool) -> Sequence[MessagePart]:
        """What is sent for a message, without the length that precedes it on TCP."""
        frame = sum(map(self.size, _FRAME))
        message = self._overhead(kind, reliable=reliable) + self._length_of_length(content) + content
        if content > self._value("FRAG_MAX_SIZE"):
            return (MessagePart(length=frame + message),)
        piece = max(1, self._value("BATCH_UNICAST_SIZE") - frame)
        full, rest = divmod(message, piece)
        return tuple(MessagePart(length=frame + length) for length in (*repeat(piece, full), *([rest] if rest else [])))

    def times_out_after(self, kind: MessageKind, content: int, *, reliable: bool) -> Time | None:
        """Time after which a sender stops waiting for an acknowledgement, if it does at all."""
        how = self.sending
        return how.timeout if reliable and how.waits else None

    def largest_content(self, kind: MessageKind, *, reliable: bool) -> int:
        """The longest content that can be sent or received."""
        longest = max(0, self._value("FRAG_MAX_SIZE") - self._overhead(kind, reliable=reliable))
        return max(0, longest - self._length_of_length(longest))

    def limiting_options(self, *, reliable: bool) -> Sequence[str]:
        """The build options that limit the content of messages."""
        return ("FRAG_MAX_SIZE",)

    def options(self, application: Application) -> Sequence[Option]:
        """Its build options."""
        longest = max(map(whole_bytes, _received_sizes(application)), default=0)
        needed = {"FRAG_MAX_SIZE": longest + _HEADERS} if longest else {}
        found = []
        for name, row in self.option_table.items():
            stated, available = row.stated(self.middleware.limits), self._available(row)
            if available is not None:
                found.append(Option.of(row, needed=needed.get(name), available=available, is_stated=stated is not None))
        return tuple(found)

    def memory(self, application: Application) -> Sequence[MemoryUse]:
        """The buffers: for sending, a batch but no longer than the link allows; for receiving (src/transport/unicast/transport.c)."""
        batch, transport = self._value("BATCH_UNICAST_SIZE"), self.middleware.transport
        is_serial = transport.serial is not None or transport.usb_cdc is not None
        sent = min(batch, _SERIAL_MTU) if is_serial else batch
        return (
            MemoryUse(name="buffer for sending", size=sent, formula=f"{sent} B"),
            MemoryUse(name="buffer for receiving", size=batch, formula=f"{batch} B"),
            MemoryUse(name="heap", size=0, formula=_HEAP, is_bounded=False),
        )

    def _value(self, name: str) -> int:
        """The value of an option that always has one."""
        available = self._available(self.option_table[name])
        assert available is not None, name
        return available

    def _available(self, row: OptionRow) -> int | None:
        stated = row.stated(self.middleware.limits)
        return self.data.options.get(row.name, row.default) if stated is None else stated

    def _overhead(self, kind: MessageKind, *, reliable: bool) -> int:
        """Everything but the content, its length, and the frame."""
        names = list(_MESSAGE)
        if reliable:
            names.append("quality_of_service")
        if kind not in (MessageKind.PUBLICATION, MessageKind.DELIVERY):
            names.append("query")
        return sum(map(self.size, names))

    def _length_of_length(self, content: int) -> int:
        """Bytes in which the length of a payload is written, with the header of its serialisation."""
        bits = (content + self.size("encapsulation")).bit_length()
        return max(1, -(-bits // _BITS_OF_LENGTH))


def _received_sizes(application: Application) -> Iterator[DataSize]:
    """The sizes of messages that may arrive in fragments."""
    for node in application.nodes:
        yield from (each.message_size for each in node.subscriptions)
        for services in (node.services, node.clients):
            yield from (size for each in services for size in (each.request_size, each.response_size))
