"""Drivers: what moving bytes between the middleware and the line costs the controller.

The modes are those of the transports that micro-ROS delivers. With DMA and interrupts, a write call starts the transfer of a chunk and
asks in each tick whether it has ended (micro-ROS/micro_ros_stm32cubemx_utils `extra_sources/microros_transports/dma_transport.c`), so
that each chunk takes a tick at least, whatever the baud rate; a read call waits a tick, too. Polling copies byte by byte
(micro-ROS/micro_ros_zephyr_module `modules/libmicroros/microros_transports/serial`): the processor is busy for the whole transfer.
Calls that block are woken when the transfer has ended.
"""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.perf.network import Direction, Span
from amalthea_uros.spec.transports import Driver
from amalthea_uros.units import SECOND, Time
from amalthea_uros.uros.transports.line import Frame

#: Modes whose calls wait in ticks.
WAITING = ("dma", "interrupt")


def written(chunks: Sequence[Frame], driver: Driver, tick: Time | None, ticks_per_second: int) -> tuple[Frame, ...]:
    """How long the chunks of a message occupy the driver and the line.

    The first chunk is started at any time within a tick, and its end is seen up to a tick late; each further one is started right after
    a tick, and its time is rounded up to whole ticks. While a writer waits for the tick, nothing else can be written: so this time
    counts as time on the wire.

    Parameters
    ----------
    tick : None if it is unknown; then the waiting is, too, which is reported elsewhere
    """
    if driver.write not in WAITING or tick is None:
        return tuple(chunks)
    period = -(-tick * ticks_per_second // SECOND)
    return tuple(
        Frame(least=chunk.least, most=chunk.most + period if number == 0 else max(1, -(-chunk.most // period)) * period)
        for number, chunk in enumerate(chunks)
    )


def steady_time(chunks: Sequence[Frame], tick: Time, ticks_per_second: int) -> Time:
    """The time of a message whose write calls wait in ticks, if it is written right after the one before."""
    ends = (-(-chunk.least * SECOND // ticks_per_second) for chunk in chunks)
    return sum(max(1, -(-end // tick)) * tick for end in ends)


def read_wait(calls: int, driver: Driver, tick: Time | None) -> Span:
    """How long read calls for a message wait after it has arrived: up to a tick each, if the driver waits in ticks.

    An interrupt-driven read returns at once.
    """
    if driver.read != "dma":
        return Span(most=0)
    return Span(most=None if tick is None else calls * tick)


def busy_time(frames: Sequence[Frame], ticks_per_second: int, direction: Direction, driver: Driver) -> Time:
    """Execution time that moving a message takes: all of the time on the wire if the processor copies each byte, else none."""
    mode = driver.write if direction is Direction.TO_AGENT else driver.read
    return -(-sum(frame.most for frame in frames) * SECOND // ticks_per_second) if mode == "polling" else 0


def bytes_between_reads(baud_rate: int, bits_per_byte: int, gap: Time) -> int:
    """The most bytes that arrive on a serial line in a time in which nothing is read; a smaller buffer overflows."""
    return -(-gap * baud_rate // (bits_per_byte * SECOND))
