"""0.7.1 -> 0.7.2: data stability, instructions, groups, tags, and hardware inside of property constraints."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.steps.file_roots import wrap_roots
from amalthea_uros.xmi.migrate.steps.tools import content_of, relink
from amalthea_uros.xmi.migrate.steps.v0_7_1 import name_mappings
from amalthea_uros.xmi.tree.model_set import ModelSet, Step
from amalthea_uros.xmi.tree.node import Node, remove_all
from amalthea_uros.xmi.tree.notes import StepNotes

# Hardware that property constraints contain: it is in the hardware model now, and they refer to it

#: Element of propertyConstraintsModel -> element of hwModel.
_DEFINITIONS = {"coreTypeDefinitions": "coreTypes", "memoryTypeDefinitions": "memoryTypes"}

#: The containers of new cores and memories, with the names that APP4MC generates.
_SYSTEM = ("system", "migration_gen_system")
_MICROCONTROLLER = (_SYSTEM, ("ecus", "migration_gen_ecu"), ("microcontrollers", "migration_gen_microcontroller"))

#: Element of a condition -> class of the condition, element of the hardware, and its containers.
_PARTS = {"core": ("HwCoreProperty", "cores", _MICROCONTROLLER), "memory": ("HwMemoryProperty", "memories", (_SYSTEM,))}


def move_hardware(models: ModelSet, notes: StepNotes) -> None:
    """Move what has a new name to the hardware model, and let the rest mean the hardware of the same name."""
    mover = _Mover(models, notes)
    for tag, new_tag in _DEFINITIONS.items():
        for definition in models.parts("propertyConstraintsModel", tag):
            mover.move(definition, new_tag, ())
    for tag, (condition_class, new_tag, containers) in _PARTS.items():
        for part in models.nodes(tag):
            condition = part.parent
            if condition is None or condition.type != condition_class:
                continue
            meant = mover.move(part, new_tag, containers)
            if meant is not None:
                condition.references[tag] = [meant]
    mover.finish()


class _Mover:
    """Moves hardware, and remembers what is there.

    Attributes
    ----------
    known : hardware by element and name
    moved : what goes into which container
    removed : what is not needed
    replaced : what is meant instead of it
    """

    def __init__(self, models: ModelSet, notes: StepNotes) -> None:
        self.models, self.notes = models, notes
        self.known: dict[tuple[str, str], Node] = {}
        self.moved: dict[Node, list[Node]] = {}
        self.removed: list[Node] = []
        self.replaced: dict[Node, Node] = {}
        for model in models.parts("hwModel"):
            self.register(model)

    def register(self, hardware: Node) -> None:
        """Remember everything in it; of several things of one name the first."""
        for node in hardware.walk():
            if node.name:
                self.known.setdefault((node.tag, node.name), node)

    def move(self, node: Node, tag: str, containers: tuple[tuple[str, str], ...]) -> Node | None:
        """Move hardware to a place below the hardware model, unless there is such a thing; what is meant by it now."""
        if not node.name:
            self.removed.append(node)
            self.notes.lost(node, f"unnamed {node.tag} of a property constraint", content_of(node))
            return None
        known = self.known.get((tag, node.name))
        if known is not None:
            self.removed.append(node)
            self.replace(node, known)
            return known
        self.notes.moved(node, f"{node.tag} of a property constraint -> {tag} of the hardware model", node.name)
        holder = self.hardware_model()
        for container, name in containers:
            holder = _part(holder, container, name)
        self.moved.setdefault(holder, []).append(node)
        node.tag = tag
        self.known[tag, node.name] = node
        self.register(node)
        return node

    def replace(self, node: Node, known: Node) -> None:
        """Let references to a node, and to what is in it, mean what has its name in the hardware model."""
        self.replaced[node] = known
        for part in node.walk():
            if part is not node and (part.tag, part.name) in self.known:
                self.replaced[part] = self.known[part.tag, part.name]
        message = f"{node.tag} of a property constraint: the one of the same name in the hardware model is meant"
        if node.children or node.references or not node.attributes.items() <= known.attributes.items():
            self.notes.lost(node, f"{message}; its other content is dropped", content_of(node))
        else:
            self.notes.converted(node, message, node.name)

    def hardware_model(self) -> Node:
        """The first hardware model, else a new one in the first file, as in APP4MC."""
        roots = [tree.root for tree in sorted(self.models.active, key=lambda tree: tree.path)]
        models = [model for root in roots for model in root.all("hwModel")]
        return models[0] if models else roots[0].add("hwModel")

    def finish(self) -> None:
        """Move and remove all at once, and let nothing refer to what is removed."""
        for holder, nodes in self.moved.items():
            holder.take(nodes)
        remove_all(self.removed)
        relink(self.models, self.replaced)


def _part(holder: Node, tag: str, name: str) -> Node:
    """The part of that name, made if there is none; a system of any name, as there is only one."""
    for part in holder.all(tag):
        if part.name == name or tag == "system":
            return part
    return holder.add(tag, name=name)


# Items of runnables: instructions, groups and probability groups

_ITEMS = ("runnableItems", "runnableItem", "items")

_INSTRUCTIONS = frozenset({"InstructionsConstant", "InstructionsDeviation"})


def change_runnable_items(models: ModelSet, notes: StepNotes) -> None:
    """Change all items of runnables, however deep they are."""
    items = models.nodes(*_ITEMS)
    for item in items:
        if item.type in _INSTRUCTIONS:
            _wrap_instructions(item, notes)
    for item in items:
        if item.type == "ProbabilityGroup":
            _make_switch(item, notes)
        elif item.type == "Group":
            _unwrap_items(item, notes)


def _wrap_instructions(item: Node, notes: StepNotes) -> None:
    """The item stays, and what it said becomes a part of it."""
    default = Node("default", item.type, item.attributes, item.origin)
    default.references = item.references
    # Instructions have no custom properties any more.
    moved = [child for child in item.children if child.tag != "customProperties"]
    default.take(moved)
    item.insert(default)
    item.type, item.attributes, item.references = "RunnableInstructions", {}, {}
    notes.converted(item, f"{default.type} -> RunnableInstructions with default")


def _unwrap_items(group: Node, notes: StepNotes) -> None:
    """Items of groups without the deviation around each of them."""
    children: list[Node] = []
    wrappers = []
    for child in group.children:
        if child.tag != "items" or child.type:
            children.append(child)
            continue
        wrappers.append(child)
        children += _unwrapped(child, notes)
    if wrappers:
        remove_all(wrappers)
        group.set_children(children)


def _unwrapped(wrapper: Node, notes: StepNotes) -> list[Node]:
    items = wrapper.all("runnableItem")
    properties = wrapper.all("customProperties") if items else []
    remove_all([*items, *properties])
    if items:
        items[0].set_children([*properties, *items[0].children])
    for item in items:
        item.tag = "items"
        notes.converted(item, "DeviationRunnableItem of a group -> the item itself")
    if rest := ", ".join(filter(None, map(content_of, wrapper.children))):
        notes.lost(wrapper, "deviation of an item of a group", rest)
    return items


def _make_switch(group: Node, notes: StepNotes) -> None:
    group.type = "RunnableProbabilitySwitch"
    notes.converted(group, "ProbabilityGroup -> RunnableProbabilitySwitch")
    for entry in group.all("items"):
        entry.tag = "entries"
        for item in entry.all("runnableItem"):
            item.tag = "items"


#: Files that came from ITEA versions have the boolean of those.
_STABILITY = {
    "buffered": "customProtection",
    "notBuffered": "noProtection",
    "true": "customProtection",
    "false": "noProtection",
}

_RENAMED_CLASSES = {
    "OsExecutionInstructions": "Instructions",
    "OsExecutionInstructionsConstant": "InstructionsConstant",
    "OsExecutionInstructionsDeviation": "InstructionsDeviation",
}

_MODELS_WITH_TAGS = ("componentsModel", "hwModel", "swModel")

_REMOVED_TARGETS = frozenset({"TargetProcess", "TargetCallSequence"})

#: Class of a constraint -> the old tag of its group.
_GROUPS = {"DataPairingConstraint": "labels", "ProcessPairingConstraint": "processes", "RunnablePairingConstraint": "runnables"}

#: Attribute of OsBuffering -> level of DataStability. Only one is possible: the first.
_LEVELS = {"processLevel": "process", "runnableLevel": "runnable", "scheduleSectionLevel": "scheduleSection"}


def change(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 0.7.1."""
    wrap_roots(models, notes)
    _change_attributes(models, notes)
    change_runnable_items(models, notes)
    for found in models.rename_classes(_RENAMED_CLASSES):
        notes.renamed(found, f"instructions of the operating system -> {found.type}")
    for curve in models.nodes("arrivalCurveEntries"):
        curve.tag = "entries"
        notes.renamed(curve, "arrivalCurveEntries -> entries")
    _change_constraints(models, notes)
    for os_model in models.parts("osModel"):
        _change_buffering(os_model, notes)
    _move_tags(models, notes)
    name_mappings(models, notes)
    move_hardware(models, notes)
    _change_traced_events(models, notes)


