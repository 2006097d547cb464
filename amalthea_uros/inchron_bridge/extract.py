"""An INCHRON project as a system; what is not understood becomes a finding."""

from __future__ import annotations

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.bridge.basics.middleware_flaws import (
    flaw_of_executor,
    flaw_of_host,
    flaw_of_network,
    flaw_of_transmission,
    with_unknown_activation,
)
from amalthea_uros.diagnostics import Finding
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron.project import Project
from amalthea_uros.inchron_bridge.basics.importing import Importing
from amalthea_uros.inchron_bridge.basics.orders import in_kept_order
from amalthea_uros.inchron_bridge.tables.chains_back import EventsReader
from amalthea_uros.inchron_bridge.tables.hardware_back import (
    core_frequency,
    cores_beside,
    extract_hardware,
    loads_of_processors,
)
from amalthea_uros.inchron_bridge.tables.os_back import extract_systems, processes_of
from amalthea_uros.inchron_bridge.tables.requirements_back import extract_constraints
from amalthea_uros.inchron_bridge.tables.software_back import (
    extract_placements,
    extract_semaphores,
    extract_software,
    name_software,
)
from amalthea_uros.inchron_bridge.tables.stimuli_back import StimuliReader
from amalthea_uros.perf.activities import Incomplete
from amalthea_uros.perf.executors import Executor
from amalthea_uros.perf.host import Host
from amalthea_uros.perf.mapping import Mapping, TaskAllocation
from amalthea_uros.perf.network import Network, Transmission
from amalthea_uros.perf.os import OperatingSystem, Os, Overhead, Policy, Scheduler
from amalthea_uros.perf.software import Task
from amalthea_uros.perf.stimuli import ClockFunction, ClockSteps, Custom, Stimuli
from amalthea_uros.perf.system import System

#: Parts of a model that say nothing about the times of what is understood.
_OTHERS = ("busPeripherals", "fmi", "peripheralPortConnections", "spinlocks", "metrics", "typeDefinitions")


@dataclass(frozen=True, slots=True, kw_only=True)
class ProjectExtraction:
    """The system of a project, and what could not be extracted."""

    system: System
    findings: tuple[Finding, ...]


def extract_project(project: Project) -> ProjectExtraction:
    """The system that a project describes."""
    context = Importing(project.model, project)
    system = _system(context, project.model)
    return ProjectExtraction(system=system, findings=(*project.findings, *context.finish()))


def _system(context: Importing, model: ProjectObject) -> System:
    for feature in _OTHERS:
        for item in model[feature] if isinstance(model[feature], list) else [model[feature]] if model[feature] else []:
            context.leave_out(item)
    hardware = extract_hardware(context, model)
    frequencies = {core_frequency(core) for cpu in model["cpus"] for core in cpu["cores"]}
    context.frequency = frequencies.pop() if len(frequencies) == 1 else None
    name_software(context, model)
    stimuli = StimuliReader(context, model)
    stimuli.read()
    for connection in model["connections"]:
        if (name := context.name_of("Stimulus", connection)) is not None:
            context.share("ActivationConnection", connection, name)
    dispatch = extract_systems(context, model)
    software = extract_software(context, model, stimuli.of_process)
    events = EventsReader(context, model)
    events.read()
    constraints = extract_constraints(context, model, events)
    system = System(
        hardware=hardware,
        os=Os(
            systems=tuple(dispatch.systems),
            overheads=context.list_of(model, "overheads", (Overhead,)),
            semaphores=extract_semaphores(context, model),
        ),
        stimuli=Stimuli(stimuli=tuple(stimuli.stimuli), clocks=context.list_of(model, "clocks", (ClockFunction, ClockSteps))),
        software=software,
        mapping=Mapping(
            tasks=tuple(dispatch.tasks),
            isrs=tuple(dispatch.isrs),
            placements=extract_placements(context, model),
        ),
        events=events.events_and_chains(),
        constraints=constraints,
    )
    system = in_kept_order(_with_middleware(system, context, model), context.noted(model))
    return _with_unknown(system, context, [*dispatch.unknown, *loads_of_processors(model)])


def _with_middleware(system: System, context: Importing, model: ProjectObject) -> System:
    """The system with the executors, the network and the host that comments describe; without one of these, their tasks are unknown."""
    parts = {"executor", "transmission"}
    keeping = [each for each in processes_of(model) if parts & context.noted(each).keys() or each in context.damaged]
    network = context.checked(model, "network", Network, lambda each: flaw_of_network(each, system)) or Network()
    host = context.checked(model, "host", Host, flaw_of_host) or Host()
    executors, transmissions = [], []
    for process in keeping:
        origin = context.location(process)
        executor = context.checked(process, "executor", Executor, lambda each: flaw_of_executor(each, system), origin=origin)
        transmission = context.checked(
            process, "transmission", Transmission, lambda each: flaw_of_transmission(each, network, system), origin=origin
        )
        executors += [executor] if executor is not None else []
        transmissions += [transmission] if transmission is not None else []
    found = replace(system, executors=tuple(executors), network=replace(network, transmissions=tuple(transmissions)), host=host)
    unknown = keeping if model in context.damaged else [each for each in keeping if each in context.damaged]
    names = {name for each in unknown if (name := context.name_of("Process", each)) is not None}
    return with_unknown_activation(found, names) if names else found


def _with_unknown(system: System, context: Importing, items: list[ProjectObject]) -> System:
    """The system with a task of unknown demand for each thing that executes something not understood.

    Without it, response times of the others would not include what it takes of their cores: those of the processor that it belongs
    to, or else all.
    """
    for item in items:
        name = context.name("Process", item, f"unknown_{item.kind.rpartition('.')[2]}_{item.name}")
        own = cores_beside(item)
        cores = tuple(system.cores) if own is None else tuple(filter(None, (context.name_of("CpuCore", core) for core in own)))
        stimulus = Custom(name=name, description=f"{item.kind} is not understood")
        task = Task(name=name, stimuli=(name,), activities=(Incomplete(reason=f"{item.kind} {item.name!r} is not understood"),))
        scheduler = Scheduler(name=name, policy=Policy.FIXED_PRIORITY_PREEMPTIVE, cores=cores)
        system = replace(
            system,
            stimuli=replace(system.stimuli, stimuli=(*system.stimuli.stimuli, stimulus)),
            software=replace(system.software, tasks=(*system.software.tasks, task)),
            os=replace(system.os, systems=(*system.os.systems, OperatingSystem(name=name, schedulers=(scheduler,)))),
            mapping=replace(
                system.mapping, tasks=(*system.mapping.tasks, TaskAllocation(task=name, scheduler=name, priority=2**31 - 1))
            ),
        )
    return system
