"""XRCE-DDS messages between the controller and the agent: their length, and the load that they put on the CAN bus."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from amalthea_uros.perf.stimuli import Burst, Periodic, Stimulus
from amalthea_uros.spec.transports import Can, Transport
from amalthea_uros.units import SECOND, DataSize, Time
from amalthea_uros.uros.callbacks import Callback, Message
from amalthea_uros.uros.can import FRAME_BYTES, CanBus, Identifier, frames, max_message_bits, transmission_time
from amalthea_uros.uros.notes import Notes

#: The greatest identifier of 11 bits.
_GREATEST_STANDARD = 0x7FF


@dataclass(frozen=True, slots=True, kw_only=True)
class BusMessage:
    """A message on the bus.

    Attributes
    ----------
    length : of the XRCE-DDS message in bytes, with headers
    identifier : None: it has the common one of the client
    transmission_time : maximum, of all its frames
    bus_load : maximum share of the bus, 1 for all of it
    """

    message: Message
    incoming: bool
    length: int
    frames: int
    transmission_time: Time
    bus_load: Fraction
    identifier: int | None = None


def bus_of(can: Can) -> CanBus:
    """The bus of a description."""
    return CanBus(bit_rate=can.bitrate, identifier=Identifier[can.identifier.upper()])


def message_bytes(size: DataSize, transport: Transport) -> int:
    """The length in bytes of the XRCE-DDS message with a payload of a size."""
    return -(-(size + transport.overhead) // 8)


def bus_messages(callbacks: Iterable[Callback], transport: Transport) -> tuple[BusMessage, ...]:
    """All messages that the callbacks receive and send; none without a CAN bus."""
    if transport.can is None:
        return ()
    bus = bus_of(transport.can)
    found = []
    for callback in callbacks:
        if callback.incoming is not None:
            found.append(_bus_message(callback.incoming, True, bus, transport))
        found.extend(_bus_message(message, False, bus, transport) for message in callback.outgoing)
    return tuple(found)


def _bus_message(message: Message, incoming: bool, bus: CanBus, transport: Transport) -> BusMessage:
    length = message_bytes(message.size, transport)
    return BusMessage(
        message=message,
        incoming=incoming,
        length=length,
        frames=frames(length),
        transmission_time=transmission_time(bus, length),
        bus_load=Fraction(max_message_bits(bus, length) * SECOND, bus.bit_rate * message.interval),
        identifier=transport.can.identifiers.get(message.channel) if transport.can is not None else None,
    )


def check_bus_load(messages: Iterable[BusMessage], transport: Transport, notes: Notes) -> None:
    """Report an overload of the bus."""
    load = float(sum(message.bus_load for message in messages))
    if load > 1 and transport.can is not None:
        text = f"overload: the messages need up to {100 * load:.1f} % of the CAN bus"
        advice = "Increase the bit rate, or send fewer or smaller messages."
        notes.warning("UR131", text, transport.can.location("bitrate"), advice)


def check_identifiers(messages: Iterable[BusMessage], transport: Transport, notes: Notes) -> None:
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
