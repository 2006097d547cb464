"""0.8.0 -> 0.8.1: names of stimuli, priorities, scheduling units, inner event chains, quartzes."""

from __future__ import annotations

from amalthea_uros.metamodel.naming import TYPE_MARK
from amalthea_uros.xmi.migrate.steps.kept import strings
from amalthea_uros.xmi.migrate.steps.tools import (
    add_property,
    add_value,
    content_of,
    free_key,
    keys_of,
    move_properties,
    property_of,
    property_text,
    put_property,
    text_value,
)
from amalthea_uros.xmi.tree.classes import class_of, reference_text
from amalthea_uros.xmi.tree.model_set import ModelSet, Step
from amalthea_uros.xmi.tree.node import Node, remove_all
from amalthea_uros.xmi.tree.notes import StepNotes

# Event chains in event chains, which cannot be referred to any more

_CONSTRAINTS = ("EventChainLatencyConstraint", "EventChainSynchronizationConstraint")


def contain_event_chains(models: ModelSet, notes: StepNotes) -> None:
    """SubEventChain -> EventChainContainer; references to inner chains -> custom properties with the text of the reference."""
    chains = [chain for tree in models.trees for chain in tree.root.find("constraintsModel", "eventChains")]
    outer = {chain.name: chain for chain in chains if chain.name}
    for item in models.nodes("segments", "strands"):
        if item.type == "SubEventChain":
            item.type = "EventChainContainer"
            notes.renamed(item, "class renamed", "SubEventChain -> EventChainContainer")
        elif item.type == "EventChainReference":
            for text in _take_inner(item, "eventChain", outer):
                add_property(item, "eventChain", text)
                notes.kept(item, "reference to an inner event chain", text, "eventChain")
    for constraint in models.parts("constraintsModel", "timingConstraints"):
        if constraint.type in _CONSTRAINTS:
            _keep_scope(constraint, outer, notes)


def _keep_scope(constraint: Node, outer: dict[str, Node], notes: StepNotes) -> None:
    texts = _take_inner(constraint, "scope", outer)
    if not texts:
        return
    add_value(constraint, "scope", strings(texts, constraint))
    notes.kept(constraint, "scope: reference to an inner event chain", ", ".join(texts), "scope")


def _take_inner(node: Node, name: str, outer: dict[str, Node]) -> list[str]:
    """Remove the targets of a reference that are inner chains; the texts that referred to them."""
    targets = node.references.pop(name, [])
    # One target elsewhere makes elements of all.
    start = "amlt:/#" if any(target.root is not node.root for target in targets) else ""
    kept: list[Node] = []
    texts: list[str] = []
    for target in targets:
        if target.tag == "eventChains" or target.is_proxy:
            kept.append(target)  # what is in no file, may be an outer one
        elif target.name in outer:
            kept.append(outer[target.name])  # from now on the name means that one
        else:
            texts.append(start + reference_text(target))
    if kept:
        node.references[name] = kept
    return texts


# Priorities of processes and of their allocations
#
# Until 0.8.0 processes and task allocations both had a priority, whose default 0 editors wrote as well. What is written as 0 is kept
# where nothing else states the priority, because from 0.8.1 on 0 and no priority are different things.

_PRIORITY = "priority"
_GROUP = "osekTaskGroup"


def move_priorities(models: ModelSet, notes: StepNotes) -> None:
    """Priority of an allocation -> scheduling parameters; priority and task group of a process -> custom properties."""
    allocated = _move_of_allocations(models, notes)
    allocated |= _replace_defaults_of_isr_allocations(models, notes)
    for tag in ("tasks", "isrs", "processPrototypes"):
        for process in models.parts("swModel", tag):
            _move_of_process(process, process in allocated, notes)
    for task in models.parts("swModel", "tasks"):
        _move_task_group(task, notes)


