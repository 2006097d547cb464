"""Execution time of the calls of the driver, which is part of what sends or receives a message."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.perf.network import Direction
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.execution_time import ExecutionTime
from amalthea_uros.spec.transports import CustomTransport, Driver, Serial, UsbCdc
from amalthea_uros.units import Time
from amalthea_uros.uros.callbacks import Callback
from amalthea_uros.uros.middleware.load import profile_of
from amalthea_uros.uros.transports.choice import driver_of, line_of
from amalthea_uros.uros.transports.driver import busy_time
from amalthea_uros.uros.transports.framing import longest_frame, reads
from amalthea_uros.uros.transports.line import Line
from amalthea_uros.uros.transports.messages import opposite, wire_messages


def driver_costs(description: Description, callback: Callback, direction: Direction) -> Iterator[ExecutionTime | Time]:
    """The parts of the execution time that the driver needs for the messages of a callback in a direction, and their acknowledgements.

    They are those of its calls, and of copying bytes if it polls.
    """
    line = line_of(description, description.os.tick)
    driver = driver_of(line) if line is not None else None
    if line is None or driver is None:
        return
    middleware = description.middleware
    messages = wire_messages([callback], middleware, profile_of(middleware))
    for part in (part for message in messages if message.direction is direction for part in message.parts):
        yield from _of_part(part.length, direction, line, driver)
        if part.acknowledgement is not None:
            yield from _of_part(part.acknowledgement, opposite(direction), line, driver)


def _of_part(length: int, direction: Direction, line: Line, driver: Driver) -> Iterator[ExecutionTime | Time]:
    cost = driver.write_cost if direction is Direction.TO_AGENT else driver.read_cost
    if cost.fixed is not None:
        yield from [cost.fixed] * _calls(length, direction, line)
    if cost.per_byte:
        yield cost.per_byte * (longest_frame(length) if _is_framed(line) else length)
    if busy := busy_time(line.frames(length, direction), line.ticks_per_second, direction, driver):
        yield busy


def _is_framed(line: Line) -> bool:
    section = line.section
    return isinstance(section, Serial | UsbCdc) or (isinstance(section, CustomTransport) and section.framing)


def _calls(length: int, direction: Direction, line: Line) -> int:
    """The most calls for a message of the middleware."""
    if direction is Direction.TO_AGENT:
        return len(line.frames(length, direction))
    return reads(longest_frame(length))[1] if _is_framed(line) else 1
