"""From a description to a system."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import ReadError
from amalthea_uros.perf.constraints import Constraints
from amalthea_uros.perf.events import Events
from amalthea_uros.perf.mapping import Mapping
from amalthea_uros.perf.named import Brief
from amalthea_uros.perf.software import Isr, Label, Software, Task
from amalthea_uros.perf.stimuli import Stimuli
from amalthea_uros.perf.system import System
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.hardware import HardwareSection
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.timing.dataflow.links import Dataflow
from amalthea_uros.units import Time
from amalthea_uros.uros.application.callbacks import Callback, callbacks_of, internal_channels
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.application.serving import placement
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.assembly.hardware import controller_of
from amalthea_uros.uros.assembly.rtos import PriorityScale, check_sleeps
from amalthea_uros.uros.assembly.tasks import PlannedIsr, PlannedTask
from amalthea_uros.uros.background_tasks import add_background_tasks
from amalthea_uros.uros.callback_tasks import add_callbacks, add_interrupt
from amalthea_uros.uros.chain_elements import chain_elements
from amalthea_uros.uros.chain_topics import Topics
from amalthea_uros.uros.chains import Chains
from amalthea_uros.uros.executors.activation import is_triggered, iteration_trigger_name, with_triggered_iterations
from amalthea_uros.uros.executors.handles import deadlines
from amalthea_uros.uros.initialisation import Initialisation, initialisation
from amalthea_uros.uros.labels import check_misspelled_labels, labels_of, placements
from amalthea_uros.uros.memory.ram import MemoryDemand, check_memory, memory_of
from amalthea_uros.uros.middleware.check import check_middleware
from amalthea_uros.uros.middleware.options import Option
from amalthea_uros.uros.middleware.profile import Profile
from amalthea_uros.uros.names import check_unique_data, check_unique_names
from amalthea_uros.uros.network.bus_traffic import with_traffic
from amalthea_uros.uros.network.network import PlannedNetwork, planned_network, with_network
from amalthea_uros.uros.os import isr_allocations, os_of, task_allocations
from amalthea_uros.uros.overheads import add_overheads
from amalthea_uros.uros.periods import PeriodChoice
from amalthea_uros.uros.pools import check_options, pools_of
from amalthea_uros.uros.priorities import check_shared_priorities
from amalthea_uros.uros.profiles import profile_of
from amalthea_uros.uros.requirements import requirements
from amalthea_uros.uros.transports.bus_messages import BusMessage, bus_messages, bus_of, check_bus_load, check_identifiers
from amalthea_uros.uros.transports.can import CanBus
from amalthea_uros.uros.transports.foreign import ForeignFrame
from amalthea_uros.uros.transports.publications import waits_outside


@dataclass(frozen=True, slots=True, kw_only=True)
class Assembly(Brief):
    """A system, and the decisions and findings of its assembly.

    Attributes
    ----------
    description : what was assembled
    profile : of its middleware
    choices : the periods of executors without a loop and of the callbacks' tasks, with reasons
    placement : where callbacks run that do not say so, and who decided it; "" without callbacks
    bus, messages : the classic CAN bus, None if there is none, and what is sent on it
    options : build options of the middleware
    memory : what micro-ROS takes of it
    findings : of severity warning and info
    task_periods : those that the middleware offers to tasks; empty if it offers any
    priority_scale : what priorities of tasks mean in the description
    """

    description: Description
    profile: Profile
    system: System
    choices: tuple[PeriodChoice, ...]
    placement: str
    messages: tuple[BusMessage, ...]
    bus: CanBus | None
    initialisation: Initialisation | None
    options: tuple[Option, ...]
    memory: MemoryDemand
    findings: tuple[Finding, ...]
    task_periods: tuple[Time, ...]
    priority_scale: PriorityScale

    @property
    def pools(self) -> tuple[Option, ...]:
        """The options that count entities and waiting messages."""
        return pools_of(self.options)

    def system_with_bus(self) -> System | None:
        """The system with its wire as further cores, whose tasks are the messages; None if there is no wire.

        A classic CAN bus is left out of the system if nothing in the description depends on it, and added here.
        """
        if self.system.network.wires:
            return self.system
        return None if self.bus is None else with_traffic(self.system, self.bus, self.messages)


def assemble(
    description: Description, hardware: HardwareSection, platform: str | None, database: Sequence[ForeignFrame] = ()
) -> Assembly:
    """The system that a description describes.

    Parameters
    ----------
    hardware : of the description, completed by its platform
    platform : the name that execution times use for the hardware; None if it has none
    database : frames of others on the CAN bus, from the DBC file that the description names

    Raises
    ------
    ReadError : the description is contradictory or cannot be implemented; carries all findings.
    """
    notes = Notes()
    check_unique_names(description, notes)
    target = controller_of(description.name, hardware, platform, notes)
    profile = _profile(description.middleware, notes)
    if target is None or profile is None:
        raise ReadError(notes.findings)
    context = AssemblyContext(description=description, controller=target, notes=notes, profile=profile)
    assembly = _assembly(context, hardware, database)
    if notes.has_errors:
        raise ReadError(notes.findings)
    return assembly


def _profile(middleware: Middleware, notes: Notes) -> Profile | None:
    """The profile of the middleware; None if it is not known."""
    try:
        return profile_of(middleware)
    except ReadError as error:
        notes.findings.extend(error.findings)
        return None


def _assembly(context: AssemblyContext, hardware: HardwareSection, database: Sequence[ForeignFrame]) -> Assembly:
    application, middleware = context.description.application, context.description.middleware
    callbacks = callbacks_of(application, middleware, context.notes)
    messages = bus_messages(callbacks, context.profile)
    check_identifiers(messages, middleware.transport, context.notes)
    options = context.profile.options(application)
    check_options(options, middleware, context.notes)
    check_middleware(callbacks, context.profile, context.notes)
    context.channels = internal_channels(callbacks)
    choices = add_callbacks(context, callbacks)
    network = planned_network(
        context,
        callbacks,
        tick=context.description.os.tick,
        wakes=[iteration_trigger_name(each.name) for each in context.executors if is_triggered(each)],
        database=database,
    )
    if network is None:
        check_bus_load(messages, middleware.transport, context.notes)
        add_interrupt(context, messages)
    add_background_tasks(context)
    add_overheads(context)
    check_sleeps(context.description, context.notes)
    if not context.tasks and not context.isrs and not context.notes.has_errors:
        advice = "Define callbacks under 'application', or tasks under 'tasks'."
        message = "no callback, task or interrupt service routine is defined"
        context.notes.error("APP009", message, context.description.location(), advice)
    system = _system(context, callbacks, network)
    memory = memory_of(context.description, hardware, system, context.profile)
    check_memory(memory, hardware, context.notes)
    response_time = middleware.initialisation.response_time
    first = next((choice for choice in choices if choice.task == choice.executor), None)
    return Assembly(
        description=context.description,
        profile=context.profile,
        system=system,
        choices=choices,
        placement=placement(context.description, context.controller.platform) if callbacks else "",
        messages=messages,
        bus=bus_of(middleware.transport.can) if middleware.transport.can is not None else None,
        initialisation=initialisation(application, first.period, response_time) if first else None,
        options=tuple(options),
        memory=memory,
        findings=tuple(context.notes.findings),
        task_periods=tuple(middleware.task_periods),
        priority_scale=context.priority_scale,
    )


def _system(context: AssemblyContext, callbacks: Sequence[Callback], network: PlannedNetwork | None) -> System:
    """The system of all that has been added to the context."""
    description, notes = context.description, context.notes
    check_misspelled_labels(description, context.runnables, notes)
    labels = labels_of(description, callbacks, context.runnables)
    check_unique_data(labels, context.channels.values(), notes)
    elements = chain_elements(context, callbacks)
    system = with_triggered_iterations(with_network(_without_demands(context, labels), network, context))
    waits = waits_outside(callbacks, system, context.profile)
    system = replace(system, network=replace(system.network, waits=tuple(waits)))
    check_shared_priorities(system, context.tasks, notes, context.priority_scale)
    chains = Chains(elements, Topics.of(callbacks, system.network), Dataflow(system), notes)
    limits = chains.add_all(description.chains)
    demanded = (*requirements(description.requirements, elements, notes), *deadlines(context.executors, callbacks))
    return replace(
        system,
        events=Events(events=tuple(chains.events.values()), chains=tuple(chains.chains.values())),
        constraints=Constraints(constraints=limits, requirements=demanded),
    )


def _without_demands(context: AssemblyContext, labels: Sequence[Label]) -> System:
    """The system without event chains and requirements."""
    return System(
        hardware=context.controller.hardware,
        os=os_of(context),
        stimuli=Stimuli(stimuli=context.stimuli.stimuli),
        software=Software(
            tasks=tuple(map(_task, context.tasks)),
            isrs=tuple(map(_isr, context.isrs)),
            runnables=tuple(context.runnables.values()),
            labels=tuple(labels),
            channels=tuple(context.channels.values()),
        ),
        mapping=Mapping(
            tasks=tuple(task_allocations(context)),
            isrs=tuple(isr_allocations(context)),
            placements=tuple(placements(labels, context.description, context.controller, context.notes)),
        ),
        executors=tuple(context.executors),
    )


def _task(planned: PlannedTask) -> Task:
    return Task(
        name=planned.name,
        stimuli=planned.stimuli,
        activities=planned.activities,
        preemption=planned.preemption,
        activation_limit=planned.activation_limit,
        origin=planned.origin,
    )


def _isr(planned: PlannedIsr) -> Isr:
    return Isr(
        name=planned.name,
        stimuli=planned.stimuli,
        activities=planned.activities,
        category=planned.category,
        origin=planned.origin,
    )