def _move_of_allocations(models: ModelSet, notes: StepNotes) -> set[Node]:
    """The tasks of which every allocation states a priority now."""
    allocated: set[Node] = set()
    unstated: set[Node | None] = set()
    for allocation in models.parts("mappingModel", "taskAllocation"):
        text = allocation.attributes.pop(_PRIORITY, None)
        task = allocation.target("task")
        if text is None:
            unstated.add(task)
            continue
        own = _own(task)
        if text == "0" and own not in ("", "0"):
            # As scheduling parameter it would outdo the priority of the task from 2.0.0 on.
            notes.converted(
                allocation, "priority 0, the old default, left out: the priority of the task applies", own, _PRIORITY
            )
        else:
            parameters = allocation.child_or_new("schedulingParameters")
            parameters.attributes.setdefault(_PRIORITY, text)
            notes.moved(allocation, "priority of a task allocation -> schedulingParameters", text, _PRIORITY)
            if task is not None:
                allocated.add(task)
    return allocated - unstated


def _replace_defaults_of_isr_allocations(models: ModelSet, notes: StepNotes) -> set[Node]:
    """The ISRs of which every allocation states a priority; it stays an attribute there, also in the newest version."""
    allocated: set[Node] = set()
    unstated: set[Node | None] = set()
    for allocation in models.parts("mappingModel", "isrAllocation"):
        isr = allocation.target("isr")
        if isr is None or _PRIORITY not in allocation.attributes:
            unstated.add(isr)
            continue
        own = _own(isr)
        if allocation.attributes[_PRIORITY] == "0" and own not in ("", "0"):
            allocation.attributes[_PRIORITY] = own
            notes.converted(
                allocation, "priority 0, the old default, replaced: the priority of the ISR applies", own, _PRIORITY
            )
        allocated.add(isr)
    return allocated - unstated


def _move_of_process(process: Node, is_allocated: bool, notes: StepNotes) -> None:
    text = process.attributes.pop(_PRIORITY, None)
    if text is None:
        return
    if text != "0" or not is_allocated:
        _state(process, _PRIORITY, text, notes)
        notes.kept(process, "priority of a process", text, _PRIORITY)
    elif is_allocated:
        notes.converted(
            process, "priority 0, the old default, left out: the priority of the allocation applies", attribute=_PRIORITY
        )
    else:
        notes.lost(process, "priority 0 of a process", attribute=_PRIORITY)


def _move_task_group(task: Node, notes: StepNotes) -> None:
    text = task.attributes.pop(_GROUP, None)
    if text == "0":
        # Nothing is lost: a task without group is in group 0.
        notes.converted(task, "OSEK task group 0, the old default, left out", attribute=_GROUP)
    elif text is not None:
        _state(task, _GROUP, text, notes)
        notes.kept(task, "OSEK task group", text, _GROUP)


def _state(process: Node, key: str, text: str, notes: StepNotes) -> None:
    """Add a custom property that the step to 2.0.0 finds by its key: of another one of that key it would take the value."""
    present = property_of(process, key)
    if property_text(present) == text:
        return
    if present is not None:
        present.attributes["key"] = free_key(key, keys_of(process))
        notes.renamed(
            present, f"custom property {key!r} gets another key: it is what the process states itself", present.get("key")
        )
    put_property(process, key, text_value(text, process))


def _own(process: Node | None) -> str:
    """The priority that a process states itself, also in a file that was migrated before."""
    if process is None:
        return ""
    return process.get(_PRIORITY) or property_text(property_of(process, _PRIORITY)) or ""


# Scheduling units, which are dissolved into their schedulers

_HARDWARE, _SOFTWARE = "SchedulingHWUnit", "SchedulingSWUnit"


def change_schedulers(models: ModelSet, notes: StepNotes) -> None:
    """Dissolve the scheduling units; rename the parameters of user specific algorithms."""
    for tag in ("taskSchedulers", "interruptControllers"):
        for scheduler in models.parts("osModel", "operatingSystems", tag):
            _rename_parameters(scheduler, notes)
            _keep_priority(scheduler, scheduler, "scheduleUnitPriority", "scheduleUnitPriority", notes)
            for unit in scheduler.all("schedulingUnit"):
                _dissolve(unit, scheduler, notes)


