"""What all kinds of wires have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from typing import ClassVar, TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.network import Direction, Span, WireKind
from amalthea_uros.spec.transports import (
    AgentTime,
    Can,
    CanFd,
    CustomTransport,
    Driver,
    Interrupt,
    LatencySection,
    NetworkSection,
    Serial,
    TransportSection,
    UsbCdc,
)
from amalthea_uros.units import SECOND, Time

#: The sections of wires in a description.
WireSection: TypeAlias = Can | CanFd | Serial | NetworkSection | UsbCdc | CustomTransport


@dataclass(frozen=True, slots=True, kw_only=True)
class Frame:
    """What is on a wire without interruption, in ticks of its clock: the least and the most that it can take.

    Attributes
    ----------
    least : 0 if a message can do without it
    weights : how often it takes how many ticks, the least and the most among them; empty if nothing is known of that
    """

    least: int
    most: int
    weights: tuple[tuple[int, int], ...] = ()

    def __post_init__(self) -> None:
        assert 0 <= self.least <= self.most > 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Line(ABC):
    """A wire of some kind.

    Attributes
    ----------
    section : what describes it
    kind : what it is
    key : its key in a description
    rate_key : the key of what limits its load
    name : of its core, or the beginning of those of its two directions
    is_duplex : whether both directions can send at the same time
    is_bus : whether identifiers decide who sends
    keeps_sender : whether a thread that sends waits until its message is on the wire; network stacks and CAN controllers have buffers
    """

    section: WireSection

    kind: ClassVar[WireKind]
    key: ClassVar[str]
    rate_key: ClassVar[str] = "bitrate"
    name: ClassVar[str]
    is_duplex: ClassVar[bool] = False
    is_bus: ClassVar[bool] = False
    keeps_sender: ClassVar[bool] = False

    @property
    @abstractmethod
    def ticks_per_second(self) -> int:
        """Of the clock of its cores."""

    @property
    def driver(self) -> Driver | None:
        """Its driver; a CAN controller has none to describe."""
        return None

    @property
    def is_framed(self) -> bool:
        """Whether the frames of XRCE-DDS for streams of bytes are on it."""
        return False

    @property
    def link(self) -> Span:
        """The time besides that on its core, such as in switches."""
        return Span(most=0)

    @property
    def largest(self) -> int | None:
        """The length of the longest message of the middleware that it can carry, in bytes; None for no limit."""
        return None

    @abstractmethod
    def frames(self, length: int, direction: Direction) -> Sequence[Frame]:
        """What is on the wire for a message of the middleware.

        Parameters
        ----------
        length : in bytes, with the headers of the middleware
        """

    def reading(self, length: int) -> Span:
        """How long the controller waits in its driver for a message, in addition to the time on the wire."""
        return Span(most=0)


def wire_sections(transport: TransportSection) -> Iterator[tuple[str, WireSection]]:
    """The wires of a description by their keys; a valid one has one at most."""
    sections: dict[str, WireSection | None] = {
        "can": transport.can,
        "can_fd": transport.can_fd,
        "serial": transport.serial,
        "udp": transport.udp,
        "tcp": transport.tcp,
        "usb_cdc": transport.usb_cdc,
        "custom": transport.custom,
    }
    yield from ((key, section) for key, section in sections.items() if section is not None)


def describes_wire(transport: TransportSection) -> bool:
    """Whether a description says what the messages are sent on."""
    return any(True for _ in wire_sections(transport))


def receive_interrupt(transport: TransportSection) -> Interrupt | None:
    """The interrupt that receives messages; None if none is described."""
    return next((section.interrupt for _, section in wire_sections(transport) if section.interrupt is not None), None)


def span_of(latency: LatencySection | AgentTime | None) -> Span:
    """A stated latency; one that is not stated has no maximum."""
    if latency is None:
        return Span()
    return Span(least=latency.min, most=latency.max, mean=latency.mean if isinstance(latency, AgentTime) else None)


def time_on(line: Line, frames: Sequence[Frame]) -> tuple[Time, Time]:
    """The least and the most time of frames on a wire: rounded down, and up."""
    least, most = sum(frame.least for frame in frames), sum(frame.most for frame in frames)
    return least * SECOND // line.ticks_per_second, -(-most * SECOND // line.ticks_per_second)
