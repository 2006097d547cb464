"""Execution time of the calls of the driver, which is part of what sends or receives a message."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.perf.network import Direction
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.spec.transports import CustomTransport, Driver, Serial, UsbCdc
from amalthea_uros.units import Time
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.middleware.profile import Profile
from amalthea_uros.uros.transports.choice import driver_of, line_of
from amalthea_uros.uros.transports.framing import least_frame, longest_frame, reads
from amalthea_uros.uros.transports.line import Line, time_on
from amalthea_uros.uros.transports.messages import opposite, wire_messages


def driver_costs(
    description: Description, callback: Callback, direction: Direction, profile: Profile
) -> Iterator[ExecutionTimeSection | Time]:
    """The parts of the execution time that the driver needs for the messages of a callback in a direction, and their acknowledgements.

    They are those of its calls, and of copying bytes if it polls.
    """
    line = line_of(description, description.os.tick)
    driver = driver_of(line) if line is not None else None
    if line is None or driver is None:
        return
    messages = wire_messages([callback], profile)
    for part in (part for message in messages if message.direction is direction for part in message.parts):
        yield from _of_part(part.length, direction, line, driver)
        if part.acknowledgement is not None:
            yield from _of_part(part.acknowledgement, opposite(direction), line, driver)


def _of_part(length: int, direction: Direction, line: Line, driver: Driver) -> Iterator[ExecutionTimeSection | Time]:
    """The parts for a message of the middleware; escaped bytes need more calls and time."""
    cost = driver.write_cost if direction is Direction.TO_AGENT else driver.read_cost
    sizes = (least_frame(length), longest_frame(length)) if _is_framed(line) else (length, length)
    if cost.fixed is not None:
        least, most = _calls(sizes, direction, line, length)
        yield from [cost.fixed] * least
        yield from [_between(0, cost.fixed.max) if cost.fixed.max is not None else cost.fixed] * (most - least)
    if cost.per_byte:
        yield _between(cost.per_byte * sizes[0], cost.per_byte * sizes[1])
    if (driver.write if direction is Direction.TO_AGENT else driver.read) == "polling":
        yield _between(*time_on(line, line.frames(length, direction)))


def _between(least: Time, most: Time) -> ExecutionTimeSection | Time:
    return most if least == most else ExecutionTimeSection.model_construct(min=least, max=most)


def _calls(sizes: tuple[int, int], direction: Direction, line: Line, length: int) -> tuple[int, int]:
    """The least and the most calls for a frame."""
    if direction is Direction.TO_AGENT:
        frames = line.frames(length, direction)
        return sum(frame.least > 0 for frame in frames), len(frames)
    return (reads(sizes[0])[0], reads(sizes[1])[1]) if _is_framed(line) else (1, 1)


def _is_framed(line: Line) -> bool:
    section = line.section
    return isinstance(section, Serial | UsbCdc) or (isinstance(section, CustomTransport) and section.framing)
