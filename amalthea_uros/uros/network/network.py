"""The network of a description in its system: the wire, what is queued on it, and what receives in the controller."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.network import Direction, Losses
from amalthea_uros.perf.system import System
from amalthea_uros.spec.application import Application
from amalthea_uros.spec.losses import LossesSection
from amalthea_uros.spec.transports import Can, CanFd
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.network.checks import check_foreign, check_lengths, check_load, check_reading, check_transport
from amalthea_uros.uros.network.queueing import Queueing
from amalthea_uros.uros.network.receiving import Receivers, add_receivers, without_idle
from amalthea_uros.uros.network.wires import WirePlan, free_name, with_wire
from amalthea_uros.uros.transports.can import ForeignFrame, described_frames, without_own
from amalthea_uros.uros.transports.choice import is_in_system
from amalthea_uros.uros.transports.line import Line
from amalthea_uros.uros.transports.messages import WireMessage, wire_messages


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedNetwork:
    """The network of an application before its system is complete.

    Attributes
    ----------
    foreign : frames on a bus that other devices send
    """

    line: Line
    messages: tuple[WireMessage, ...]
    receivers: Receivers
    foreign: tuple[ForeignFrame, ...]


def planned_network(
    context: AssemblyContext,
    callbacks: Iterable[Callback],
    wakes: Sequence[str],
    database: Sequence[ForeignFrame],
) -> PlannedNetwork | None:
    """The network of an application, whose receiving processes are added; None if no wire is a part of the system.

    Parameters
    ----------
    wakes : the stimuli of the rounds of executors that wait for messages
    database : foreign frames from a database
    """
    description = context.description
    check_transport(description, context.notes)
    line = context.line
    if line is None or not (context.is_part or is_in_system(description)):
        return None
    messages = tuple(wire_messages(callbacks, context.profile))
    check_lengths(messages, line, context.notes)
    foreign = foreign_frames(line.section, database) if isinstance(line.section, Can | CanFd) else ()
    check_foreign(foreign, context.notes)
    receivers = add_receivers(context, messages, wakes)
    return PlannedNetwork(line=line, messages=messages, receivers=receivers, foreign=foreign)


def foreign_frames(section: Can | CanFd, database: Sequence[ForeignFrame]) -> tuple[ForeignFrame, ...]:
    """The foreign frames: those that are described, then those of a database with other names."""
    described = tuple(described_frames(section))
    names = {frame.name for frame in described}
    return (*described, *without_own([frame for frame in database if frame.name not in names], section))


def stated_losses(section: LossesSection | None) -> Iterator[Losses]:
    """The losses of a wire."""
    if section is None:
        return
    rates = (
        (section.both, tuple(Direction)),
        (section.to_controller, (Direction.TO_CONTROLLER,)),
        (section.to_agent, (Direction.TO_AGENT,)),
    )
    for rate, directions in rates:
        if rate is not None:
            yield Losses(directions=directions, count=rate.count, window=rate.window, per_billion=rate.per_billion)


def with_network(system: System, planned: PlannedNetwork | None, context: AssemblyContext) -> System:
    """A system with its network, before chains are added to it; without one, the system itself."""
    if planned is None:
        return system
    middleware = context.description.middleware
    queueing = Queueing(line=planned.line, profile=context.profile, system=system, receivers=planned.receivers.processes)
    for frame in planned.foreign:
        if frame.name in system.processes:
            context.notes.duplicate("process or frame", frame.name, frame.origin, system.processes[frame.name].origin)
    queued = [*queueing.of(planned.messages), *map(queueing.foreign, planned.foreign)]
    plan = WirePlan(
        line=planned.line,
        name=free_name(planned.line.name, system),
        queued=queued,
        receivers=planned.receivers,
        loses_messages=middleware.transport.is_lossy,
        losses=tuple(stated_losses(middleware.transport.losses)),
        recovery=context.profile.recovery if any(each.transmission.acknowledges for each in queued) else None,
        origin=middleware.transport.location() or middleware.location(),
    )
    check_load(plan, context.notes)
    check_reading(plan, system.executors, context.notes)
    left_out = _not_on_wire(context.description.application, plan.name)
    found = with_wire(system, plan, middleware.agent.name, (*context.assumptions, *plan.assumptions, *left_out))
    return without_idle(found, planned.receivers.other_triggers)


def _not_on_wire(application: Application, wire: str) -> Iterator[str]:
    """Sentences about messages of the middleware that are sent besides those whose sizes are described."""
    nodes = application.nodes
    if any(node.action_servers or node.action_clients for node in nodes):
        more = "acceptances and cancellations of goals, requests for results and the status"
        yield f"of actions, {wire!r} carries goals, results and the feedback of servers; {more} need no time on it"
    if any(node.parameter_server or node.lifecycle for node in nodes):
        yield f"requests to parameter servers and lifecycle nodes, and their responses, need no time on {wire!r}"
