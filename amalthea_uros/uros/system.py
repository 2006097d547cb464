"""The system of all that has been added to an assembly, in stages: its parts, the network, chains and requirements."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from collections.abc import Mapping as AbstractMapping
from dataclasses import replace
from typing import NamedTuple

from amalthea_uros._internal.similar import Suggestions
from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.activities import AccessKind, LabelAccess, walk
from amalthea_uros.perf.constraints import (
    Bound,
    JitterLimit,
    Limit,
    Requirement,
    RequirementSeverity,
    TimeLimit,
    TimeMetric,
)
from amalthea_uros.perf.events import Events
from amalthea_uros.perf.mapping import Mapping, Placement
from amalthea_uros.perf.software import Label, Software
from amalthea_uros.perf.stimuli import Stimuli
from amalthea_uros.perf.system import System
from amalthea_uros.spec import requirements as spec
from amalthea_uros.spec.description import Description
from amalthea_uros.timing.dataflow.links import Dataflow
from amalthea_uros.units import DataSize
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.chain_members import ChainElement, ChainMembers, Topics, chain_elements
from amalthea_uros.uros.chains import ChainBuilder
from amalthea_uros.uros.executors.activation import with_triggered_iterations
from amalthea_uros.uros.executors.handles import deadlines
from amalthea_uros.uros.network.network import PlannedNetwork, with_network
from amalthea_uros.uros.os import check_shared_priorities, isr_allocations, os_of, task_allocations
from amalthea_uros.uros.transports.messages import waits_outside


class AssembledSystem(NamedTuple):
    """A system, and what paths of chains over it can contain."""

    system: System
    members: ChainMembers


def assembled_system(
    context: AssemblyContext, callbacks: Sequence[Callback], network: PlannedNetwork | None
) -> AssembledSystem:
    """The system of all that has been added to the context."""
    description, notes = context.description, context.notes
    _check_misspelled_labels(context)
    labels = _labels(context, callbacks)
    notes.unique("label or channel", ((item.name, item.origin) for item in (*labels, *context.channels.values())))
    elements = chain_elements(context, callbacks)
    system = with_triggered_iterations(with_network(_without_demands(context, labels), network, context))
    waits = waits_outside(callbacks, system, context.profile)
    system = replace(system, network=replace(system.network, waits=tuple(waits)))
    check_shared_priorities(system, context.tasks, notes, context.priority_scale)
    members = ChainMembers(elements, Topics.of(callbacks, system.network))
    system = with_demands(system, members, description, notes)
    demanded = (*system.constraints.requirements, *deadlines(context.executors, callbacks))
    return AssembledSystem(replace(system, constraints=replace(system.constraints, requirements=demanded)), members)


def with_demands(system: System, members: ChainMembers, description: Description, problems: Notes) -> System:
    """A system with the chains and requirements of a description, besides those that it has."""
    known = {each.name: each for each in system.events.events}
    chains = ChainBuilder(members.elements, members.topics, Dataflow(system), problems, events=known)
    limits = chains.add_all(description.chains)
    demanded = tuple(_requirements(description.requirements, members.elements, problems))
    constraints = system.constraints
    return replace(
        system,
        events=Events(events=tuple(chains.events.values()), chains=(*system.events.chains, *chains.chains.values())),
        constraints=replace(
            constraints,
            constraints=(*constraints.constraints, *limits),
            requirements=(*constraints.requirements, *demanded),
        ),
    )


def _without_demands(context: AssemblyContext, labels: Sequence[Label]) -> System:
    """The system without event chains and requirements."""
    return System(
        hardware=context.controller.hardware,
        os=os_of(context),
        stimuli=Stimuli(stimuli=context.stimuli.stimuli),
        software=Software(
            tasks=tuple(planned.task for planned in context.tasks),
            isrs=tuple(planned.isr for planned in context.isrs),
            runnables=tuple(context.runnables.values()),
            labels=tuple(labels),
            channels=tuple(context.channels.values()),
        ),
        mapping=Mapping(
            tasks=tuple(task_allocations(context)),
            isrs=tuple(isr_allocations(context)),
            placements=tuple(_placements(labels, context)),
        ),
        executors=tuple(context.executors),
        host=context.host,
    )


def _labels(context: AssemblyContext, callbacks: Sequence[Callback]) -> tuple[Label, ...]:
    """All labels that are defined or accessed; one that is only accessed has the size of a word."""
    sizes = {name: (label.size, label.location()) for name, label in context.description.labels.items()}
    for callback in callbacks:
        if callback.buffer is not None and callback.incoming is not None:
            sizes.setdefault(callback.buffer, (callback.incoming.size, callback.origin))
    for access, origin in _accesses(context):
        sizes.setdefault(access.label, (_WORD, origin))
    return tuple(Label(name=name, size=size, origin=origin) for name, (size, origin) in sizes.items())


_WORD: DataSize = 32


def _accesses(context: AssemblyContext) -> Iterator[tuple[LabelAccess, Location | None]]:
    for runnable in context.runnables.values():
        for activity in walk(runnable.activities):
            if isinstance(activity, LabelAccess):
                yield activity, runnable.origin


def _placements(labels: Iterable[Label], context: AssemblyContext) -> Iterator[Placement]:
    """The memory of each label."""
    controller = context.controller
    for label in labels:
        section = context.description.labels.get(label.name)
        memory = section.memory if section and section.memory else controller.label_memory
        if section and section.memory and section.memory not in controller.memories:
            context.notes.undefined("memory", section.memory, controller.memories, section.location("memory"))
        elif memory is not None:
            yield Placement(element=label.name, memory=memory)


def _check_misspelled_labels(context: AssemblyContext) -> None:
    """Report labels that are only read and whose name is similar to one that is only written: probably a typing error."""
    readers: dict[str, Location | None] = {}
    written = set()
    for access, origin in _accesses(context):
        if access.kind is AccessKind.READ:
            readers.setdefault(access.label, origin)
        else:
            written.add(access.label)
    suggestions, defined = Suggestions(), context.description.labels.keys()
    for name, origin in readers.items():
        if name in written or name in defined:
            continue
        if near := suggestions.nearest(name, written - readers.keys() - defined, cutoff=0.8):
            message = f"label {name!r} is read but never written, and {near!r} is written but never read"
            context.notes.warning("APP008", message, origin, f"Did you mean {near!r}? If not, define both under 'labels'.")


_METRICS = {
    "response_time": TimeMetric.RESPONSE_TIME,
    "net_execution_time": TimeMetric.NET_EXECUTION_TIME,
    "gross_execution_time": TimeMetric.GROSS_EXECUTION_TIME,
    "start_delay": TimeMetric.START_DELAY,
    "start_to_start": TimeMetric.START_TO_START,
    "end_to_end": TimeMetric.END_TO_END,
}


def _requirements(
    sections: Iterable[spec.RequirementSection], elements: AbstractMapping[str, ChainElement], notes: Notes
) -> Iterator[Requirement]:
    """The requirements of the description, one for each limit."""
    for section in sections:
        element = elements.get(section.process)
        if element is None:
            notes.undefined("process or runnable", section.process, elements, section.location("process"))
            continue
        yield from _limits(section, element)


def _limits(section: spec.RequirementSection, element: ChainElement) -> Iterator[Requirement]:
    for name, limit, origin in _stated(section):
        yield Requirement(
            name=name,
            process=element.process if element.runnable is None else None,
            runnable=element.runnable,
            limit=limit,
            severity=RequirementSeverity(section.severity) if section.severity else None,
            origin=origin,
        )


def _stated(section: spec.RequirementSection) -> Iterator[tuple[str, Limit, Location | None]]:
    """Each limit with its name, which all limits of one requirement can share, and where it is stated."""
    for key, metric in _METRICS.items():
        limits: spec.LimitsSection | None = getattr(section, key)
        if limits is None:
            continue
        name = section.name or f"{section.process}_{key}"
        if limits.max is not None:
            yield name, TimeLimit(metric=metric, value=limits.max), limits.location()
        if limits.min is not None:
            yield f"{name}_least", TimeLimit(metric=metric, value=limits.min, bound=Bound.LOWER), limits.location()
    if section.jitter is not None:
        name = section.name or f"{section.process}_{section.jitter.of}_jitter"
        yield name, JitterLimit(metric=_METRICS[section.jitter.of], value=section.jitter.max), section.jitter.location()
