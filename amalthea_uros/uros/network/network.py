"""The network of a description in its system: the wire, what is queued on it, and what receives in the controller."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from itertools import chain, count

from amalthea_uros.perf.network import Purpose
from amalthea_uros.perf.system import System
from amalthea_uros.spec.transports import Can, CanFd
from amalthea_uros.units import Time
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.network.checks import check_foreign, check_lengths, check_load, check_reading, check_transport
from amalthea_uros.uros.network.queueing import Queued, Queueing
from amalthea_uros.uros.network.receiving import Receivers, add_receivers, without_idle
from amalthea_uros.uros.network.wires import WirePlan, with_wire
from amalthea_uros.uros.transports.can_fd import CanFdLine
from amalthea_uros.uros.transports.choice import is_bus, is_in_system, line_of
from amalthea_uros.uros.transports.classic_can import CanLine
from amalthea_uros.uros.transports.foreign import ForeignFrame, arbitration_rank, described_frames, without_own
from amalthea_uros.uros.transports.line import Frame, Line
from amalthea_uros.uros.transports.messages import WireMessage, wire_messages

#: Loses the arbitration against all identifiers.
_OF_CLIENT = 2**31


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedNetwork:
    """The network of an application before its system is complete.

    Attributes
    ----------
    foreign : frames of others on a bus
    """

    line: Line
    messages: tuple[WireMessage, ...]
    receivers: Receivers
    foreign: tuple[ForeignFrame, ...]


def planned_network(
    context: AssemblyContext,
    callbacks: Iterable[Callback],
    *,
    tick: Time | None,
    wakes: Sequence[str],
    database: Sequence[ForeignFrame] = (),
) -> PlannedNetwork | None:
    """The network of an application, whose receiving processes are added; None if no wire is a part of the system.

    Parameters
    ----------
    tick : of the operating system
    wakes : the stimuli of the rounds of executors that wait for messages
    database : frames of others from a database
    """
    description = context.description
    check_transport(description, tick, context.notes)
    line = line_of(description, tick)
    if line is None or not is_in_system(description):
        return None
    messages = tuple(wire_messages(callbacks, context.profile))
    check_lengths(messages, line, context.notes)
    foreign = foreign_frames(line.section, database) if isinstance(line.section, Can | CanFd) else ()
    check_foreign(foreign, context.notes)
    receivers = add_receivers(context, messages, wakes)
    return PlannedNetwork(line=line, messages=messages, receivers=receivers, foreign=foreign)


def foreign_frames(section: Can | CanFd, database: Sequence[ForeignFrame]) -> tuple[ForeignFrame, ...]:
    """The frames of others: those that are described, then those of a database with other names."""
    described = tuple(described_frames(section))
    names = {frame.name for frame in described}
    return (*described, *without_own([frame for frame in database if frame.name not in names], section))


def with_network(system: System, planned: PlannedNetwork | None, context: AssemblyContext) -> System:
    """A system with its network, before chains are added to it; without one, the system itself."""
    if planned is None:
        return system
    middleware = context.description.middleware
    line = planned.line
    queueing = Queueing(
        line=line,
        profile=context.profile,
        system=system,
        receivers=planned.receivers.processes,
    )
    for frame in planned.foreign:
        if frame.name in system.processes:
            context.notes.duplicate("process or frame", frame.name, frame.origin, system.processes[frame.name].origin)
    queued = [*queueing.of(planned.messages), *map(queueing.foreign, planned.foreign)]
    plan = WirePlan(
        line=line,
        name=_free_name(line.name, system),
        queued=queued,
        frames={each.transmission.name: _frames(each, line) for each in queued},
        ranks=_ranks(queued, line),
        is_bus=is_bus(line),
        receivers=planned.receivers,
    )
    check_load(plan, middleware.transport, context.notes)
    check_reading(plan, system.executors, context.notes)
    found = with_wire(system, plan, middleware.agent.name, middleware.transport.loses_messages)
    return without_idle(found, planned.receivers.other_triggers)


def _frames(queued: Queued, line: Line) -> list[Sequence[Frame]]:
    if queued.frame is not None and isinstance(line, CanLine | CanFdLine):
        return [(line.foreign(queued.frame.data_bytes, extended=queued.frame.extended),)]
    return [line.frames(part, queued.transmission.direction) for part in queued.parts]


def _ranks(queued: Iterable[Queued], line: Line) -> dict[str, int]:
    """The order of identifiers, from 0 on; messages without one have that of the client, which loses."""
    found = {each.transmission.name: _rank(each, line) for each in queued}
    dense = {rank: number for number, rank in enumerate(sorted(set(found.values())))}
    return {name: dense[rank] for name, rank in found.items()}


def _rank(queued: Queued, line: Line) -> int:
    if queued.frame is not None:
        return queued.frame.rank
    section = line.section
    if not isinstance(section, Can | CanFd) or queued.transmission.purpose is not Purpose.DATA:
        return _OF_CLIENT
    identifier = section.identifiers.get(queued.channel)
    extended = section.identifier == "extended"
    return _OF_CLIENT if identifier is None else arbitration_rank(identifier, extended=extended)


def _free_name(wanted: str, system: System) -> str:
    """A name for a wire, whose cores, clock, operating system and schedulers begin with it."""
    taken = (*system.cores, *system.clocks, *system.schedulers, *(each.name for each in system.os.systems))
    names = chain([wanted], (f"{wanted}_{number}" for number in count(2)))
    return next(name for name in names if not _is_taken(name, taken))


def _is_taken(name: str, taken: Collection[str]) -> bool:
    return any(other == name or other.startswith(f"{name}_to_") for other in taken)
