"""Processes, functions, variables, modes, events and semaphores of a project."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.importing import Importing
from amalthea_uros.inchron_bridge.basics.orders import in_order
from amalthea_uros.inchron_bridge.basics.values import size_of
from amalthea_uros.inchron_bridge.tables.activities_back import extract_graph
from amalthea_uros.inchron_bridge.tables.os_back import processes_of
from amalthea_uros.inchron_bridge.tables.software import ISR, LABEL, RUNNABLE, SEMAPHORE, TASK
from amalthea_uros.perf import software as perf
from amalthea_uros.perf.activities import Incomplete
from amalthea_uros.perf.mapping import Placement
from amalthea_uros.perf.os import Semaphore


def name_software(context: Importing, model: ProjectObject) -> None:
    """Give names to everything that is referred to."""
    for process in processes_of(model):
        context.name("Process", process)
    for item in model.walk():
        if item.kind in ("Function", "memory.DataObject", "Event", "Semaphore"):
            context.name(item.kind.rpartition(".")[2], item)
        elif item.kind in ("ModeGroup", "Counter"):
            # Both become mode labels, whose names are unique.
            context.share(item.kind, item, context.name("ModeLabel", item))


def extract_software(context: Importing, model: ProjectObject, stimuli: dict[ProjectObject, list[str]]) -> perf.Software:
    """The software.

    Parameters
    ----------
    stimuli : names of the stimuli of each process
    """
    objects = list(model.walk())
    tasks: list[perf.Task] = []
    isrs: list[perf.Isr] = []
    for process in processes_of(model):
        activities = (*extract_graph(process["callGraph"], context), *_not_understood(process, context))
        known: dict[str, Any] = {
            "name": context.name_of("Process", process),
            "stimuli": in_order(dict.fromkeys(stimuli.get(process, [])), str, context.noted(process).get("stimuli")),
            "activities": activities,
            "origin": context.located(process),
        }
        if process["isr"]:
            isrs.append(ISR.extract(process, context, **known))
        else:
            preemption = perf.Preemption.PREEMPTIVE if process["preemptable"] else perf.Preemption.NON_PREEMPTIVE
            kept = context.fields(process, perf.Task, ("preemption",)) if not process["preemptable"] else {}
            tasks.append(TASK.extract(process, context, **{**known, "preemption": preemption, **kept}))
    modes, labels = _modes(context, model, [item for item in objects if item.kind in ("ModeGroup", "Counter")])
    return perf.Software(
        tasks=tuple(tasks),
        isrs=tuple(isrs),
        runnables=tuple(_runnable(item, context) for item in objects if item.kind == "Function"),
        labels=tuple(_label(item, context) for item in objects if item.kind == "memory.DataObject"),
        channels=context.list_of(model, "channels", (perf.Channel,)),
        os_events=tuple(
            perf.OsEvent(name=context.name_of("Event", item) or "", origin=context.located(item))  # type: ignore[arg-type]
            for item in objects
            if item.kind == "Event"
        ),
        modes=tuple(modes),
        mode_labels=tuple(labels),
    )


def _not_understood(process: ProjectObject, context: Importing) -> Iterator[Incomplete]:
    """Activities of unknown demand for the features by which a process may be executed more than its call graph says."""
    for feature in ("server", "maxThreads", "threadPool", "triggeringPort", "idleTask"):
        if process[feature]:
            context.leave_out(process, f"Process.{feature}")
            yield Incomplete(reason=f"Process.{feature} of the project is not understood", locate=context.located(process))


def _runnable(item: ProjectObject, context: Importing) -> perf.Runnable:
    activities = extract_graph(item["callGraph"], context)
    result: perf.Runnable = RUNNABLE.extract(
        item, context, name=context.name_of("Function", item), activities=activities, origin=context.located(item)
    )
    return result


def _label(item: ProjectObject, context: Importing) -> perf.Label:
    content = context.noted(item)
    size = None if "size" in content and content["size"] is None else size_of(item["size"])
    result: perf.Label = LABEL.extract(
        item, context, name=context.name_of("DataObject", item), size=size, origin=context.located(item)
    )
    return result


def extract_semaphores(context: Importing, model: ProjectObject) -> tuple[Semaphore, ...]:
    """The semaphores."""
    return tuple(
        SEMAPHORE.extract(item, context, name=context.name_of("Semaphore", item), origin=context.located(item))
        for item in model.walk()
        if item.kind == "Semaphore"
    )


def extract_placements(context: Importing, model: ProjectObject) -> tuple[Placement, ...]:
    """The memories of variables; addresses, and the memories of other elements, are in the comment."""
    kept = {each.element: each for each in context.list_of(model, "placements", (Placement,))}
    result = []
    for item in model.walk():
        if item.kind == "memory.DataObject" and item["memory"] is not None:
            label, memory = context.name_of("DataObject", item), context.name_of("Memory", item["memory"])
            if label is not None and memory is not None:
                stated = kept.pop(label, None)
                is_same = stated is not None and stated.memory == memory
                result.append(Placement(element=label, memory=memory, address=stated.address if stated and is_same else 0))
    return (*result, *kept.values())


def _modes(
    context: Importing, model: ProjectObject, items: list[ProjectObject]
) -> tuple[list[perf.Mode], list[perf.ModeLabel]]:
    """Modes and mode labels; a project has the literals in each label."""
    modes = {mode.name: mode for mode in context.list_of(model, "modes", (perf.Mode,))}
    labels = [*context.list_of(model, "mode_labels", (perf.ModeLabel,))]
    for item in items:
        content = context.noted(item)
        name = context.name_of(item.kind, item) or ""
        literals = tuple(mode.name for mode in item["modes"]) if item.kind == "ModeGroup" else ()
        mode = content["mode"] if isinstance(content.get("mode"), str) else name
        if modes.setdefault(mode, perf.Mode(name=mode, literals=literals)).literals != literals:
            mode = name
            modes[mode] = perf.Mode(name=mode, literals=literals)
        initial = _initial(item)
        if "initial" in content and (content["initial"] is None or isinstance(content["initial"], str)):
            initial = content["initial"] if initial in (*literals[:1], "0") else initial
        labels.append(perf.ModeLabel(name=name, mode=mode, initial=initial, origin=context.located(item)))  # type: ignore[arg-type]
    return list(modes.values()), labels


def _initial(item: ProjectObject) -> str | None:
    if item.kind == "Counter":
        return str(item["initialValue"])
    return item["initialMode"].name if item["initialMode"] is not None else None
