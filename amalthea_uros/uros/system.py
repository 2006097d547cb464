"""The system of all that has been added to an assembly, in stages: its parts, the network, chains and requirements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from amalthea_uros.perf.constraints import Constraints
from amalthea_uros.perf.events import Events
from amalthea_uros.perf.mapping import Mapping
from amalthea_uros.perf.software import Label, Software
from amalthea_uros.perf.stimuli import Stimuli
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.links import Dataflow
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.chain_members import Topics, chain_elements
from amalthea_uros.uros.chains import ChainBuilder
from amalthea_uros.uros.executors.activation import with_triggered_iterations
from amalthea_uros.uros.executors.handles import deadlines
from amalthea_uros.uros.labels import check_misspelled_labels, labels_of, placements
from amalthea_uros.uros.network.network import PlannedNetwork, with_network
from amalthea_uros.uros.os import check_shared_priorities, isr_allocations, os_of, task_allocations
from amalthea_uros.uros.requirements import requirements
from amalthea_uros.uros.transports.messages import waits_outside


def assembled_system(context: AssemblyContext, callbacks: Sequence[Callback], network: PlannedNetwork | None) -> System:
    """The system of all that has been added to the context."""
    description, notes = context.description, context.notes
    check_misspelled_labels(description, context.runnables, notes)
    labels = labels_of(description, callbacks, context.runnables)
    notes.unique("label or channel", ((item.name, item.origin) for item in (*labels, *context.channels.values())))
    elements = chain_elements(context, callbacks)
    system = with_triggered_iterations(with_network(_without_demands(context, labels), network, context))
    waits = waits_outside(callbacks, system, context.profile)
    system = replace(system, network=replace(system.network, waits=tuple(waits)))
    check_shared_priorities(system, context.tasks, notes, context.priority_scale)
    chains = ChainBuilder(elements, Topics.of(callbacks, system.network), Dataflow(system), notes)
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
            tasks=tuple(planned.task for planned in context.tasks),
            isrs=tuple(planned.isr for planned in context.isrs),
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
