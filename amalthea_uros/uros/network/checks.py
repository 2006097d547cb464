"""Findings about transports."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import pairwise

from amalthea_uros.perf.executors import Executor
from amalthea_uros.perf.network import Direction, Purpose
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.transports import Can, CanFd, CustomTransport, Driver, Serial
from amalthea_uros.units import SECOND, Time, data_size_text, percent_text, time_text
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.network.queueing import Queued
from amalthea_uros.uros.network.wires import WirePlan
from amalthea_uros.uros.transports.can import GREATEST_STANDARD, SIZES, ForeignFrame
from amalthea_uros.uros.transports.driven import WAITING, SerialLine, bytes_between_reads, steady_time
from amalthea_uros.uros.transports.framing import CHUNK, longest_frame
from amalthea_uros.uros.transports.line import Line, WireSection, wire_sections
from amalthea_uros.uros.transports.messages import WireMessage

#: Baud rates that users advise, from the default on.
_BAUD_RATES = (115_200, 230_400, 460_800, 921_600, 1_000_000, 1_500_000, 2_000_000, 3_000_000)
_BITS_PER_BYTE = 8


def check_transport(description: Description, notes: Notes) -> None:
    """Report what contradicts itself, and drivers whose waiting is unknown."""
    transport = description.middleware.transport
    found = list(wire_sections(transport))
    for key, section in found[1:]:
        text = f"more than one wire is described: {found[0][0]!r} and {key!r}"
        notes.error("APP003", text, section.location(), "Remove all but one.")
    for _, section in found:
        _check_section(section, notes)
        if not isinstance(section, Can | CanFd):
            _check_driver(section.driver, section, description.os.tick, notes)


def _check_section(section: WireSection, notes: Notes) -> None:
    match section:
        case CanFd(bitrate=slow, data_bitrate=fast) if fast < slow:
            text = "'data_bitrate' is lower than 'bitrate'"
            notes.error(
                "APP003", text, section.location("data_bitrate"), "Set the bit rate of the data phase, e.g. '2 Mbit/s'."
            )
        case CustomTransport(table=rows):
            for index, (row, following) in enumerate(pairwise(rows), 1):
                if following.size <= row.size:
                    text = "the sizes in 'table' do not increase"
                    notes.error("APP003", text, section.location("table", index), "Order the rows by size.")
    if isinstance(section, Can | CanFd):
        _check_identifiers(section, notes)


def _check_identifiers(section: Can | CanFd, notes: Notes) -> None:
    """Report identifiers that two messages have, and those with too many bits."""
    first: dict[int, str] = {}
    for name, identifier in section.identifiers.items():
        if isinstance(section, CanFd) and section.identifier == "standard" and identifier > GREATEST_STANDARD:
            text = f"the identifier {identifier:#x} of {name!r} has more than 11 bits"
            notes.error("APP003", text, section.location("identifiers"), "Use a smaller one, or set 'identifier: extended'.")
        first.setdefault(identifier, name)
    longest = SIZES[-1] if isinstance(section, CanFd) else 8
    for frame in section.foreign:
        if frame.bytes > longest:
            text = f"{frame.name!r} has {frame.bytes} data bytes, but a frame on this bus has {longest} at most"
            notes.error("APP003", text, frame.location("bytes"), "Correct the number, or describe the bus under 'can_fd'.")
        if frame.jitter is not None and frame.period is not None and frame.jitter >= frame.period:
            text = f"the jitter of {frame.name!r} is not shorter than its period"
            notes.error("APP003", text, frame.location("jitter"), "Reduce the jitter, or increase the period.")
        if frame.identifier in first:
            text = f"{frame.name!r} has the identifier of {first[frame.identifier]!r}, {frame.identifier:#x}"
            notes.error("APP003", text, frame.location("identifier"), "Frames of different senders need different identifiers.")
        first.setdefault(frame.identifier, frame.name)


def _check_driver(driver: Driver, section: WireSection, tick: Time | None, notes: Notes) -> None:
    known = driver.tick or tick
    if known is None and (driver.write in WAITING or driver.read == "dma"):
        text = "the driver waits in ticks of the operating system, but the tick is not specified"
        notes.warning("UR136", text, driver.location() or section.location(), "Set 'tick' under 'driver' or 'os', e.g. '1 ms'.")
    for key, mode in (("write", driver.write), ("read", driver.read)):
        if mode == "polling":
            text = f"with '{key}: polling', the processor is busy while a message is on the line"
            advice = "Use a driver that waits, e.g. 'dma', if others need the processor in this time."
            notes.info("UR138", text, driver.location(key), advice)
    if driver.read == "interrupt":
        text = "an interrupt-driven read returns at once, so that an executor that waits for messages keeps the processor busy"
        advice = "Give the executor the lowest priority on its core, or use 'read: dma'."
        notes.warning("UR138", text, driver.location("read"), advice)


def check_lengths(messages: Iterable[WireMessage], line: Line, notes: Notes) -> None:
    """Report messages that the transport cannot carry, or that its receive buffer cannot hold, and what writing costs."""
    messages = tuple(messages)
    for message in messages:
        _check_length(message, line, notes)
    driver = line.driver
    if driver is not None:
        _check_buffer(messages, line, driver, notes)
        _check_chunks(messages, line, notes)


def _check_length(message: WireMessage, line: Line, notes: Notes) -> None:
    """Report a message that the transport cannot carry; that best-effort messages are too long for the middleware is reported there."""
    length, topic = max(part.length for part in message.parts), message.message.topic
    is_custom = isinstance(line.section, CustomTransport)
    if line.largest is None or length <= line.largest or not (is_custom or message.message.reliable):
        return
    text = f"{topic!r} needs {length} bytes in one message of the transport, which carries {line.largest} at most"
    row = f"Add a row for {length} B to 'table', or send a smaller message."
    notes.error("UR134", text, message.message.origin, row if is_custom else "Send a smaller message.")


def _check_buffer(messages: Iterable[WireMessage], line: Line, driver: Driver, notes: Notes) -> None:
    if driver.buffer is None:
        return
    size = driver.buffer // _BITS_PER_BYTE
    for message in messages:
        if message.direction is Direction.TO_AGENT:
            continue
        length = max(longest_frame(part.length) if line.is_framed else part.length for part in message.parts)
        if length > size:
            text = f"a message of {message.message.topic!r} can need {length} bytes, more than the receive buffer of {size}"
            advice = f"Set a buffer of {length} B or more; what arrives when it is full is lost."
            notes.warning("UR137", text, driver.location("buffer"), advice)


def _check_chunks(messages: Iterable[WireMessage], line: Line, notes: Notes) -> None:
    """Report a serial line whose driver is slower than its baud rate."""
    if not isinstance(line, SerialLine) or line.driver.write not in WAITING:
        return
    section, tick = line.section, line.driver_tick
    on_line = CHUNK * section.bits_per_byte * SECOND // section.baud_rate
    sent = [message for message in messages if message.direction is Direction.TO_AGENT]
    if tick is not None and sent and tick > on_line:
        longest = max(sent, key=lambda message: message.length)
        chunks = [frame for part in longest.parts for frame in line.frames(part.length, Direction.TO_AGENT) if frame.least]
        time = steady_time(chunks, tick, section.baud_rate)
        text = (
            f"each chunk of {CHUNK} bytes takes a tick of {time_text(tick)}, although it is on the line for less: "
            f"{CHUNK * SECOND // tick:,} bytes per second at most, whatever the baud rate; "
            f"a message of {longest.message.topic!r} takes {time_text(time)} or more, "
            f"so that {float(Fraction(SECOND, time)):.4g} are sent per second at most"
        )
        notes.info("UR135", text, section.driver.location("write"), "Use 'write: blocking', or a shorter tick.")


def check_reading(plan: WirePlan, executors: Iterable[Executor], notes: Notes) -> None:
    """Report a receive buffer that can overflow while the loop of an executor sleeps: nothing reads the line meanwhile.

    The driver writes round the end of its buffer (micro-ROS/micro_ros_stm32cubemx_utils
    `extra_sources/microros_transports/dma_transport.c`), so that the frames in it are destroyed.
    """
    section = plan.line.section
    sleeps = {executor.name: _pause(executor) for executor in executors}
    if not isinstance(section, Serial) or section.driver.buffer is None or not sleeps:
        return
    # Whichever executor waits reads for all of them.
    name = min(sleeps, key=lambda each: sleeps[each])
    size, pause = section.driver.buffer // _BITS_PER_BYTE, sleeps[name]
    on_line = bytes_between_reads(section.baud_rate, section.bits_per_byte, pause)
    count = min(on_line, sum(_bytes_in(pause, each) for each in plan.queued))
    if count > size:
        text = (
            f"up to {count} bytes can arrive while the loop of {name!r} sleeps for {time_text(pause)} and nothing is read, "
            f"more than the receive buffer of {size}"
        )
        advice = f"Sleep for less, or set a buffer of {count} B or more; what is overwritten in it is lost."
        notes.warning("UR139", text, section.driver.location("buffer"), advice)


def _pause(executor: Executor) -> Time:
    """The longest time between two waits in which the thread sleeps."""
    loop = executor.loop
    return loop.sleep or max(0, (loop.period or 0) - loop.timeout)


def _bytes_in(time: Time, queued: Queued) -> int:
    """The most bytes of frames of one kind that arrive in a time, if they are late by up to an interval."""
    if queued.transmission.direction is not Direction.TO_CONTROLLER or not queued.interval:
        return 0
    return max(1, queued.times) * (time // queued.interval + 2) * sum(map(longest_frame, queued.parts))


def check_foreign(frames: Iterable[ForeignFrame], notes: Notes) -> None:
    """Report foreign frames whose rate is not known."""
    for frame in frames:
        if frame.period is None:
            text = f"{frame.name!r} has no cycle time, so that the waiting of all messages of lower priority is unknown"
            advice = f"Describe it under 'foreign', e.g. '{{name: {frame.name}, identifier: {frame.identifier:#x}, period: 100 ms}}'."
            notes.warning("UR133", text, frame.origin, advice)


def check_load(plan: WirePlan, notes: Notes) -> None:
    """Report an overload of a wire, with what would fit."""
    loads = dict(_loads(plan))
    worst = max(loads, key=lambda core: loads[core], default="")
    if not worst or loads[worst] <= 1:
        return
    location = plan.line.section.location(plan.line.rate_key)
    share = f"up to {percent_text(loads[worst], 1)} %"
    if plan.line.key == "can":
        text = f"overload: the messages need {share} of the CAN bus"
        notes.warning("UR131", text, location, "Increase the bit rate, or send fewer or smaller messages.")
        return
    direction = (
        ""
        if not plan.line.is_duplex
        else (" to the controller" if worst == plan.core(Direction.TO_CONTROLLER) else " to the agent")
    )
    text = f"overload: the messages{direction} need {share} of {plan.name!r}"
    notes.warning("UR132", text, location, _advice(plan, worst, loads[worst]))


def _loads(plan: WirePlan, purposes: Iterable[Purpose] = tuple(Purpose)) -> Iterator[tuple[str, Fraction]]:
    """The share of each core that messages of some kinds need, 1 for all of it."""
    counted = set(purposes)
    for core in plan.cores:
        yield (
            core,
            sum(
                (
                    Fraction(
                        each.times * _ticks(plan, each.transmission.name) * SECOND, plan.line.ticks_per_second * each.interval
                    )
                    for each in plan.queued
                    if each.interval is not None
                    and each.transmission.purpose in counted
                    and plan.core(each.transmission.direction) == core
                ),
                Fraction(0),
            ),
        )


def _ticks(plan: WirePlan, name: str) -> int:
    return sum(frame.most for part in plan.frames[name] for frame in part)


def _advice(plan: WirePlan, core: str, load: Fraction) -> str:
    section, choices = plan.line.section, []
    if isinstance(section, Serial):
        waits = section.driver.write in WAITING and core == plan.core(Direction.TO_AGENT)
        fitting = next((rate for rate in _BAUD_RATES if rate > section.baud_rate * load), None)
        if waits:
            choices.append("use a driver that does not wait a tick per chunk, e.g. 'write: blocking'")
        elif fitting is not None:
            choices.append(f"set 'baud_rate: {fitting}'")
    elif isinstance(section, CustomTransport):
        pass
    elif plan.line.is_bus:
        choices.append("increase 'bitrate' or 'data_bitrate'")
    else:
        choices.append(f"use {data_size_text(-(-plan.line.ticks_per_second * load.numerator // load.denominator))}/s or more")
    without = dict(_loads(plan, (Purpose.DATA, Purpose.FOREIGN)))[core]
    if without <= 1 < load:
        choices.append("send with 'reliability: best-effort', as the data without acknowledgements fit")
    choices.append("send fewer or smaller messages")
    advice = "; or ".join(choices)
    return f"{advice[0].upper()}{advice[1:]}."
