"""All that can be changed, by the kind of the object."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any

from amalthea_uros.design.changes import allocation, execution_time, label, message, scheduler, stimulus
from amalthea_uros.design.changes.key import (
    CLOCKS,
    ISR_ALLOCATIONS,
    MODE_LABELS,
    TASK_ALLOCATIONS,
    TASKS,
    UNSET,
    Configuration,
    Key,
    Kind,
    field_key,
)
from amalthea_uros.design.changes.values import duration, one_of, positive_frequency, positive_number, whole_number
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.software import Preemption
from amalthea_uros.timing.activation.phases import sources
from amalthea_uros.timing.scheduling.allocation import frequency_of
from amalthea_uros.units import Frequency, frequency_text, time_text


def _show_core_frequency(configuration: Configuration, core: str) -> str:
    system, settings = configuration
    frequency = settings.frequencies.get(core) or frequency_of(system.cores[core].clock, system)
    return UNSET if frequency is None else frequency_text(frequency)


def _set_core_frequency(configuration: Configuration, core: str, frequency: Frequency) -> Configuration:
    """Change the frequency of one core; other cores with the same clock keep theirs."""
    settings = configuration.settings
    return configuration._replace(settings=replace(settings, frequencies={**settings.frequencies, core: frequency}))


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
    **stimulus.PROCESS_KEYS,
    "execution_time": execution_time.PROCESS_KEY,
    "priority": field_key(TASK_ALLOCATIONS, "priority", whole_number),
    "deadline": field_key(TASK_ALLOCATIONS, "deadline", duration, time_text),
    **allocation.TASK_KEYS,
    "preemption": field_key(TASKS, "preemption", one_of(Preemption)),
    "activation_limit": field_key(TASKS, "activation_limit", positive_number),
}
_ISR_KEYS: Mapping[str, Key[Any]] = {
    **stimulus.PROCESS_KEYS,
    "execution_time": execution_time.PROCESS_KEY,
    "priority": field_key(ISR_ALLOCATIONS, "priority", whole_number),
    **allocation.ISR_KEYS,
}
_MODE_KEY = Key(str, field_key(MODE_LABELS, "initial", str).show, _set_mode)

#: Where objects of different kinds have the same name, the first kind counts for which the change is possible.
KINDS = (
    Kind("task", lambda system: [task.name for task in system.software.tasks], _TASK_KEYS),
    Kind("ISR", lambda system: [isr.name for isr in system.software.isrs], _ISR_KEYS),
    Kind("runnable", lambda system: system.runnables, {"execution_time": execution_time.RUNNABLE_KEY}),
    Kind(
        "core", lambda system: system.cores, {"frequency": Key(positive_frequency, _show_core_frequency, _set_core_frequency)}
    ),
    Kind(
        "clock", lambda system: system.clocks, {"frequency": field_key(CLOCKS, "frequency", positive_frequency, frequency_text)}
    ),
    Kind("scheduler", lambda system: system.schedulers, scheduler.SCHEDULER_KEYS),
    Kind("stimulus", lambda system: system.stimuli_by_name, stimulus.STIMULUS_KEYS),
    Kind("mode label", lambda system: [each.name for each in system.software.mode_labels], {"mode": _MODE_KEY}),
    Kind("message", sources, message.MESSAGE_KEYS),
    Kind("label", lambda system: system.labels, label.LABEL_KEYS),
    Kind("channel", lambda system: system.channels, {"memory": label.MEMORY_KEY}),
)

#: Execution times are converted to ticks at the frequency of a core, so those that decide about it are changed before the others.
FIRST_KEYS = ("frequency", "scheduler", "controller", "core")
