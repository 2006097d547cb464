"""Processes, functions, variables, modes, events and semaphores."""

from __future__ import annotations

from typing import Any

from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.comments import note
from amalthea_uros.inchron_bridge.basics.exporting import Exporting
from amalthea_uros.inchron_bridge.tables.activities import build_graph
from amalthea_uros.inchron_bridge.tables.conditions import build_condition, whole_number
from amalthea_uros.inchron_bridge.tables.os import GLOBAL, global_system
from amalthea_uros.inchron_bridge.tables.rows import Row
from amalthea_uros.inchron_bridge.tables.stimuli import add_activations, add_conditions
from amalthea_uros.perf import software as perf
from amalthea_uros.perf.activities import Incomplete, LabelAccess, SenderReceiverAccess, called_runnables, walk
from amalthea_uros.perf.os import Semaphore

#: The trace events of each kind of object, with their types where they differ from the names.
OF_ISR = ("Activate", "Start", "Terminate")
OF_TASK = (*OF_ISR, "Block", "Release", "Restart")
OF_FUNCTION = ("Activate", "Entry", "Exit")
OF_DATA = ("read", "write")

TASK = Row(perf.Task, "Process", activation_limit="activationLimit")
ISR = Row(perf.Isr, "Process", ("category",))
RUNNABLE = Row(perf.Runnable, "Function", ("is_overhead", "condition"), callback="callback", service="service")
LABEL = Row(perf.Label, "memory.DataObject", ("constant", "volatile", "protection"))
SEMAPHORE = Row(Semaphore, "Semaphore", ("kind", "ceiling", "ownership"), users="maxValue", initial_users="initialValue")


def trace_events(names: tuple[str, ...]) -> list[ProjectObject]:
    """The events that can be observed of an object."""
    return [ProjectObject("TraceEvent", name=name, type=name.capitalize()) for name in names]


def build_software(context: Exporting) -> None:
    """Make everything that is referred to, without what it does."""
    software = context.system.software
    for task in software.tasks:
        process = TASK.build(task, context, name=task.name, traceEvents=trace_events(OF_TASK))
        process["preemptable"] = task.preemption is perf.Preemption.PREEMPTIVE
        if task.preemption is perf.Preemption.COOPERATIVE:
            context.keep(process, task, "preemption")
        if task.activation_limit < 1:
            process["activationLimit"] = 1
        context.register("Process", task.name, process)
    for isr in software.isrs:
        process = ISR.build(isr, context, name=isr.name, isr=True, traceEvents=trace_events(OF_ISR))
        context.register("Process", isr.name, process)
    for runnable in software.runnables:
        function = RUNNABLE.build(runnable, context, name=runnable.name, traceEvents=trace_events(OF_FUNCTION))
        context.register("Function", runnable.name, function)
    for label in software.labels:
        data = LABEL.build(
            label, context, name=label.name, size=context.size(label.size, label.name), traceEvents=trace_events(OF_DATA)
        )
        if label.size is None:
            note(data, size=None)
        context.register("DataObject", label.name, data)
    for event in software.os_events:
        context.register("Event", event.name, ProjectObject("Event", name=event.name))
    for semaphore in context.system.os.semaphores:
        made = SEMAPHORE.build(semaphore, context, name=semaphore.name)
        context.model.add("semaphores", context.register("Semaphore", semaphore.name, made))
    _build_modes(context)


def _build_modes(context: Exporting) -> None:
    modes = {mode.name: mode for mode in context.system.software.modes}
    for label in context.system.software.mode_labels:
        mode = modes.get(label.mode or "")
        if mode is None:
            context.lost(label, "a mode label without a mode")
            continue
        if mode.literals:
            literals = [ProjectObject("Mode", name=each) for each in mode.literals]
            initial: Any = next((each for each in literals if each.name == label.initial), None)
            made = ProjectObject("ModeGroup", name=label.name, modes=literals, initialMode=initial or literals[0])
        else:
            initial = whole_number(label.initial)
            made = ProjectObject("Counter", name=label.name, initialValue=initial or 0)
        if initial is None:
            # A project always has an initial value; that it is unknown is not the same as the first one.
            note(made, initial=label.initial)
            context.changed(label, "a mode label without a valid initial value", "with the first one, or 0")
        context.model.add(f"global{made.kind}s", context.register(made.kind, label.name, made))
        note(made, mode=mode.name)


def build_graphs(context: Exporting) -> None:
    """Make what processes and functions do, and let stimuli activate the processes, in the order of the importer of INCHRON."""
    software = context.system.software
    processes: tuple[perf.Process, ...] = (*software.isrs, *software.tasks)
    for process in processes:
        add_activations(process, context)
        if len(process.stimuli) > 1:
            note(context.need("Process", process.name, process.name), stimuli=list(process.stimuli))
        _set_graph("Process", process, context)
    for runnable in software.runnables:
        _set_graph("Function", runnable, context)
        if runnable.condition is not None:
            # A function cannot have a condition; the importer of INCHRON writes it beside the function, too.
            build_condition(runnable.condition, context, runnable)
    add_conditions(context)


def _set_graph(kind: str, item: Any, context: Exporting) -> None:
    context.holder = item.name
    context.need(kind, item.name, item.name)["callGraph"] = build_graph(item.activities, context)


def assign_owners(context: Exporting) -> None:
    """Put functions and variables into the component of the first operating system whose processes use them."""
    software, owner = context.system.software, _owners(context)
    for runnable in software.runnables:
        _component(owner.get(("Function", runnable.name)), context).add(
            "functions", context.need("Function", runnable.name, runnable.name)
        )
    for label in software.labels:
        data = context.need("DataObject", label.name, label.name)
        _component(owner.get(("DataObject", label.name)), context).add("variables", data)
        place = context.system.memory_of.get(label.name)
        if place is not None:
            data["memory"] = context.find("memory.Memory", place) or context.find("memory.CacheMemory", place)
    for event in software.os_events:
        system = owner.get(("Event", event.name)) or global_system(context)
        system["rtosConfig"].add("events", context.need("Event", event.name, event.name))


def _component(system: ProjectObject | None, context: Exporting) -> ProjectObject:
    system = system or global_system(context)
    for result in system["components"]:
        return result  # type: ignore[no-any-return]
    is_global = system is context.find("System", GLOBAL)
    return system.add("components", ProjectObject("Component", name=system.name if is_global else f"{system.name}_Component"))


def _owners(context: Exporting) -> dict[tuple[str, str], ProjectObject]:
    """The operating system of each function, variable and event that a process uses, by kind and name.

    What several use is of the first whose process uses it directly, or else of the one of the first function that does, in the order
    in which functions are found: first those of all processes (am2inc, relax.cpp).
    """
    result: dict[tuple[str, str], ProjectObject] = {}
    system = context.system
    waiting = [
        (system.processes[item.name].activities, os)
        for os in context.model["systems"]
        if os.name != GLOBAL
        for item in os.walk()
        if item.kind == "Process"
    ]
    for body, os in waiting:  # Functions that are found are appended.
        for activity in walk(body):
            for event in getattr(activity, "events", ()):
                result.setdefault(("Event", event), os)
            if isinstance(activity, LabelAccess | SenderReceiverAccess | Incomplete) and activity.label is not None:
                result.setdefault(("DataObject", activity.label), os)
        for name in called_runnables(body):
            if name in system.runnables and ("Function", name) not in result:
                result["Function", name] = os
                waiting.append((system.runnables[name].activities, os))
    return result
