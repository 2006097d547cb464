"""Systems of small design problems, in ticks of a microsecond; and schedules played tick by tick, which know nothing of the product."""

import json
from collections.abc import Sequence
from dataclasses import replace

from hand_made_systems import chain, of_parts, read, release, request, ticks, write
from support import SHARED

from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.events import Events, ProcessChange, ProcessEvent
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.os import Semaphore
from amalthea_uros.perf.software import Label, Preemption, Task
from amalthea_uros.perf.stimuli import Periodic, RelativePeriodic
from amalthea_uros.perf.system import System
from amalthea_uros.units import MICROSECOND as US

_FILE = SHARED / "vectors" / "design.json"
#: The design problems with their answers; empty where they are not at hand.
DESIGN = json.loads(_FILE.read_text()) if _FILE.exists() else {}


def system_of(
    tasks: Sequence[dict],
    order: Sequence[str] = (),
    *,
    preemptive: bool = True,
    cores: Sequence[str] = ("core",),
    core_of: dict[str, str] | None = None,
    **more,
) -> System:
    """The system of tasks of C, T, D, J, O, locks.

    Parameters
    ----------
    order : names, the most important first; by default the reverse of the tasks, so that it means nothing
    """
    order = order or [task["name"] for task in reversed(tasks)]
    preemption = Preemption.PREEMPTIVE if preemptive else Preemption.NON_PREEMPTIVE
    locks = sorted({lock for task in tasks for lock in task.get("locks", ())})
    return of_parts(
        [
            Task(
                name=task["name"],
                stimuli=(f"every {task['name']}",),
                activities=tuple(_activities(task)),
                preemption=preemption,
                activation_limit=1 + -(-task.get("D", 0) // task["T"]),
            )
            for task in tasks
        ],
        [
            TaskAllocation(
                task=task["name"],
                scheduler=(core_of or {}).get(task["name"], cores[0]),
                priority=len(tasks) - order.index(task["name"]),
                # Counted from the release, which a jitter delays.
                deadline=(task.get("D", task["T"]) - task.get("J", 0)) * US,
            )
            for task in tasks
        ],
        map(_stimulus, tasks),
        cores=cores,
        os_parts={"semaphores": tuple(Semaphore(name=lock, ceiling=True) for lock in locks)},
        **more,
    )


def with_chain(system: System, names: Sequence[str]) -> System:
    """The system with a chain through tasks, each of which reads what the one before it writes."""
    bodies = {task.name: task.activities for task in system.software.tasks}
    for number, name in enumerate(names):
        bodies[name] = (read(f"label {number}"), *bodies[name], write(f"label {number + 1}"))
    events = [ProcessEvent(name=f"{names[0]} starts", process=names[0], change=ProcessChange.START)]
    events += [ProcessEvent(name=f"{name} ends", process=name, change=ProcessChange.TERMINATE) for name in names[1:]]
    labels = tuple(Label(name=f"label {number}") for number in range(len(names) + 1))
    tasks = tuple(replace(task, activities=bodies[task.name]) for task in system.software.tasks)
    software = replace(system.software, labels=labels, tasks=tasks)
    return replace(
        system,
        software=software,
        events=Events(events=tuple(events), chains=(chain("chain", *(event.name for event in events)),)),
    )


def _stimulus(task: dict) -> Periodic | RelativePeriodic:
    """Known releases if there is an offset; otherwise all tasks can be released together, each as late as its jitter allows."""
    name, period, jitter = f"every {task['name']}", task["T"] * US, task.get("J", 0) * US
    if "O" in task:
        return Periodic(name=name, period=period, offset=task["O"] * US)
    if jitter:
        return Periodic(name=name, period=period, offset=-jitter % period, jitter=Boundaries(lower=0, upper=jitter))
    return RelativePeriodic(name=name, distance=Boundaries(lower=period, upper=2 * period), has_maximum=False)


def _activities(task: dict):
    """The sections are nested, the shortest one innermost, so that they are part of the execution time."""
    sections = sorted(task.get("locks", {}).items(), key=lambda section: section[1])
    done = 0
    for lock, _ in reversed(sections):
        yield request(lock)
    for lock, length in sections:
        if length > done:
            yield ticks(length - done)
        yield release(lock)
        done = length
    if task["C"] > done:
        yield ticks(task["C"] - done)