def _change_attributes(models: ModelSet, notes: StepNotes) -> None:
    """Attributes that several classes have."""
    for node in models.walk():
        attributes = node.attributes
        if "buffered" in attributes and not node.type.startswith("SenderReceiver"):
            old = attributes.pop("buffered")
            attributes["dataStability"] = _STABILITY.get(old, old)
            notes.converted(node, "buffered -> dataStability", f"{old} -> {attributes['dataStability']}", "buffered")
        if "initalValue" in attributes:
            attributes["initialValue"] = attributes.pop("initalValue")
            notes.renamed(node, "initalValue -> initialValue", attribute="initalValue")
        if attributes.get("preemption") == "unknown":
            del attributes["preemption"]
            notes.converted(node, "preemption 'unknown' -> not stated", attribute="preemption")
        if "samplingType" in attributes and node.tag != "distribution":
            _move_sampling(node, attributes.pop("samplingType"), notes)


def _move_sampling(deviation: Node, sampling: str, notes: StepNotes) -> None:
    """Only the distribution Boundaries has a sampling type now."""
    distribution = deviation.child("distribution")
    # Without a distribution, the bounds are all that there is to sample.
    if distribution is None:
        distribution = deviation.add("distribution", "Boundaries")
    if distribution.type == "Boundaries":
        distribution.attributes["samplingType"] = sampling
        notes.moved(deviation, "samplingType of a deviation -> samplingType of its Boundaries", sampling, "samplingType")
    else:
        notes.lost(deviation, "samplingType of a deviation: only the distribution Boundaries has one", sampling, "samplingType")


