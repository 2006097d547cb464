"""The state of an assembly: the description, and the processes, runnables and stimuli created so far."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.activities import Call, Trigger
from amalthea_uros.perf.executors import Executor
from amalthea_uros.perf.host import Host
from amalthea_uros.perf.software import Channel, Runnable
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.transports import Interrupt
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.assembly.demand import DemandConverter
from amalthea_uros.uros.assembly.hardware import Controller
from amalthea_uros.uros.assembly.planned import (
    PlannedIsr,
    PlannedTask,
    PriorityScale,
    StimulusRegistry,
    activity_sequence,
    priority_scale,
)
from amalthea_uros.uros.middleware.profile import Profile
from amalthea_uros.uros.transports.choice import line_of
from amalthea_uros.uros.transports.line import Line


@dataclass(slots=True, kw_only=True)
class AssemblyContext:
    """A description, and what has been created from it so far.

    Attributes
    ----------
    profile : of the middleware
    runnables : by name, in the order of their creation
    channels : by name, of the messages that the application sends and receives itself
    executors : that spin in loops
    assumptions : about measured times in the description, in sentences
    is_part : whether it describes a controller of a robot
    """

    description: Description
    controller: Controller
    notes: Notes
    profile: Profile
    stimuli: StimulusRegistry = field(default_factory=StimulusRegistry)
    tasks: list[PlannedTask] = field(default_factory=list)
    isrs: list[PlannedIsr] = field(default_factory=list)
    runnables: dict[str, Runnable] = field(default_factory=dict)
    channels: Mapping[str, Channel] = field(default_factory=dict)
    executors: list[Executor] = field(default_factory=list)
    host: Host = field(default_factory=Host)
    assumptions: tuple[str, ...] = ()
    is_part: bool = False

    @property
    def converter(self) -> DemandConverter:
        """Converts execution times to demands on the controller."""
        return DemandConverter(self.controller, self.notes)

    @property
    def processes(self) -> tuple[PlannedTask | PlannedIsr, ...]:
        """The tasks, then the interrupt service routines."""
        return (*self.tasks, *self.isrs)

    @property
    def line(self) -> Line | None:
        """The wire that messages are sent on; None if none is described."""
        return line_of(self.description)

    @property
    def priority_scale(self) -> PriorityScale:
        """What the priorities of the tasks mean."""
        return priority_scale(self.description.os, self.tasks)

    def core(self, name: str | None, location: Location | None) -> str:
        """The core of a name; the first core if there is no name, or no core has it."""
        if name is None:
            return self.controller.first_core
        if name not in self.controller.frequencies:
            self.notes.undefined("core", name, self.controller.frequencies, location)
            return self.controller.first_core
        return name


def add_isr(
    context: AssemblyContext, interrupt: Interrupt, name: str, stimuli: Iterable[str], triggers: Iterable[str] = ()
) -> None:
    """Add an interrupt service routine.

    Parameters
    ----------
    stimuli : that activate it
    triggers : stimuli that it triggers at its end
    """
    section = interrupt if interrupt.core else context.description.middleware.stated_executors[0]
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