def _rename_parameters(scheduler: Node, notes: StepNotes) -> None:
    for algorithm in scheduler.all("schedulingAlgorithm"):
        if algorithm.type != "UserSpecificSchedulingAlgorithm":
            continue
        for parameter in algorithm.all("parameter"):
            parameter.tag = "parameterExtensions"
            notes.renamed(parameter, "parameter -> parameterExtensions", parameter.get("key"))


def _keep_priority(holder: Node, scheduler: Node, attribute: str, key: str, notes: StepNotes) -> None:
    text = holder.attributes.pop(attribute, None)
    if text == "0":
        notes.converted(holder, f"{attribute} 0, the old default, left out", attribute=attribute)
    elif text is not None:
        add_property(scheduler, key, text)
        notes.kept(holder, f"{attribute} of a scheduling unit", text, attribute)


def _dissolve(unit: Node, scheduler: Node, notes: StepNotes) -> None:
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


_TRIGGER = "InterProcessTrigger"
_STIMULUS = "InterProcessStimulus"

_CLASSES = {
    "ArrivalCurve": "ArrivalCurveStimulus",
    "InterProcess": _STIMULUS,
    "InterProcessActivation": _TRIGGER,
    "Periodic": "PeriodicStimulus",
    "PeriodicEvent": "VariableRateStimulus",
    "ProcessRunnableGroup": "RunnableEntityGroup",
    "Single": "SingleStimulus",
    "Sporadic": "SporadicStimulus",
    "Synthetic": "SyntheticStimulus",
}

_STIMULI = frozenset(_CLASSES) - {"InterProcessActivation", "ProcessRunnableGroup"}

_OLD_NAMES = {new: old for old, new in _CLASSES.items()}

#: Sub-model and tag of objects, their class ("" for any) -> attribute or reference, and its new name.
_RENAMED = (
    ("swModel", "runnables", "", "activation", "activations"),
    ("swModel", "activations", "EventActivation", "trigger", "triggeringEvents"),
    ("stimuliModel", "stimuli", "EventStimulus", "trigger", "triggeringEvents"),
    ("mappingModel", "coreAllocation", "", "core", "responsibility"),
)

_MODE_VALUE_LISTS = ("setModeValueList", "enablingModeValueList", "disablingModeValueList")

#: What a quartz could contain as long as it was a node of the hardware like others.
_PARTS_OF_QUARTZ = ("components", "memories", "networks", "ports", "prescaler")


