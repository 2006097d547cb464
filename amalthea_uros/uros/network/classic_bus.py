"""A classic CAN bus on which nothing in a description depends: its load, its receive interrupt, and the bus as a part of a system.

The bus is a core whose clock is the bit rate, with a task for each message. A frame that is being sent is never interrupted, and before
each frame the pending message of the lowest identifier wins the arbitration. So the tasks are cooperative: between their frames are the
schedule points at which others can go first. Messages with the same identifier, such as those of a client that has only one, are sent
in the order in which they were queued.

The agent sends at any time, but never more often than the description says. The controller sends at the end of callbacks; if one runs
in activations of its own task between two messages, too, it does not publish in these.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import chain

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.activities import Activity, Demand, Execute, SchedulePoint
from amalthea_uros.perf.distributions import Boundaries, Constant
from amalthea_uros.perf.events import Event, RunnableChange, RunnableEvent
from amalthea_uros.perf.hardware import Core
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.software import UNLIMITED, Preemption, Task
from amalthea_uros.perf.stimuli import Burst, Counter, EventTriggered, Periodic, RelativePeriodic, Stimulus
from amalthea_uros.perf.system import System
from amalthea_uros.spec.transports import Can, TransportSection
from amalthea_uros.units import SECOND, Time, percent_text
from amalthea_uros.uros.application.callbacks import Callback, body_name
from amalthea_uros.uros.application.messages import Message
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.assembly.context import AssemblyContext, add_isr
from amalthea_uros.uros.middleware.profile import Profile
from amalthea_uros.uros.network.queueing import runs_per_message
from amalthea_uros.uros.network.wires import WireCores, free_name, with_cores
from amalthea_uros.uros.transports.can import (
    FRAME_BYTES,
    GREATEST_STANDARD,
    CanBus,
    block_bytes,
    bus_of,
    frames,
    max_message_bits,
)
from amalthea_uros.uros.transports.messages import WireMessage, wire_messages

#: The core of the bus, if nothing else has this name.
BUS = "CAN"
#: Greater than all identifiers.
_OF_CLIENT = 2**29


@dataclass(frozen=True, slots=True, kw_only=True)
class BusMessage:
    """A message on the bus.

    Attributes
    ----------
    parts : lengths in bytes, with headers, of the messages of the middleware that it is sent in
    identifier : None: it has the common one of the client
    transmission_time : maximum, of all its frames
    bus_load : maximum share of the bus, 1 for all of it
    """

    message: Message
    parts: tuple[int, ...]
    transmission_time: Time
    bus_load: Fraction
    identifier: int | None = None

    @property
    def name(self) -> str:
        """The name of its task."""
        return self.message.transmission

    @property
    def length(self) -> int:
        """In bytes, with headers."""
        return sum(self.parts)

    @property
    def frames(self) -> int:
        """The number of its frames."""
        return sum(map(frames, self.parts))


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
        message=sent.message,
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
        if can.identifier == "standard" and identifier > GREATEST_STANDARD:
            text = f"the identifier {identifier:#x} of {name!r} has more than 11 bits"
            notes.error("APP003", text, can.location("identifiers"), "Use a smaller one, or set 'identifier: extended'.")


def add_interrupt(context: AssemblyContext, messages: Sequence[BusMessage]) -> None:
    """Add the interrupt service routine that receives frames, if it is described."""
    can = context.description.middleware.transport.can
    incoming = [message for message in messages if message.message.is_incoming]
    if can is None or can.interrupt is None or not incoming:
        return
    bus = bus_of(can)
    stimuli = [context.stimuli.add(_receive_stimulus(message, bus)) for message in incoming]
    add_isr(context, can.interrupt, can.interrupt.name, stimuli)


def _receive_stimulus(received: BusMessage, bus: CanBus) -> Stimulus:
    """The stimulus of the receive interrupt: one activation per frame, at the minimum distance of frames without stuff bits."""
    origin, interval = received.message.origin, received.message.interval
    name = f"frames_of_{received.message.callback}"
    if received.frames == 1:
        return Periodic(name=name, period=interval, origin=origin)
    distance = SECOND * bus.min_frame_bits(FRAME_BYTES) // bus.bit_rate
    length = distance * received.frames
    return Burst(name=name, period=interval, length=length, distance=distance, count=received.frames, origin=origin)


def with_traffic(system: System, bus: CanBus, messages: Iterable[BusMessage]) -> System:
    """The system of an application with its bus, which changes nothing of its other processes.

    Messages without an identifier of their own have the one of the client, which loses against the others: they are sent in the order
    in which they were queued.
    """
    transmissions, events = [], []
    for message in messages:
        name = message.name
        if not message.message.is_incoming:
            events.append(_end_of_callback(message, name))
        transmissions.append(
            BusTransmission(
                name=name,
                frames=[frame for part in message.parts for frame in block_bytes(part)],
                identifier=_OF_CLIENT if message.identifier is None else message.identifier,
                stimulus=_stimulus(message, name, system),
                origin=message.message.origin,
            )
        )
    return with_bus(system, bus, transmissions, events)


def _end_of_callback(message: BusMessage, name: str) -> RunnableEvent:
    return RunnableEvent(name=name, runnable=body_name(message.message.callback), change=RunnableChange.TERMINATE)


def _stimulus(message: BusMessage, name: str, system: System) -> Stimulus:
    interval = message.message.interval
    if message.message.is_incoming:
        return RelativePeriodic(name=name, distance=Constant(interval), has_maximum=False)
    every = runs_per_message(message.message.callback, interval, system)
    return EventTriggered(name=name, events=(name,), counter=Counter(prescaler=every) if every > 1 else None)


@dataclass(frozen=True, slots=True, kw_only=True)
class BusTransmission:
    """A message on the bus.

    Attributes
    ----------
    frames : minimum and maximum number of data bytes of each frame
    identifier : lower numbers win the arbitration
    stimulus : when it is queued
    """

    name: str
    frames: Sequence[tuple[int, int]]
    identifier: int = 0
    stimulus: Stimulus
    origin: Location | None = None


def with_bus(system: System, bus: CanBus, transmissions: Sequence[BusTransmission], events: Iterable[Event] = ()) -> System:
    """A system with a bus and its messages added.

    Parameters
    ----------
    events : to which stimuli of the transmissions refer
    """
    name = free_name(BUS, system)
    lowest = max((each.identifier for each in transmissions), default=0)
    cores = WireCores(
        name=name,
        ticks_per_second=bus.bit_rate,
        cores=(Core(name=name, clock=name),),
        stimuli=tuple(dict.fromkeys(each.stimulus for each in transmissions)),
        tasks=tuple(_task(each, bus) for each in transmissions),
        allocations=tuple(
            TaskAllocation(task=each.name, scheduler=name, priority=lowest - each.identifier) for each in transmissions
        ),
    )
    found = with_cores(system, cores)
    return replace(found, events=replace(system.events, events=(*system.events.events, *events)))


def _task(transmission: BusTransmission, bus: CanBus) -> Task:
    frames = chain.from_iterable((SchedulePoint(), _frame(data, bus)) for data in transmission.frames)
    return Task(
        name=transmission.name,
        stimuli=(transmission.stimulus.name,),
        # The point before the first frame is where its job starts.
        activities=tuple(frames)[1:],
        preemption=Preemption.COOPERATIVE,
        activation_limit=UNLIMITED,
        origin=transmission.origin,
    )


def _frame(data: tuple[int, int], bus: CanBus) -> Activity:
    least, most = data
    bits = Boundaries(lower=bus.min_frame_bits(least), upper=bus.max_frame_bits(most))
    return Execute(demand=Demand(ticks=bits))