def _change_constraints(models: ModelSet, notes: StepNotes) -> None:
    removed = [node for node in models.nodes("target") if node.type in _REMOVED_TARGETS]
    for target in removed:
        notes.lost(target, f"{target.type}: targets of runnable constraints are schedulers or cores", content_of(target))
    remove_all(removed)
    for constraint in models.nodes("affinityConstraints"):
        groups = constraint.all(_GROUPS[constraint.type]) if constraint.type in _GROUPS else []
        for group in groups:
            notes.renamed(constraint, f"{group.tag} of a {constraint.type} -> group")
            group.tag = "group"


def _change_buffering(os_model: Node, notes: StepNotes) -> None:
    buffering, consistency = os_model.child("osBuffering"), os_model.child("osDataConsistency")
    if buffering is None:
        if consistency is None and not os_model.find("operatingSystems", "osDataConsistency"):
            os_model.add("osDataConsistency")
        return
    if consistency is not None:
        notes.lost(buffering, "osBuffering: there is osDataConsistency, too", content_of(buffering))
        buffering.remove()
        return
    stated = buffering.attributes
    levels = [level for name, level in _LEVELS.items() if stated.get(name) == "true"]
    algorithm = stated.get("bufferingAlgorithm")
    buffering.tag, buffering.attributes = "osDataConsistency", {"mode": "automaticProtection" if levels else "noProtection"}
    notes.converted(buffering, "osBuffering -> osDataConsistency", ", ".join(levels) or "no level")
    if levels:
        stability = buffering.add("dataStability", enabled="true", accessMultiplicity="multipleAccesses", level=levels[0])
        if algorithm is not None:
            stability.attributes["algorithm"] = algorithm
    elif algorithm:
        notes.lost(buffering, "algorithm of osBuffering, which has no level", algorithm, "bufferingAlgorithm")
    if levels[1:]:
        notes.lost(buffering, "level of osBuffering: data stability has only one", ", ".join(levels[1:]))


def _move_tags(models: ModelSet, notes: StepNotes) -> None:
    """Tags of all models are common elements; those of the same name in a file become one."""
    replaced: dict[Node, Node] = {}
    for root in models.roots:
        moved = [tag for model in root.all(*_MODELS_WITH_TAGS) for tag in model.all("tags")]
        if not moved:
            continue
        common = root.child_or_new("commonElements")
        known = [*common.all("tags"), *moved]
        first = {tag.name: tag for tag in reversed(known) if tag.name}
        for tag in moved:
            same = first.get(tag.name, tag)
            if same is tag:
                notes.moved(tag, "tags -> commonElements")
                continue
            replaced[tag] = same
            if tag.attributes == same.attributes and not tag.children:
                notes.moved(tag, "tags -> commonElements, one of those of the same name")
            else:
                notes.lost(tag, "a tag differs from another one of the same name, which is kept", content_of(tag))
        common.take(tag for tag in moved if tag not in replaced)
    remove_all(replaced)
    relink(models, replaced)


def _change_traced_events(models: ModelSet, notes: StepNotes) -> None:
    """Configurations of traces refer to events; those that contain one move it to the event model."""
    moved: dict[Node, list[Node]] = {}
    for config in models.nodes("eventsToTrace"):
        if config.type not in ("EventConfigElement", "EventConfigLink"):
            continue
        events = config.all("event")
        for event in events:
            event.tag = "events"
            notes.moved(event, "event of a trace configuration -> eventModel", event.name)
        moved.setdefault(config.root, []).extend(events)
        notes.renamed(config, f"{config.type} -> EventConfig")
        config.type = ""
        if events:
            config.refer("event", *events)
    for root, events in moved.items():
        if events:
            root.child_or_new("eventModel").take(events)


STEP = Step(
    "0.7.1",
    "0.7.2",
    change,
    frozenset(
        {
            *("arrivalCurveEntries", "coreTypeDefinitions", "memoryTypeDefinitions", "osBuffering", "runnableItem"),
            *("EventConfigElement", "EventConfigLink", "ProbabilityGroup"),
            *_REMOVED_TARGETS,
            *_RENAMED_CLASSES,
        }
    ),
)
