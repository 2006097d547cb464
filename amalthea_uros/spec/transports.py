"""The transports between the controller and the agent, their drivers, and the agent."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.spec.executors import MessageCost
from amalthea_uros.spec.fields import Limits, entry, examines
from amalthea_uros.spec.losses import LossesSection
from amalthea_uros.spec.os import OverheadSection
from amalthea_uros.spec.section import DescriptionSection, Shorthand
from amalthea_uros.spec.values import (
    BaudRate,
    BitRate,
    CanIdentifier,
    Duration,
    Name,
    OffsetOrNumberZero,
    PayloadOrNothing,
    Priority,
    Size,
    SizeOrNothing,
    described,
    problem,
)


class LatencySection(Shorthand):
    """A time, or a mapping with minimum and maximum."""

    shorthand = ("min", "max")
    plain_value = "The same time in every case."

    min: OffsetOrNumberZero = 0
    """Minimum time."""
    max: OffsetOrNumberZero
    """Maximum time."""

    @examines
    def _is_ordered(self) -> Self:
        if self.min > self.max:
            raise problem("'min' is greater than 'max'")
        return self


class Interrupt(Shorthand):
    """The interrupt service routine that receives a frame: its execution time, or a mapping with more."""

    name: Name = "CAN_Receive"
    """Name of the interrupt service routine."""
    execution_time: ExecutionTimeSection
    """Execution time per frame."""
    priority: Priority = 1
    """Priority among interrupt service routines."""
    core: Name | None = None
    """Core that it runs on; default: the core of the executor."""
    overhead: OverheadSection | None = None
    """Overhead of the operating system per job; default: that of `os`."""
    stack: Size | None = None
    """The most that it uses of the stack that it runs on."""

    shorthand = ("execution_time",)
    plain_value = "Execution time per frame."
    nested = ExecutionTimeSection


class ForeignFrameSection(DescriptionSection):
    """A frame that others send on the bus."""

    name: Name
    """Name of the frame."""
    identifier: CanIdentifier
    """Its identifier; a lower one wins the arbitration."""
    bytes: Annotated[int, Limits(ge=0, le=64)] = 8
    """Data bytes."""
    period: Duration | None = None
    """Minimum time between two of them; default: unknown, so that messages of lower priority have no bound."""
    jitter: Duration | None = None
    """Maximum delay against its nominal time; default: none."""


_FRAME_FORMATS = described(standard="Identifiers of 11 bits.", extended="Identifiers of 29 bits.")


class Can(DescriptionSection):
    """XRCE-DDS over CAN: frames of a header byte and up to 7 bytes of data."""

    bitrate: BitRate
    """Bit rate of the bus."""
    identifier: Annotated[Literal["standard", "extended"], _FRAME_FORMATS] = "standard"
    """`standard`: identifiers of 11 bits; `extended`: 29 bits."""
    identifiers: dict[Name, CanIdentifier] = entry(default_factory=dict)
    """Identifiers of messages, e.g. `{odometry_topic: 0x120, lift_request: 0x80}`; all others have one that loses against these."""
    interrupt: Interrupt | None = None
    """The interrupt for each received frame; if omitted, its cost is part of other execution times."""
    foreign: list[ForeignFrameSection] = entry(default_factory=list)
    """Foreign frames on the same bus."""
    dbc: Name | None = None
    """A DBC file with the foreign frames, relative to this file; those with a cycle time are foreign traffic."""


class CanFd(DescriptionSection):
    """XRCE-DDS over CAN FD, in the official framing: a length byte and up to 63 bytes of one message per frame."""

    bitrate: BitRate
    """Bit rate of the arbitration phase."""
    data_bitrate: BitRate
    """Bit rate of the data phase."""
    identifier: Annotated[Literal["standard", "extended"], _FRAME_FORMATS] = "extended"
    """`standard`: identifiers of 11 bits; `extended`: 29 bits."""
    identifiers: dict[Name, CanIdentifier] = entry(default_factory=dict)
    """Identifiers of messages; all others have one that loses against these."""
    interrupt: Interrupt | None = None
    """The interrupt for each received frame; if omitted, its cost is part of other execution times."""
    foreign: list[ForeignFrameSection] = entry(default_factory=list)
    """Foreign frames on the same bus."""
    dbc: Name | None = None
    """A DBC file with the foreign frames, relative to this file; those with a cycle time are foreign traffic."""


_MODES = described(
    dma="The transfer runs beside the processor; a call waits in ticks of the operating system until it has ended.",
    interrupt="An interrupt per byte; a call waits in ticks of the operating system until the transfer has ended.",
    polling="The processor copies each byte and is busy for the whole transfer.",
    blocking="The calling thread waits without using the processor, and is woken when the transfer has ended.",
)
DriverMode = Annotated[Literal["dma", "interrupt", "polling", "blocking"], _MODES]


class Driver(DescriptionSection):
    """How the driver moves bytes between the middleware and the line."""

    write: DriverMode = "blocking"
    """How a call writes."""
    read: DriverMode = "blocking"
    """How a call reads."""
    tick: Duration | None = None
    """Tick in which its calls wait; default: that of the operating system."""
    write_cost: MessageCost = entry(default_factory=MessageCost.model_construct)
    """Execution time of a write call."""
    read_cost: MessageCost = entry(default_factory=MessageCost.model_construct)
    """Execution time of a read call."""
    buffer: SizeOrNothing | None = None
    """Size of its receive buffer; what arrives when it is full is lost."""


class Serial(DescriptionSection):
    """XRCE-DDS in HDLC frames over a serial line."""

    baud_rate: BaudRate = 115200
    """Symbols per second; each is a bit."""
    bits_per_byte: Annotated[int, Limits(ge=8, le=13)] = 10
    """Bits on the line per byte, with start, stop and parity bits: 10 for 8N1."""
    driver: Driver = entry(default_factory=Driver.model_construct)
    """How the driver moves bytes."""
    interrupt: Interrupt | None = None
    """The interrupt for each received piece; if omitted, its cost is part of other execution times."""


class UsbCdc(DescriptionSection):
    """XRCE-DDS in HDLC frames over a virtual serial port of USB."""

    throughput: BitRate = 12_000_000
    """Bits per second of the bus; default: full speed."""
    latency: LatencySection | None = None
    """Time that the host takes until it polls and passes a packet on, besides its transmission; default: unknown."""
    driver: Driver = entry(default_factory=Driver.model_construct)
    """How the driver moves bytes."""
    interrupt: Interrupt | None = None
    """The interrupt for each received packet."""


class NetworkSection(DescriptionSection):
    """XRCE-DDS over a network."""

    bitrate: BitRate
    """Bit rate of the link of the controller."""
    latency: LatencySection | None = None
    """Time in the network besides the transmission on that link: switches, access points, the stack of the host; default: unknown."""
    overhead: SizeOrNothing | None = None
    """Bytes per packet that are not content: headers of the network, preamble, gap; default: those of Ethernet."""
    driver: Driver = entry(default_factory=Driver.model_construct)
    """How the driver moves packets."""
    interrupt: Interrupt | None = None
    """The interrupt for each received packet."""


class TransferTime(DescriptionSection):
    """A row of a table of transfer times."""

    size: Size
    """Length of a message of the middleware, up to which the row holds."""
    time: LatencySection
    """Time that it takes."""


class CustomTransport(DescriptionSection):
    """A transport that is described by measured transfer times."""

    table: list[TransferTime] = entry(min_length=1)
    """Transfer times by the length of messages; longer ones than in the last row cannot be sent."""
    framing: bool = False
    """Whether messages are framed as on serial lines."""
    driver: Driver = entry(default_factory=Driver.model_construct)
    """How the driver moves bytes."""
    interrupt: Interrupt | None = None
    """The interrupt for each received message."""


class AgentTime(Shorthand):
    """A time, or a mapping with minimum and maximum, or with the mean if the maximum is unknown."""

    shorthand = ("min", "max")
    plain_value = "The same time in every case."

    min: OffsetOrNumberZero = 0
    """Minimum time."""
    max: OffsetOrNumberZero | None = None
    """Maximum time."""
    mean: OffsetOrNumberZero | None = None
    """Mean time, in place of an unknown maximum: a simulation takes it for every message, and no bound follows from it."""

    @examines
    def _is_complete_and_ordered(self) -> Self:
        if (self.max is None) == (self.mean is None):
            raise problem("expected either 'max' or, if it is unknown, 'mean'")
        if self.max is not None and self.min > self.max:
            raise problem("'min' is greater than 'max'")
        if self.mean is not None and self.min > self.mean:
            raise problem("'min' is greater than 'mean'")
        return self


class Agent(DescriptionSection):
    """The agent: a box with stated latencies."""

    name: Name = "Agent"
    """Its name."""
    profile: Name | None = entry(default=None, examples=["pico2w-usb", "./my-agent.yaml"])
    """Measured times: a known profile (`pico2w-usb`, `ra6m5-can-fd`, `ra6m5-uart`, `ra6m5-udp` or `ra6m5-usb`), or a file, e.g.
    `./my-agent.yaml`; what is stated beside it overrides them."""
    to_controller: AgentTime | None = None
    """Time from the publication of a message on the host to its first byte on the wire; default: unknown."""
    to_host: AgentTime | None = None
    """Time from the last byte on the wire until subscribers on the host have the message; default: unknown."""
    acknowledgement: AgentTime | None = None
    """Time from the last byte of a reliable message to the first byte of its acknowledgement; default: unknown."""


class TransportSection(DescriptionSection):
    """The transport between the controller and the agent: exactly one wire."""

    profile: Name | None = entry(default=None, examples=["pico2w-usb", "./my-link.yaml"])
    """The transport of a known profile of measured times (`pico2w-usb`, `ra6m5-can-fd`, `ra6m5-uart`, `ra6m5-udp` or `ra6m5-usb`), or
    of a file, e.g. `./my-link.yaml`; what is stated beside it overrides its values."""
    can: Can | None = None
    """The classic CAN bus, if messages are sent over CAN in blocks of 7 bytes."""
    can_fd: CanFd | None = None
    """The CAN FD bus."""
    serial: Serial | None = None
    """The serial line."""
    udp: NetworkSection | None = None
    """UDP: a message per datagram."""
    tcp: NetworkSection | None = None
    """TCP: a stream of messages with a length before each."""
    usb_cdc: UsbCdc | None = None
    """The virtual serial port of USB."""
    custom: CustomTransport | None = None
    """Another transport."""
    overhead: PayloadOrNothing = 12 * 8
    """Overhead of XRCE-DDS per message: message header, submessage header and object ids; default: 12 B."""
    acknowledgement: Duration | None = None
    """Maximum time until a reliable message is acknowledged."""
    loses_messages: bool = False
    """Whether messages can be lost on the wire, so that reliable ones are sent again."""
    losses: LossesSection | None = None
    """How many messages are lost, as an assumption, e.g. `1 per 10 s` or `0.1 %`; default: unknown if `loses_messages`, else none."""

    @examines
    def _loses_what_is_stated(self) -> Self:
        if self.losses is not None and self.states("loses_messages") and not self.loses_messages:
            raise problem("'losses' are stated, but 'loses_messages' is false")
        return self

    @property
    def is_lossy(self) -> bool:
        """Whether messages can be lost."""
        return self.loses_messages or self.losses is not None


#: The keys of a transport of which it has one.
WIRES = frozenset({"can", "can_fd", "serial", "udp", "tcp", "usb_cdc", "custom"})
