"""The interrupt service routine that receives frames."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.perf.activities import Call, Trigger
from amalthea_uros.perf.software import Runnable
from amalthea_uros.spec.transports import Interrupt
from amalthea_uros.uros.application.serving import stated_executors
from amalthea_uros.uros.assembly.activities import activity_sequence
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.assembly.tasks import PlannedIsr


def add_isr(
    context: AssemblyContext, interrupt: Interrupt, name: str, stimuli: Iterable[str], triggers: Iterable[str] = ()
) -> None:
    """Add an interrupt service routine.

    Parameters
    ----------
    stimuli : that activate it
    triggers : stimuli that it triggers at its end
    """
    section = interrupt if interrupt.core else stated_executors(context.description.middleware)[0]
    core = context.core(section.core, section.location("core"))
    handler = Runnable(
        name=f"{interrupt.name}_Frame",
        activities=activity_sequence(context.converter.execute([interrupt.execution_time], core, interrupt.location())),
        origin=interrupt.location(),
    )
    context.runnables[handler.name] = handler
    context.isrs.append(
        PlannedIsr(
            name=name,
            core=core,
            stimuli=tuple(stimuli),
            activities=(Call(runnable=handler.name), *(Trigger(stimulus=stimulus) for stimulus in triggers)),
            priority=interrupt.priority,
            overhead=interrupt.overhead,
            origin=interrupt.location(),
        )
    )
