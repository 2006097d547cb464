"""Findings about memory: more than the board has, too few slots for received messages, and histories that are deeper than these."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from amalthea_uros._internal.ports import known_ports
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.spec.application import MessageCallback
from amalthea_uros.spec.hardware import HardwareSection
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.memory import MemoryDemand
from amalthea_uros.uros.middleware.checks import depth_of
from amalthea_uros.uros.middleware.options import Option
from amalthea_uros.uros.storage import MessageStorage, storage_of


def check_memory(
    context: AssemblyContext,
    options: Sequence[Option],
    callbacks: Iterable[Callback],
    memory: MemoryDemand,
    hardware: HardwareSection,
) -> None:
    """Report memory that is exceeded, and too little of it for received messages.

    Parameters
    ----------
    options : of the middleware
    memory : with the options of the description
    hardware : of the description, completed by its platform
    """
    findings = context.notes
    storage = storage_of(context.profile, context.description.application, options, memory)
    if storage is not None:
        _check_storage(callbacks, options, storage, findings)
    _check_stacks(context.description.middleware, findings)
    if (exceeded := exceeded_memory(memory, storage, hardware)) is not None:
        findings.add_all([exceeded])


def _check_stacks(middleware: Middleware, findings: Notes) -> None:
    """Report stacks of executors that are smaller than any that the documentation of the port has."""
    port = known_ports().get(middleware.port or "")
    if port is None or port.least_stack is None:
        return
    for executor in middleware.stated_executors:
        if executor.stack is not None and executor.stack < 8 * port.least_stack:
            least = f"no task of {port.title} has less than {port.least_stack} B"
            message = f"the stack of {executor.name!r} has {executor.stack // 8} B, but {least}"
            advice = f"Set {port.least_stack} B or more ({port.references['least_stack']}), or measure what is used."
            findings.warning("UR140", message, executor.location("stack"), advice)


def exceeded_memory(memory: MemoryDemand, storage: MessageStorage | None, hardware: HardwareSection) -> Finding | None:
    """Report memory that exceeds the budget of the platform, or else all that the board has; None if it does not.

    Parameters
    ----------
    hardware : where the description states either of them
    """
    if memory.limit is None or memory.counted <= memory.limit[0]:
        return None
    limit, _ = memory.limit
    needs, key = ("the application", "memories") if memory.budget is None else ("micro-ROS", "ram_budget")
    least = "" if memory.is_complete else "at least "
    source = "the board has" if memory.budget is None else "the budget for it is"
    message = f"{needs} needs {least}{memory.counted} B of memory, but {source} {limit} B"
    largest = max(memory.uses, key=lambda use: use.size, default=None)
    advice = "Reduce the stacks." if largest is None else f"Most of it are {largest.name}: {largest.formula}."
    if storage is not None and largest is not None and largest.size == storage.slots * storage.slot:
        advice = f"{advice} {storage.reduction}"
    return Finding("UR129", Severity.WARNING, message, hardware.location(key), advice)


def _check_storage(callbacks: Iterable[Callback], options: Iterable[Option], storage: MessageStorage, findings: Notes) -> None:
    """Report too few slots for the messages that wait at the same time, and histories that are deeper than the slots of all."""
    for option in options:
        if option.name == storage.option and option.is_exceeded and not option.without_effect:
            _report_too_few(option, storage, findings)
    _report_deep_histories(callbacks, storage, findings)


def _report_too_few(option: Option, storage: MessageStorage, findings: Notes) -> None:
    default = "" if option.is_stated else " by default"
    message = f"{option.name} is {option.available}{default}, but the application needs at least {option.needed}"
    # How many messages wait depends on response times, which are not known here.
    advice = storage.advice(option.needed or 0, "the number that 'amuros generate' computes")
    findings.warning("UR120", message, storage.location, f"{option.when_exhausted} {advice}")


def _report_deep_histories(callbacks: Iterable[Callback], storage: MessageStorage, findings: Notes) -> None:
    by_default = []
    for callback in callbacks:
        depth = depth_of(callback.section)
        if depth is None or depth <= storage.slots:
            continue
        if callback.section.states("depth"):
            few = f"only {storage.slots} can be stored for all callbacks"
            text = f"the history of {callback.name!r} is {depth} messages deep, but {few}"
            advice = storage.advice(depth, "the messages that can wait at the same time, or set a smaller 'depth'")
            findings.warning("UR125", f"{text}: {_effect(callback)}", callback.section.location("depth"), advice)
        elif callback.executor in storage.looping:
            by_default.append(callback)
    if by_default:
        names = ", ".join(repr(callback.name) for callback in by_default)
        text = (
            f"by default, the histories of {names} are deeper than the storage for messages of all callbacks, {storage.slots}"
        )
        advice = storage.advice(0, "the messages that can wait at the same time, or set a smaller 'depth'")
        findings.info("UR125", f"{text}: {_effect(by_default[0])}", storage.location, advice)


def _effect(callback: Callback) -> str:
    """The effect of slots that are used up before the history is full."""
    assert isinstance(callback.section, MessageCallback)
    expected = "the oldest one being overwritten" if callback.section.history == "keep-last" else "more being kept"
    return f"a new message of any topic is dropped instead of {expected}"
