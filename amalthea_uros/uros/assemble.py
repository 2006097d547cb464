"""From a description to a system."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Finding
from amalthea_uros.perf.named import Brief
from amalthea_uros.perf.system import System
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.hardware import HardwareSection
from amalthea_uros.units import Time
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.assembly.hardware import controller_of
from amalthea_uros.uros.assembly.planned import PriorityScale
from amalthea_uros.uros.chain_members import ChainMembers
from amalthea_uros.uros.initialisation import Initialisation, initialisation
from amalthea_uros.uros.memory import MemoryDemand, memory_of
from amalthea_uros.uros.memory_findings import check_memory
from amalthea_uros.uros.middleware.options import COUNTED, Option
from amalthea_uros.uros.middleware.profile import Profile
from amalthea_uros.uros.network.classic_bus import (
    BusMessage,
    with_traffic,
)
from amalthea_uros.uros.periods import PeriodChoice
from amalthea_uros.uros.processes import add_processes, check_unique_names
from amalthea_uros.uros.profiles import stated_profile
from amalthea_uros.uros.system import assembled_system
from amalthea_uros.uros.transports.can import CanBus, ForeignFrame, bus_of


@dataclass(frozen=True, slots=True, kw_only=True)
class Assembly(Brief):
    """A system, and the decisions and findings of its assembly.

    Attributes
    ----------
    description : what was assembled
    profile : of its middleware
    members : what paths of chains over the system can contain
    choices : the periods of executors without a loop and of the callbacks' tasks, with reasons
    placement : where callbacks run that do not say so, and who decided it; "" without callbacks
    bus, messages : the classic CAN bus, None if there is none, and what is sent on it
    options : build options of the middleware
    memory : what micro-ROS takes of it
    findings : of severity warning and info
    task_periods : those that the middleware offers to tasks; empty if it offers any
    priority_scale : what priorities of tasks mean in the description
    controllers : of a robot, by name; their pools, memory and messages are theirs, not those of the robot
    """

    description: Description
    profile: Profile
    system: System
    members: ChainMembers
    choices: tuple[PeriodChoice, ...]
    placement: str
    messages: tuple[BusMessage, ...]
    bus: CanBus | None
    options: tuple[Option, ...]
    memory: MemoryDemand
    findings: tuple[Finding, ...]
    task_periods: tuple[Time, ...]
    priority_scale: PriorityScale
    controllers: Mapping[str, Assembly] = field(default_factory=dict)

    @property
    def initialisation(self) -> Initialisation | None:
        """The initialisation of its client; None if nothing is known of it, and of a robot, whose controllers have clients."""
        first = next((choice for choice in self.choices if choice.task == choice.executor), None)
        period = None if first is None else first.period
        return None if self.controllers else initialisation(self.description, self.profile, period)

    @property
    def pools(self) -> tuple[Option, ...]:
        """The options that count entities and waiting messages."""
        return tuple(each for each in self.options if each.role in COUNTED and each.needed is not None)

    def system_with_bus(self) -> System | None:
        """The system with its wire as further cores, whose tasks are the messages; None if there is no wire.

        A classic CAN bus is left out of the system if nothing in the description depends on it, and added here.
        """
        if self.system.network.wires:
            return self.system
        return None if self.bus is None else with_traffic(self.system, self.bus, self.messages)


def assemble(
    description: Description,
    hardware: HardwareSection,
    platform: str | None,
    database: Sequence[ForeignFrame] = (),
    assumptions: Sequence[str] = (),
    *,
    is_part: bool = False,
) -> Assembly:
    """The system that a description describes.

    Parameters
    ----------
    hardware : of the description, completed by its platform
    platform : the name that execution times use for the hardware; None if it has none
    database : foreign frames on the CAN bus, from the DBC file that the description names
    assumptions : about measured times in the description, in sentences
    is_part : whether it describes a controller of a robot

    Raises
    ------
    ReadError : the description is contradictory or cannot be implemented; carries all findings.
    """
    notes = Notes()
    check_unique_names(description, notes)
    target = controller_of(description.name, hardware, platform, notes)
    profile = stated_profile(description.middleware, notes)
    if target is None or profile is None:
        raise notes.refusal()
    context = AssemblyContext(
        description=description,
        controller=target,
        notes=notes,
        profile=profile,
        assumptions=tuple(assumptions),
        is_part=is_part,
    )
    assembly = _assembly(context, hardware, database)
    if notes.has_errors:
        raise notes.refusal()
    return assembly


def _assembly(context: AssemblyContext, hardware: HardwareSection, database: Sequence[ForeignFrame]) -> Assembly:
    middleware = context.description.middleware
    options = context.profile.options(context.description.application)
    added = add_processes(context, options, database)
    system, members = assembled_system(context, added.callbacks, added.network)
    memory = memory_of(context.description, hardware, system, context.profile)
    check_memory(context, options, added.callbacks, memory, hardware)
    return Assembly(
        description=context.description,
        profile=context.profile,
        system=system,
        members=members,
        choices=added.choices,
        placement=added.placement,
        messages=added.messages,
        bus=bus_of(middleware.transport.can) if middleware.transport.can is not None else None,
        options=tuple(options),
        memory=memory,
        findings=tuple(context.notes.findings),
        task_periods=tuple(middleware.task_periods),
        priority_scale=context.priority_scale,
    )
