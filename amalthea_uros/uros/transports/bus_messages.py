"""Messages of the middleware between the controller and the agent: their frames, and the load that they put on the CAN bus."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from amalthea_uros.perf.network import Direction
from amalthea_uros.perf.stimuli import Burst, Periodic, Stimulus
from amalthea_uros.spec.transports import Can, TransportSection
from amalthea_uros.units import SECOND, Time, percent_text
from amalthea_uros.uros.application.callbacks import Callback, Message
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.middleware.profile import Profile
from amalthea_uros.uros.transports.can import FRAME_BYTES, CanBus, Identifier, frames, max_message_bits
from amalthea_uros.uros.transports.messages import WireMessage, wire_messages

#: The greatest identifier of 11 bits.
_GREATEST_STANDARD = 0x7FF


@dataclass(frozen=True, slots=True, kw_only=True)
class BusMessage:
    """A message on the bus.

    Attributes
    ----------
    name : of its task
    parts : lengths in bytes, with headers, of the messages of the middleware that it is sent in
    identifier : None: it has the common one of the client
    transmission_time : maximum, of all its frames
    bus_load : maximum share of the bus, 1 for all of it
    """

    name: str
    message: Message
    incoming: bool
    parts: tuple[int, ...]
    transmission_time: Time
    bus_load: Fraction
    identifier: int | None = None

    @property
    def length(self) -> int:
        """In bytes, with headers."""
        return sum(self.parts)

    @property
    def frames(self) -> int:
        """The number of its frames."""
        return sum(map(frames, self.parts))


def bus_of(can: Can) -> CanBus:
    """The bus of a description."""
    return CanBus(bit_rate=can.bitrate, identifier=Identifier[can.identifier.upper()])


def bus_messages(callbacks: Iterable[Callback], profile: Profile) -> tuple[BusMessage, ...]:
    """All messages that the callbacks receive and send; none without a CAN bus."""
    can = profile.middleware.transport.can
    if can is None:
        return ()
    return tuple(_bus_message(message, can) for message in wire_messages(callbacks, profile))


def _bus_message(sent: WireMessage, can: Can) -> BusMessage:
    bus, parts = bus_of(can), tuple(part.length for part in sent.parts)
    bits = sum(max_message_bits(bus, part) for part in parts)
    return BusMessage(
        name=sent.name,
        message=sent.message,
        incoming=sent.direction is Direction.TO_CONTROLLER,
        parts=parts,
        transmission_time=bus.duration(bits),
        bus_load=Fraction(bits * SECOND, bus.bit_rate * sent.message.interval),
        identifier=can.identifiers.get(sent.message.channel),
    )


def check_bus_load(messages: Iterable[BusMessage], transport: TransportSection, notes: Notes) -> None:
    """Report an overload of the bus."""
    load = float(sum(message.bus_load for message in messages))
    if load > 1 and transport.can is not None:
        text = f"overload: the messages need up to {percent_text(load, 1)} % of the CAN bus"
        advice = "Increase the bit rate, or send fewer or smaller messages."
        notes.warning("UR131", text, transport.can.location("bitrate"), advice)


def check_identifiers(messages: Iterable[BusMessage], transport: TransportSection, notes: Notes) -> None:
    """Report identifiers of messages that do not exist, and those with too many bits."""
    can = transport.can
    if can is None:
        return
    names = {message.message.channel for message in messages}
    for name, identifier in can.identifiers.items():
        if name not in names:
            notes.undefined("message", name, names, can.location("identifiers"))
        if can.identifier == "standard" and identifier > _GREATEST_STANDARD:
            text = f"the identifier {identifier:#x} of {name!r} has more than 11 bits"
            notes.error("APP003", text, can.location("identifiers"), "Use a smaller one, or set 'identifier: extended'.")


def receive_stimulus(received: BusMessage, bus: CanBus) -> Stimulus:
    """The stimulus of the receive interrupt: one activation per frame, at the minimum distance of frames without stuff bits."""
    origin, interval = received.message.origin, received.message.interval
    name = f"frames_of_{received.message.callback}"
    if received.frames == 1:
        return Periodic(name=name, period=interval, origin=origin)
    distance = SECOND * bus.min_frame_bits(FRAME_BYTES) // bus.bit_rate
    length = distance * received.frames
    return Burst(name=name, period=interval, length=length, distance=distance, count=received.frames, origin=origin)
