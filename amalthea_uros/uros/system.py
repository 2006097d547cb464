"""The system of all that has been added to an assembly, in stages: its parts, the network, chains and requirements."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from amalthea_uros._internal.similar import Suggestions
from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.activities import AccessKind, LabelAccess, walk
from amalthea_uros.perf.mapping import Mapping, Placement
from amalthea_uros.perf.software import Label, Software
from amalthea_uros.perf.stimuli import Stimuli
from amalthea_uros.perf.system import System
from amalthea_uros.units import DataSize
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.chain_members import ChainMembers, Topics, chain_elements
from amalthea_uros.uros.demands import with_demands
from amalthea_uros.uros.executors.activation import with_triggered_iterations
from amalthea_uros.uros.executors.handles import deadlines
from amalthea_uros.uros.missing_wires import check_wires
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
    check_wires(members, [members], system, notes)
    system = with_demands(system, members, description, notes)
    demanded = (*system.constraints.requirements, *deadlines(context.executors, callbacks))
    return AssembledSystem(replace(system, constraints=replace(system.constraints, requirements=demanded)), members)


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