def change(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 0.8.0."""
    for node in models.rename_classes(_CLASSES):
        notes.renamed(node, "class renamed", f"{_OLD_NAMES[node.type]} -> {node.type}")
    _rename_in_texts(models, notes)
    _change_triggers(models, notes)
    _rename_features(models, notes)
    _type_mode_values(models, notes)
    _type_label_groups(models, notes)
    _keep_deadlines(models, notes)
    move_priorities(models, notes)
    change_schedulers(models, notes)
    contain_event_chains(models, notes)
    _change_hardware(models, notes)


def _rename_in_texts(models: ModelSet, notes: StepNotes) -> None:
    """Rename the classes of stimuli in references that are texts of custom properties."""
    for node in models.nodes("value", "values"):
        before, mark, name = node.get("value").partition(TYPE_MARK)
        if name not in _STIMULI or not node.type or node.enclosing("customProperties") is None:
            continue
        node.attributes["value"] = f"{before}{mark}{_CLASSES[name]}"
        notes.renamed(node, "class renamed in the text of a custom property", f"{name} -> {_CLASSES[name]}", "value")


def _change_triggers(models: ModelSet, notes: StepNotes) -> None:
    """From 0.8.1 on, a process can trigger others by inter-process stimuli only."""
    for trigger in models.nodes("calls"):
        stimulus = trigger.target("stimulus")
        if trigger.type != _TRIGGER or stimulus is None:
            continue
        if class_of(stimulus) not in (_STIMULUS, ""):
            _take_other_stimulus(trigger, stimulus, notes)


def _take_other_stimulus(trigger: Node, stimulus: Node, notes: StepNotes) -> None:
    del trigger.references["stimulus"]
    value = Node("value", "ReferenceObject", origin=trigger.origin)
    value.refer("value", stimulus)
    add_value(trigger, "stimulus", value)
    notes.kept(trigger, "triggered stimulus that is not an inter-process stimulus", reference_text(stimulus), "stimulus")


def _rename_features(models: ModelSet, notes: StepNotes) -> None:
    for model, tag, class_name, old, new in _RENAMED:
        for node in models.parts(model, tag):
            if class_name in (node.type, "") and node.rename(old, new):
                notes.renamed(node, f"{old} -> {new}", attribute=old)
    for allocation in models.parts("mappingModel", "coreAllocation"):
        allocation.tag = "schedulerAllocation"
        notes.renamed(allocation, "coreAllocation -> schedulerAllocation")


def _type_mode_values(models: ModelSet, notes: StepNotes) -> None:
    for name in _MODE_VALUE_LISTS:
        for entry in models.parts("stimuliModel", "stimuli", name, "entries"):
            if entry.type in ("", "ModeValueListEntry"):
                entry.type = "ModeValue"
                notes.renamed(entry, "class renamed", "ModeValueListEntry -> ModeValue")


def _type_label_groups(models: ModelSet, notes: StepNotes) -> None:
    """State the class of the labels of a pairing constraint: there is a second kind of groups now."""
    for constraint in models.parts("constraintsModel", "affinityConstraints"):
        for group in constraint.all("group") if constraint.type == "DataPairingConstraint" else ():
            if not group.type:
                group.type = "LabelEntityGroup"
                notes.renamed(group, "class of a group of labels is stated: LabelEntityGroup")


def _keep_deadlines(models: ModelSet, notes: StepNotes) -> None:
    for activation in models.parts("swModel", "activations"):
        deadline = activation.child("deadline")
        if activation.type == "PeriodicActivation" and deadline is not None:
            notes.kept(deadline, "deadline of a periodic activation", deadline.get("value") + deadline.get("unit"))
            deadline.type = "TimeObject"
            add_value(activation, "deadline", deadline)


def _change_hardware(models: ModelSet, notes: StepNotes) -> None:
    for memory in models.parts("hwModel", "memoryTypes"):
        pattern = memory.attributes.pop("xAccessPattern", None)
        if pattern is not None:
            notes.lost(memory, "access pattern of a memory type", pattern, "xAccessPattern")
    for root in models.roots:
        systems = root.find("hwModel", "system")
        if systems:
            _collect_quartzes(systems, notes)


def _collect_quartzes(systems: list[Node], notes: StepNotes) -> None:
    """All quartzes of a file become parts of the system, and have no parts of the hardware any more."""
    home = systems[0]
    quartzes = [node for system in systems for node in system.walk() if node.tag == "quartzes"]
    if any(quartz.parent is not home for quartz in quartzes):
        for quartz in quartzes:
            if quartz.parent is not home:
                notes.moved(quartz, "quartz -> system", quartz.name)
        home.take(quartzes)
    for quartz in quartzes:
        parts = quartz.all(*_PARTS_OF_QUARTZ)
        for part in parts:
            notes.lost(part, f"{part.tag} of a quartz", part.name)
        remove_all(parts)


STEP = Step(
    "0.8.0", "0.8.1", change, frozenset({*_CLASSES, "SchedulingHWUnit", "SchedulingSWUnit", "schedulingUnit", "coreAllocation"})
)
