"""All that can be changed, by the kind of the object."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any

from amalthea_uros.design.changes import activation, distances, execution_time, scheduling
from amalthea_uros.design.changes.key import (
    CLOCKS,
    ISR_ALLOCATIONS,
    MODE_LABELS,
    PLACEMENTS,
    STRUCTURES,
    TASK_ALLOCATIONS,
    TASKS,
    UNSET,
    ChangeableKind,
    Configuration,
    Key,
    duration,
    field_key,
    one_of,
    positive_frequency,
    positive_number,
    unused,
    whole_number,
)
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.names import require
from amalthea_uros.perf.activities import Activity, Communication, LabelAccess
from amalthea_uros.perf.hardware import Core, Structure
from amalthea_uros.perf.mapping import Placement
from amalthea_uros.perf.software import Preemption
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import sources
from amalthea_uros.units import Frequency, frequency_text, time_text


def _show_memory(configuration: Configuration, label: str) -> str:
    return configuration.system.memory_of.get(label, UNSET)


def _set_memory(configuration: Configuration, label: str, memory: str) -> Configuration:
    """Move a label to another memory, where its address is not known."""
    system = configuration.system
    require("memory", [memory], system.memories)
    if label not in system.memory_of:
        changed = PLACEMENTS.with_item(system, Placement(element=label, memory=memory))
    elif system.memory_of[label] == memory:
        changed = system
    else:
        changed = PLACEMENTS.with_fields(system, label, memory=memory, address=0)
    return configuration._replace(system=changed)


def _show_communication(configuration: Configuration, label: str) -> str:
    """How the accesses communicate; what is not stated counts as implicit, unless the settings say otherwise."""
    accesses = configuration.system.label_accesses.get(label, ())
    return ", ".join(dict.fromkeys(str(each.communication or Communication.IMPLICIT) for each in accesses)) or UNSET


def _set_communication(configuration: Configuration, label: str, communication: Communication) -> Configuration:
    """Change all accesses to a label."""
    system = configuration.system
    if label not in system.label_accesses:
        raise InvalidArgumentError(f"nothing reads or writes the label {label!r}")
    if configuration.settings.communication is not None:
        raise InvalidArgumentError(
            f"all communication is set to {configuration.settings.communication}, so that of {label!r} has no effect; "
            "leave the option --communication out"
        )

    def changed(activity: Activity) -> Activity:
        if isinstance(activity, LabelAccess) and activity.label == label:
            return replace(activity, communication=communication)
        return activity

    return configuration._replace(system=system.with_activities(changed))


_MEMORY_KEY = Key(str, _show_memory, _set_memory)
_LABEL_KEYS: dict[str, Key[Any]] = {
    "memory": _MEMORY_KEY,
    "communication": Key(one_of(Communication), _show_communication, _set_communication),
}


def _show_core_frequency(configuration: Configuration, core: str) -> str:
    system, settings = configuration
    stated = system.frequency_of(system.cores[core].clock) if core in system.cores else None
    frequency = settings.frequencies.get(core) or stated
    return UNSET if frequency is None else frequency_text(frequency)


def _set_core_frequency(configuration: Configuration, core: str, frequency: Frequency) -> Configuration:
    """Change the frequency of one core, or add the only one; other cores with the same clock keep theirs."""
    system, settings = configuration
    refuse_wire(core, system)
    if core not in system.cores:
        ecu = Structure(name=unused(core, (each.name for each in system.hardware.walk())), cores=(Core(name=core),))
        system = STRUCTURES.with_item(system, ecu)
    return Configuration(system, replace(settings, frequencies={**settings.frequencies, core: frequency}))


def _set_clock_frequency(configuration: Configuration, clock: str, frequency: Frequency) -> Configuration:
    for core in configuration.system.cores.values():
        if core.clock == clock:
            refuse_wire(core.name, configuration.system)
    return configuration._replace(system=CLOCKS.with_fields(configuration.system, clock, frequency=frequency))


def refuse_wire(core: str, system: System) -> None:
    """Refuse to scale the times on a wire: those of its driver are not all inversely proportional to the bit rate."""
    if any(core in wire.cores for wire in system.network.wires):
        raise InvalidArgumentError(
            f"{core!r} is a wire, whose times also contain waits of the driver; change the bit rate in the app.yaml"
        )


def _set_mode(configuration: Configuration, mode_label: str, value: str) -> Configuration:
    """Change the initial value of a mode label: one of the literals of its mode, or a number if there are none."""
    system = configuration.system
    mode = MODE_LABELS.find(system, mode_label).mode
    literals = next((each.literals for each in system.software.modes if each.name == mode), ())
    if literals and value not in literals:
        raise InvalidArgumentError(f"{value!r} is not a value of the mode {mode!r}; expected one of {', '.join(literals)}")
    if not literals and not _is_number(value):
        raise InvalidArgumentError(f"{value!r} is not a number, as values of the mode {mode!r} are")
    return configuration._replace(system=MODE_LABELS.with_fields(system, mode_label, initial=value))


def _is_number(text: str) -> bool:
    try:
        Fraction(text)
    except (ValueError, ZeroDivisionError):
        return False
    return True


_TASK_KEYS: Mapping[str, Key[Any]] = {
    **activation.PROCESS_KEYS,
    "execution_time": execution_time.PROCESS_KEY,
    "priority": field_key(TASK_ALLOCATIONS, "priority", whole_number),
    "deadline": field_key(TASK_ALLOCATIONS, "deadline", duration, time_text),
    **scheduling.TASK_KEYS,
    "preemption": field_key(TASKS, "preemption", one_of(Preemption)),
    "activation_limit": field_key(TASKS, "activation_limit", positive_number),
}
_ISR_KEYS: Mapping[str, Key[Any]] = {
    **activation.PROCESS_KEYS,
    "execution_time": execution_time.PROCESS_KEY,
    "priority": field_key(ISR_ALLOCATIONS, "priority", whole_number),
    **scheduling.ISR_KEYS,
}
_CLOCK = field_key(CLOCKS, "frequency", positive_frequency, frequency_text)
_MODE_KEY = Key(str, field_key(MODE_LABELS, "initial", str).show, _set_mode)

#: A model without cores can be given one: by its frequency.
CORE = ChangeableKind(
    "core",
    lambda system: system.cores,
    {"frequency": Key(positive_frequency, _show_core_frequency, _set_core_frequency), "policy": scheduling.CORE_POLICY},
)

#: Where objects of different kinds have the same name, the first kind counts for which the change is possible.
KINDS = (
    ChangeableKind("task", lambda system: [task.name for task in system.software.tasks], _TASK_KEYS),
    ChangeableKind("ISR", lambda system: [isr.name for isr in system.software.isrs], _ISR_KEYS),
    ChangeableKind("runnable", lambda system: system.runnables, {"execution_time": execution_time.RUNNABLE_KEY}),
    # A scheduler can have the name of its core.
    ChangeableKind("scheduler", lambda system: system.schedulers, scheduling.SCHEDULER_KEYS),
    CORE,
    ChangeableKind(
        "clock", lambda system: system.clocks, {"frequency": Key(positive_frequency, _CLOCK.show, _set_clock_frequency)}
    ),
    ChangeableKind(
        "stimulus", lambda system: system.stimuli_by_name, {**activation.STIMULUS_KEYS, "min_distance": distances.MIN_DISTANCE}
    ),
    ChangeableKind("mode label", lambda system: [each.name for each in system.software.mode_labels], {"mode": _MODE_KEY}),
    ChangeableKind("message", sources, activation.MESSAGE_KEYS),
    ChangeableKind("label", lambda system: system.labels, _LABEL_KEYS),
    ChangeableKind("channel", lambda system: system.channels, {"memory": _MEMORY_KEY}),
)

#: Execution times are converted to ticks at the frequency of a core, so those that decide about it are changed before the others.
FIRST_KEYS = ("frequency", "policy", "scheduler", "controller", "core")
