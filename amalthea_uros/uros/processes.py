"""The processes of a description in stages: callbacks and executors, what receives messages, tasks, and the operating system."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from amalthea_uros.diagnostics import Location
from amalthea_uros.spec.description import Description
from amalthea_uros.uros.application.callbacks import Callback, callbacks_of, internal_channels, sections_of
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.application.serving import placement
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.background_tasks import add_background_tasks
from amalthea_uros.uros.callback_tasks import add_callbacks
from amalthea_uros.uros.executors.activation import is_triggered, iteration_trigger_name
from amalthea_uros.uros.executors.loop_items import loop_callbacks
from amalthea_uros.uros.executors.sleeps import check_sleeps
from amalthea_uros.uros.executors.threads import names_of_loops
from amalthea_uros.uros.host import host_of
from amalthea_uros.uros.middleware.checks import check_middleware
from amalthea_uros.uros.middleware.options import Option, check_options
from amalthea_uros.uros.network.classic_bus import BusMessage, add_interrupt, bus_messages, check_bus_load, check_identifiers
from amalthea_uros.uros.network.network import PlannedNetwork, planned_network
from amalthea_uros.uros.overheads import add_overheads
from amalthea_uros.uros.periods import PeriodChoice
from amalthea_uros.uros.transports.can import ForeignFrame
from amalthea_uros.uros.transports.line import receive_interrupt


def check_unique_names(description: Description, notes: Notes) -> None:
    """Report processes, callbacks and nodes that share a name."""
    nodes = description.application.nodes
    notes.unique("node", ((node.name, node.location("name")) for node in nodes))
    notes.unique("process", _names(description))


def _names(description: Description) -> Iterator[tuple[str, Location | None]]:
    nodes = description.application.nodes
    if nodes:
        for executor in description.middleware.stated_executors:
            yield executor.name, executor.location("name")
        yield from names_of_loops(description.middleware)
        if (interrupt := receive_interrupt(description.middleware.transport)) is not None:
            yield interrupt.name, interrupt.location("name")
    for process in (*description.tasks, *description.isrs):
        yield process.name, process.location("name")
    for callback in (callback for node in nodes for _, callback in sections_of(node)):
        yield callback.name, callback.location("name")


class AddedProcesses(NamedTuple):
    """What the processes of a description come from.

    Attributes
    ----------
    messages : on the classic CAN bus, if there is one
    choices : the periods of executors without a loop and of the callbacks' tasks
    placement : where callbacks run that do not say so, and who decided it; "" without callbacks
    network : None if no wire is a part of the system
    """

    callbacks: Sequence[Callback]
    messages: tuple[BusMessage, ...]
    choices: tuple[PeriodChoice, ...]
    placement: str
    network: PlannedNetwork | None


def add_processes(context: AssemblyContext, options: Sequence[Option], database: Sequence[ForeignFrame]) -> AddedProcesses:
    """Add all processes of a description, with findings about the application, its middleware and its transport.

    Parameters
    ----------
    options : build options of the middleware
    database : foreign frames on the CAN bus
    """
    description, notes = context.description, context.notes
    middleware = description.middleware
    own = callbacks_of(description.application, middleware, notes)
    callbacks = (*own, *loop_callbacks(description, context.profile, notes))
    messages = bus_messages(callbacks, context.profile)
    check_identifiers(messages, middleware.transport, notes)
    check_options(options, middleware, notes)
    check_middleware(callbacks, context.profile, notes)
    context.channels = internal_channels(callbacks)
    context.host = host_of(description.host, description.application.nodes, notes)
    choices = add_callbacks(context, callbacks)
    wakes = [iteration_trigger_name(each.name) for each in context.executors if is_triggered(each)]
    network = planned_network(context, callbacks, wakes, database)
    if network is None:
        check_bus_load(messages, middleware.transport, notes)
        add_interrupt(context, messages)
    add_background_tasks(context)
    add_overheads(context)
    check_sleeps(description, notes)
    if not context.processes and description.host is None and not notes.has_errors:
        advice = "Define callbacks under 'application', or tasks under 'tasks'."
        message = "no callback, task or interrupt service routine is defined"
        notes.error("APP009", message, description.location(), advice)
    where = placement(description, context.controller.platform) if callbacks else ""
    return AddedProcesses(callbacks, messages, choices, where, network)
