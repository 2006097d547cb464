"""Description -> system: everything of this room put together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import ReadError
from amalthea_uros.perf.constraints import Constraints
from amalthea_uros.perf.events import Events
from amalthea_uros.perf.mapping import Mapping
from amalthea_uros.perf.software import Isr, Software, Task
from amalthea_uros.perf.stimuli import Stimuli
from amalthea_uros.perf.system import System
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.hardware import Hardware
from amalthea_uros.uros.application import add_callbacks, add_interrupt
from amalthea_uros.uros.callbacks import Callback, callbacks_of
from amalthea_uros.uros.chains import Chains
from amalthea_uros.uros.hardware import controller
from amalthea_uros.uros.initialisation import Initialisation, initialisation
from amalthea_uros.uros.load import add_load
from amalthea_uros.uros.members import members_of
from amalthea_uros.uros.memory import labels_of, note_slips, placements
from amalthea_uros.uros.names import check_names
from amalthea_uros.uros.notes import Notes
from amalthea_uros.uros.os import isr_allocations, os_of, task_allocations
from amalthea_uros.uros.periods import Choice
from amalthea_uros.uros.pools import Pool, check, pools_of
from amalthea_uros.uros.requirements import requirements
from amalthea_uros.uros.streams import check_streams
from amalthea_uros.uros.tasks import PlannedIsr, PlannedTask
from amalthea_uros.uros.work import Work
from amalthea_uros.uros.xrce import Traffic, note_traffic, traffic_of


@dataclass(frozen=True, slots=True, kw_only=True)
class Assembly:
    """A system, and what was decided and found out on the way.

    Attributes
    ----------
    choices : the periods of the executor and of the callbacks' tasks, with reasons
    traffic : the messages on the CAN bus
    pools : static pools of the middleware
    findings : warnings and notes
    """

    system: System
    choices: tuple[Choice, ...]
    traffic: tuple[Traffic, ...]
    initialisation: Initialisation | None
    pools: tuple[Pool, ...]
    findings: tuple[Finding, ...]


def assemble(description: Description, hardware: Hardware, platform: str | None) -> Assembly:
    """The system that a description describes.

    Parameters
    ----------
    hardware : that of the description, completed by its platform
    platform : the name of that platform, by which execution times refer to it

    Raises
    ------
    ReadError : the description contradicts itself, or something in it is impossible; carries all findings.
    """
    notes = Notes()
    check_names(description, notes)
    ground = controller(description.name, hardware, platform, notes)
    if ground is None:
        raise ReadError(notes.findings)
    assembly = _assembly(Work(description=description, controller=ground, notes=notes))
    if notes.has_errors:
        raise ReadError(notes.findings)
    return assembly


def _assembly(work: Work) -> Assembly:
    application, middleware = work.description.application, work.description.middleware
    callbacks = callbacks_of(application, middleware.executor, work.notes)
    traffic = traffic_of(callbacks, middleware.transport)
    note_traffic(traffic, middleware.transport, work.notes)
    pools = pools_of(application, middleware)
    check(pools, callbacks, middleware, work.notes)
    check_streams(callbacks, middleware, work.notes)
    choices = add_callbacks(work, callbacks)
    add_interrupt(work, traffic)
    add_load(work)
    if not work.tasks and not work.isrs and not work.notes.has_errors:
        advice = "Give callbacks under 'application', or 'tasks'."
        work.notes.error("APP009", "there is nothing that runs", work.description.location(), advice)
    system = _system(work, callbacks)
    response_time = middleware.initialisation.response_time
    return Assembly(
        system=system,
        choices=choices,
        traffic=traffic,
        initialisation=initialisation(application, choices[0].period, response_time) if choices else None,
        pools=pools,
        findings=tuple(work.notes.findings),
    )


def _system(work: Work, callbacks: Sequence[Callback]) -> System:
    """The system of everything that came together."""
    description, notes = work.description, work.notes
    note_slips(description, work.runnables, notes)
    labels = labels_of(description, callbacks, work.runnables)
    members = members_of(work, callbacks)
    chains = Chains(members, frozenset(label.name for label in labels), notes)
    limits = chains.add_all(description.chains)
    return System(
        hardware=work.controller.hardware,
        os=os_of(work),
        stimuli=Stimuli(stimuli=work.pool.stimuli),
        software=Software(
            tasks=tuple(map(_task, work.tasks)),
            isrs=tuple(map(_isr, work.isrs)),
            runnables=tuple(work.runnables.values()),
            labels=labels,
        ),
        mapping=Mapping(
            tasks=tuple(task_allocations(work)),
            isrs=tuple(isr_allocations(work)),
            placements=tuple(placements(labels, description, work.controller, notes)),
        ),
        events=Events(events=tuple(chains.events.values()), chains=tuple(chains.chains.values())),
        constraints=Constraints(constraints=limits, requirements=tuple(requirements(description.requirements, members, notes))),
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
