"""Messages of which it is not known how often the host sends them: nothing is known of what they activate.

What activates the processes becomes a stimulus without a meaning, so that the reason reaches everything that depends on them.
"""

from __future__ import annotations

from dataclasses import replace

from amalthea_uros.perf.activities import Call, walk
from amalthea_uros.perf.network import Transmission
from amalthea_uros.perf.software import Task
from amalthea_uros.perf.stimuli import Custom
from amalthea_uros.perf.system import System


def with_unknown_times(system: System, transmission: Transmission, reason: str, described: System) -> System:
    """The system in which it is unknown how often a message comes.

    Parameters
    ----------
    described : the system as it is described: with the sources of counters, and the same tasks
    """
    affected = {task.name for task in described.software.tasks if _is_activated(task, transmission, system)}
    stimulus = Custom(name=_name(transmission), description=reason)
    tasks = tuple(replace(task, stimuli=(stimulus.name,)) if task.name in affected else task for task in system.software.tasks)
    return replace(
        system,
        software=replace(system.software, tasks=tasks),
        stimuli=replace(system.stimuli, stimuli=(*system.stimuli.stimuli, stimulus)),
    )


def why_unknown(transmission: Transmission, system: System) -> str:
    """Why it is unknown how often a message comes; "" if it is not."""
    stimulus = system.stimuli_by_name.get(_name(transmission))
    return stimulus.description if isinstance(stimulus, Custom) else ""


def _name(transmission: Transmission) -> str:
    return f"unknown times of {transmission.name}"


def _is_activated(task: Task, transmission: Transmission, system: System) -> bool:
    """Whether a task is the message on its wire, or executes its callback as often as is stated, outside of loops."""
    if task.name == transmission.name:
        return True
    if task.name in system.executor_of_task or transmission.callback is None:
        return False
    counters = (each.counter for each in walk(task.activities) if isinstance(each, Call))
    return task.name == transmission.callback or any(
        counter is not None and counter.source == transmission.callback for counter in counters
    )
