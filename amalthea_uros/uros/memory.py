"""The memory that micro-ROS takes on a board: static memory of the middleware, handles of executors, parameters, and stacks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.perf.hardware import MemoryKind
from amalthea_uros.perf.named import Brief
from amalthea_uros.perf.system import System
from amalthea_uros.spec.application import Application
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.hardware import HardwareSection
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.uros.middleware.profile import MemoryUse, Profile
from amalthea_uros.uros.stacks import StackUse, stacks_of

#: Bytes of a handle, from ros2/rclc rclc/include/rclc/executor_handle.h on a 32-bit target; allocated when the executor is initialised.
_HANDLE = 64
#: Bytes of a parameter server for 7 parameters, measured on an STM32F4: ros2/rclc rclc_parameter/README.md; with low memory second.
_PARAMETERS = (11736, 4160)


@dataclass(frozen=True, slots=True, kw_only=True)
class MemoryDemand(Brief):
    """The memory that micro-ROS takes, and the other tasks of the controller with their stacks.

    Attributes
    ----------
    uses : everything but stacks
    other_stacks : in bytes, of tasks and interrupt service routines that are not part of micro-ROS; 0 if all share their stack
    ram : in bytes, of all memories of the board that can be written at any time; None if none is described
    budget : in bytes, what the platform leaves for it; None if it is not stated
    """

    uses: tuple[MemoryUse, ...]
    stacks: StackUse
    other_stacks: int
    ram: int | None
    budget: int | None

    @property
    def total(self) -> int:
        """In bytes; a lower bound if a size is unknown."""
        return sum(use.size for use in self.uses) + self.stacks.size

    @property
    def limit(self) -> tuple[int, str] | None:
        """The bytes that may be used, and their owner: the budget of the platform, or else the board; None if neither is stated."""
        if self.budget is not None:
            return self.budget, "the budget for micro-ROS"
        return None if self.ram is None else (self.ram, "the board")

    @property
    def counted(self) -> int:
        """The bytes that are compared with the limit: a budget is for micro-ROS alone."""
        return self.total if self.budget is None else self.total - self.other_stacks

    def with_static(self, before: Sequence[MemoryUse], after: Sequence[MemoryUse]) -> MemoryDemand:
        """The memory with other static memory of the middleware."""
        rest = [use for use in self.uses if use not in before]
        return replace(self, uses=(*after, *rest))

    @property
    def is_complete(self) -> bool:
        """Whether all sizes are known."""
        return not self.stacks.unknown and all(use.is_bounded for use in self.uses)


def memory_of(description: Description, hardware: HardwareSection, system: System, profile: Profile) -> MemoryDemand:
    """The memory of an application.

    Parameters
    ----------
    hardware : of the description, completed by its platform
    """
    application, middleware = description.application, description.middleware
    handles = _handles(application, middleware) if application.nodes else ()
    static = profile.memory(application)
    stacks = stacks_of(description, system, profile.threads)
    others = {section.name for section in (*description.tasks, *description.isrs)}
    return MemoryDemand(
        uses=(*(static if application.nodes else ()), *handles, *_parameters(application)),
        stacks=stacks,
        other_stacks=sum(user.size or 0 for user in stacks.users if user.name in others) if not stacks.shared else 0,
        ram=_ram(system),
        budget=None if hardware.ram_budget is None else hardware.ram_budget // 8,
    )


def _handles(application: Application, middleware: Middleware) -> Iterator[MemoryUse]:
    """The handles of executors that state their number."""
    for executor in middleware.stated_executors:
        if executor.max_handles is not None:
            yield MemoryUse(
                name=f"handles of {executor.name}",
                size=executor.max_handles * _HANDLE,
                formula=f"{executor.max_handles} x {_HANDLE} B",
            )


def _parameters(application: Application) -> Iterator[MemoryUse]:
    for node in application.nodes:
        if node.parameter_server is not None:
            size = _PARAMETERS[node.parameter_server.low_memory]
            yield MemoryUse(name=f"parameter server of {node.name}", size=size, formula=f"{size} B, measured for 7 parameters")


def _ram(system: System) -> int | None:
    """The sum of all memories that can be written at any time."""
    sizes = [
        memory.size
        for memory in system.memories.values()
        if memory.kind in (MemoryKind.SRAM, MemoryKind.DRAM) and memory.size is not None
    ]
    return sum(sizes) // 8 if sizes else None
