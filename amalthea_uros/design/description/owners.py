"""The sections of a description that have the values of a process, a runnable or a message."""

from __future__ import annotations

from collections.abc import Iterator
from enum import StrEnum

from amalthea_uros._internal.records import dataclass
from amalthea_uros.design.description.text_edits import Path, Value
from amalthea_uros.perf.qualified import qualified_name
from amalthea_uros.spec.application import CallbackSection, MessageCallback, Timer
from amalthea_uros.spec.description import Description, RobotController
from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.spec.section import DescriptionSection
from amalthea_uros.units import Time, time_text
from amalthea_uros.uros.application.callbacks import body_name
from amalthea_uros.uros.assembly.executor_runnables import spin_name

_CALLBACKS = ("subscriptions", "timers", "services", "clients", "guard_conditions", "action_servers", "action_clients")


class OwnerKind(StrEnum):
    """What a section describes."""

    EXECUTOR = "executor"
    TIMER = "timer"
    MESSAGE_CALLBACK = "callback"
    BODY = "runnable of a callback"
    TASK = "task"
    ISR = "interrupt service routine"
    RUNNABLE = "runnable"
    SPIN = "runnable of the executor"
    TAKE = "runnable that takes a message"
    NOTIFY = "runnable that notifies a callback"
    INTERRUPT = "interrupt of the transport"


@dataclass(frozen=True, slots=True)
class Owner:
    """A section, and where it is in the text."""

    name: str
    kind: OwnerKind
    path: Path
    section: DescriptionSection


def owners(description: Description) -> Iterator[Owner]:
    """All sections whose values can be changed; those of a runnable of several processes are several."""
    for place, executor in executors(description):
        yield Owner(executor.name, OwnerKind.EXECUTOR, place, executor)
        yield Owner(spin_name(executor.name), OwnerKind.SPIN, place, executor)
    for path, callback in callbacks(description):
        kind = OwnerKind.TIMER if isinstance(callback, Timer) else OwnerKind.MESSAGE_CALLBACK
        yield Owner(callback.name, kind, path, callback)
        yield Owner(body_name(callback.name), OwnerKind.BODY, path, callback)
        if isinstance(callback, MessageCallback):
            yield Owner(f"Take_{callback.name}", OwnerKind.TAKE, path, callback)
        else:
            yield Owner(f"Notify_{callback.name}", OwnerKind.NOTIFY, path, callback)
    for key, kind in (("tasks", OwnerKind.TASK), ("isrs", OwnerKind.ISR)):
        for index, process in enumerate(getattr(description, key)):
            yield Owner(process.name, kind, (key, index), process)
            if not process.runnables:
                yield Owner(f"{process.name}_Runnable", OwnerKind.RUNNABLE, (key, index), process)
            for number, runnable in enumerate(process.runnables):
                yield Owner(runnable.name, OwnerKind.RUNNABLE, (key, index, "runnables", number), runnable)
    can = description.middleware.transport.can
    if can is not None and can.interrupt is not None:
        path = ("middleware", "transport", "can", "interrupt")
        yield Owner(can.interrupt.name, OwnerKind.INTERRUPT, path, can.interrupt)
        yield Owner(f"{can.interrupt.name}_Frame", OwnerKind.INTERRUPT, path, can.interrupt)


def controllers_of(name: str, description: Description) -> Iterator[tuple[int, RobotController, str]]:
    """The controllers of a robot that can have an object of a name, with their places, and the name of the object there."""
    for index, section in enumerate(description.controllers):
        own = name.removeprefix(qualified_name(section.name, ""))
        if own != name:
            yield index, section, own


def executors(description: Description) -> Iterator[tuple[Path, ExecutorSection]]:
    """All executors with their places."""
    if not description.middleware.executors:
        yield ("middleware", "executor"), description.middleware.executor
    for index, executor in enumerate(description.middleware.executors):
        yield ("middleware", "executors", index), executor


def callbacks(description: Description) -> Iterator[tuple[Path, CallbackSection]]:
    """All callbacks with their places."""
    for index, node in enumerate(description.application.nodes):
        for kind in _CALLBACKS:
            for number, callback in enumerate(getattr(node, kind)):
                yield ("application", "nodes", index, kind, number), callback


@dataclass(frozen=True, slots=True)
class StatedTime:
    """The place of an execution time.

    Attributes
    ----------
    target : the object and the keys, such as "Executor_Task.execution_time.base"
    value : as it is; None if nothing is stated
    elsewhere : what is part of the execution time, but stated elsewhere, such as the time of publishing
    """

    target: str
    path: Path
    value: ExecutionTimeSection | None
    elsewhere: Time = 0

    def bounds(self, lower: Time, upper: Time) -> Value:
        """What is written for a range of whole execution times; ValueError if other parts alone take longer."""
        lower, upper = self._own(lower), self._own(upper)
        return time_text(lower) if lower == upper else {"min": time_text(lower), "max": time_text(upper)}

    def _own(self, time: Time) -> Time:
        if time <= self.elsewhere:
            raise ValueError(f"{time_text(time)} is not longer than the {time_text(self.elsewhere)} of its other parts")
        return time - self.elsewhere
