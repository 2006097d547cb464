"""A system as the kernel plays it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from amalthea_uros.simulate.arrivals import Occurrences
from amalthea_uros.simulate.program.chains import FollowedRoute
from amalthea_uros.simulate.program.watches import Source
from amalthea_uros.simulate.sampling.streams import Stream
from amalthea_uros.trace.table import Entity


@dataclass(frozen=True, slots=True)
class Program:
    """A system as the kernel plays it.

    Attributes
    ----------
    memory : of the kernel, at time 0
    units : time units per picosecond
    streams, stream_records : what is drawn from, and the records by which programs know it
    arrivals : of each stimulus that comes from outside: its record, and when it occurs
    processes : the names of the processes in the order of their numbers in rows
    records, cores, channels : the records of processes, cores and channels, by name
    messages : the queues of messages with arrivals of their own, by process and source
    queues : the records of everything that is activated
    sources : of events that are watched, in the order of their numbers in rows
    runnables : that are measured, in the order of their numbers in rows, which follow those of the processes
    left_out : why a process is not simulated
    chains_left_out : why a chain is not followed
    """

    memory: list[int]
    units: int
    streams: Sequence[Stream]
    stream_records: Sequence[int]
    arrivals: Sequence[tuple[int, Occurrences]]
    processes: tuple[str, ...]
    records: dict[str, int]
    cores: dict[str, int]
    channels: dict[str, int]
    messages: dict[tuple[str, str], int]
    queues: tuple[int, ...]
    entities: tuple[Entity, ...]
    routes: tuple[FollowedRoute, ...]
    sources: tuple[Source, ...]
    runnables: tuple[str, ...]
    left_out: dict[str, str]
    chains_left_out: dict[str, str]
