"""Scheduling units, which AMALTHEA 0.8.1 dissolved into their schedulers."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.names import reference_text
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.properties import add_property, add_value, move_properties
from amalthea_uros.xmi.migrate.steps.v0_7_tools import content_of

_HARDWARE, _SOFTWARE = "SchedulingHWUnit", "SchedulingSWUnit"


def change_schedulers(models: ModelSet, notes: Notes) -> None:
    """Dissolve the scheduling units; rename the parameters of user specific algorithms."""
    for tag in ("taskSchedulers", "interruptControllers"):
        for scheduler in models.parts("osModel", "operatingSystems", tag):
            _rename_parameters(scheduler, notes)
            _keep_priority(scheduler, scheduler, "scheduleUnitPriority", "scheduleUnitPriority", notes)
            for unit in scheduler.all("schedulingUnit"):
                _dissolve(unit, scheduler, notes)


def _rename_parameters(scheduler: Node, notes: Notes) -> None:
    for algorithm in scheduler.all("schedulingAlgorithm"):
        if algorithm.type != "UserSpecificSchedulingAlgorithm":
            continue
        for parameter in algorithm.all("parameter"):
            parameter.tag = "parameterExtensions"
            notes.renamed(parameter, "parameter -> parameterExtensions", parameter.get("key"))


def _keep_priority(holder: Node, scheduler: Node, attribute: str, key: str, notes: Notes) -> None:
    text = holder.attributes.pop(attribute, None)
    if text == "0":
        notes.converted(holder, f"{attribute} 0, the old default, left out", attribute=attribute)
    elif text is not None:
        add_property(scheduler, key, text)
        notes.kept(holder, f"{attribute} of a scheduling unit", text, attribute)


def _dissolve(unit: Node, scheduler: Node, notes: Notes) -> None:
    kind = unit.type or (_HARDWARE if unit.child("delay") else _SOFTWARE)
    for entry in unit.all("customProperties"):
        key = entry.attributes["key"] = f"{kind}_CustomProperty__{entry.get('key')}"
        notes.moved(entry, "custom property of a scheduling unit -> scheduler", key)
    move_properties(unit, scheduler)
    delay = unit.child("delay")
    if delay is not None:
        notes.kept(delay, "delay of a scheduling unit", delay.get("value") + delay.get("unit"))
        delay.type = "TimeObject"
        add_value(scheduler, f"{_HARDWARE}___delay", delay)
    for instructions in unit.all("instructions"):
        instructions.tag = "default"
        scheduler.add("computationItems", "RunnableInstructions", like=instructions).insert(instructions)
        notes.moved(instructions, "instructions of a scheduling unit -> computationItems of the scheduler")
    _keep_priority(unit, scheduler, "priority", f"{_SOFTWARE}___priority", notes)
    for controller in unit.references.pop("interruptController", ()):
        notes.lost(unit, "interrupt controller of a scheduling unit", reference_text(controller), "interruptController")
    if rest := content_of(unit):
        notes.lost(unit, "other content of a scheduling unit", rest)
    unit.remove()
