"""XRCE-DDS messages on their way between the controller and the agent: how long they are, and what they cost a CAN bus."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from amalthea_uros.perf.stimuli import Burst, Periodic, Stimulus
from amalthea_uros.spec.middleware import Can, Transport
from amalthea_uros.units import SECOND, DataSize, Time
from amalthea_uros.uros.callbacks import Callback, Message
from amalthea_uros.uros.can import FRAME_BYTES, Bus, Identifier, frames, message_bits, message_time
from amalthea_uros.uros.notes import Notes


@dataclass(frozen=True, slots=True, kw_only=True)
class Traffic:
    """A message on the bus.

    Attributes
    ----------
    length : of the XRCE-DDS message in bytes, with headers
    bus_time : most time that its frames occupy the bus
    share : of the bus time, 1 for all
    """

    message: Message
    incoming: bool
    length: int
    frames: int
    bus_time: Time
    share: Fraction


def bus_of(can: Can) -> Bus:
    """The bus of a description."""
    return Bus(bit_rate=can.bitrate, identifier=Identifier[can.identifier.upper()])


def message_bytes(size: DataSize, transport: Transport) -> int:
    """Length of the XRCE-DDS message that carries so many bits."""
    return -(-(size + transport.overhead) // 8)


def traffic_of(callbacks: Iterable[Callback], transport: Transport) -> tuple[Traffic, ...]:
    """All messages that the callbacks receive and send; none without a CAN bus."""
    if transport.can is None:
        return ()
    bus = bus_of(transport.can)
    found = []
    for callback in callbacks:
        directions = [(callback.incoming, True), *((message, False) for message in callback.outgoing)]
        for message, incoming in directions:
            if message is not None:
                found.append(_traffic(message, incoming, bus, transport))
    return tuple(found)


def _traffic(message: Message, incoming: bool, bus: Bus, transport: Transport) -> Traffic:
    length = message_bytes(message.size, transport)
    return Traffic(
        message=message,
        incoming=incoming,
        length=length,
        frames=frames(length),
        bus_time=message_time(bus, length),
        share=Fraction(message_bits(bus, length) * SECOND, bus.bit_rate * message.interval),
    )


def note_traffic(traffic: Iterable[Traffic], transport: Transport, notes: Notes) -> None:
    """Note a bus that cannot carry all messages."""
    share = float(sum(item.share for item in traffic))
    if share > 1 and transport.can is not None:
        message = f"the messages need up to {share:.0%} of the CAN bus"
        notes.warning("UR131", message, transport.can.location("bitrate"), "Raise the bit rate, or send less often.")


def receive_stimulus(traffic: Traffic, bus: Bus) -> Stimulus:
    """What activates the interrupt of a message: one occurrence per frame, as close as frames without stuff bits can follow."""
    origin, interval = traffic.message.origin, traffic.message.interval
    name = f"frames_of_{traffic.message.callback}"
    if traffic.frames == 1:
        return Periodic(name=name, period=interval, origin=origin)
    distance = SECOND * bus.least_frame_bits(FRAME_BYTES) // bus.bit_rate
    length = distance * traffic.frames
    return Burst(name=name, period=interval, length=length, distance=distance, count=traffic.frames, origin=origin)
