"""Custom properties in which a step back keeps what the older version has no place for; the step up restores it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

from amalthea_uros.metamodel.kept_properties import OWNERSHIP, PARENT_PARAMETER, SCHEDULING_PARAMETER, prefix
from amalthea_uros.xmi.migrate.steps.scheduling import QUANTUM, TASK_GROUP, USER_SPECIFIC
from amalthea_uros.xmi.migrate.steps.tools import property_of, put_property, text_value
from amalthea_uros.xmi.tree.model_set import ModelSet
from amalthea_uros.xmi.tree.node import Node, remove_all
from amalthea_uros.xmi.tree.notes import StepNotes


def keep(holder: Node, key: str, value: Node) -> Node:
    """Make a value a custom property of an object, with a key that starts with `prefix`: no other property has it."""
    return put_property(holder, key, value)


def kept(holder: Node, start: str) -> dict[str, Node]:
    """The custom properties of an object whose keys start so, by the rest of the key."""
    return {
        child.get("key").removeprefix(start): child
        for child in holder.children
        if child.tag == "customProperties" and child.get("key").startswith(start)
    }


def strings(texts: Iterable[str], like: Node) -> Node:
    """Texts as one value of a custom property."""
    made = Node("value", "ListObject", origin=like.origin)
    for text in texts:
        made.insert(text_value(text, like, "values"))
    return made


def texts_of(value: Node | None) -> list[str]:
    """The texts that `strings` made a value of; of a damaged value what is readable."""
    return [] if value is None else [item.get("value") for item in value.all("values") if item.type == "StringObject"]


def text_of(value: Node | None) -> str:
    """The text of a value."""
    return "" if value is None else value.get("value")


def references(targets: Iterable[Node], like: Node) -> Node:
    """References as one value of a custom property."""
    made = Node("value", "ListObject", origin=like.origin)
    for target in targets:
        item = made.add("values", "ReferenceObject")
        item.refer("value", target)
    return made


def targets_of(value: Node | None) -> list[Node]:
    """The targets of the references that `references` made a value of."""
    found = [] if value is None else [item.target("value") for item in value.all("values")]
    return [target for target in found if target is not None]


def refuse_stale(models: ModelSet, notes: StepNotes, version: str) -> None:
    """Properties of an earlier migration back that were not restored would be taken for content of this model: they are an error."""
    start = prefix(version)
    for node in models.nodes("customProperties"):
        if node.get("key").startswith(start):
            notes.lost(
                node, "custom property of an earlier migration back that was never restored", repr(node.get("key")), "key"
            )


# Scheduler and parameter definitions of 2.0.0 as maps, the form in which a custom property can hold them

#: References to parameter definitions: by name, as these become maps, too.
PARAMETER_LISTS = ("algorithmParameters", "processParameters")

_CUSTOM = "customProperties"

#: Marks a part as absent, in the map that distinguishes it from the other parts.
Report = Callable[[Node], None]


def as_map(definition: Node, report: Report) -> Node:
    """The content of a definition, of which nothing is left afterwards; parts of which a map can hold nothing are reported."""
    made = Node("value", "MapObject", origin=definition.origin)
    for key, text in definition.attributes.items():
        _enter(made, key, text_value(text, definition))
    for name, targets in definition.references.items():
        named = name in PARAMETER_LISTS
        _enter(made, name, strings((t.name for t in targets), definition) if named else references(targets, definition))
    for value in definition.all("defaultValue"):
        _enter(made, "defaultValue", value)
    properties = definition.all(_CUSTOM)
    if properties:
        own = Node("value", "MapObject", origin=definition.origin)
        own.take(properties)
        for node in properties:
            node.tag = "entries"
        _enter(made, _CUSTOM, own)
    for node in definition.children:
        report(node)
    return made


def _enter(made: Node, key: str, value: Node) -> None:
    entry = made.add("entries", like=value, key=key)
    value.tag = "value"
    entry.insert(value)


def from_map(tag: str, value: Node) -> tuple[Node, dict[str, list[str]]]:
    """The definition that `as_map` made a map of, and the names of the parameters that it refers to, by reference."""
    made = Node(tag, origin=value.origin)
    names: dict[str, list[str]] = {}
    for entry in value.all("entries"):
        key, content = entry.get("key"), entry.child("value")
        if content is None:
            continue
        if key in PARAMETER_LISTS:
            names[key] = texts_of(content)
        elif key == "defaultValue":
            content.tag = key
            made.insert(content)
        elif key == _CUSTOM:
            properties = content.all("entries")
            made.take(properties)
            for node in properties:
                node.tag = _CUSTOM
        elif content.type == "StringObject":
            made.attributes[key] = text_of(content)
        else:
            made.references[key] = targets_of(content)
    return made, names


# Putting back


class ParameterKeys(NamedTuple):
    """Keys of custom properties.

    Attributes
    ----------
    parameter : a parameter; its name follows
    order : names of parameters, if their order was not that of 1.2.0
    defaults : names of parameters that were not stated, and for which the default of the definition was written
    """

    parameter: str
    order: str
    defaults: str


_START_2_0_0 = prefix("2.0.0")
TAGS = _START_2_0_0 + "tags"
#: The name of the definition of a scheduler.
DEFINITION = _START_2_0_0 + "definition"
#: The definitions of an OS model, by tag; the name of the definition follows.
DEFINITIONS = {tag: f"{_START_2_0_0}{tag}/" for tag in ("schedulerDefinitions", "schedulingParameterDefinitions")}


def _parameter_keys(start: str, parameter: str) -> ParameterKeys:
    return ParameterKeys(parameter, *(start + what for what in ("order of schedulingParameters", "defaults")))


#: Parameters of a scheduler or allocation.
OWN = _parameter_keys(_START_2_0_0, SCHEDULING_PARAMETER)
#: Parameters of the association of a scheduler with its parent, which has no custom properties itself.
OF_ASSOCIATION = _parameter_keys(_START_2_0_0 + "parentAssociation/", PARENT_PARAMETER)
#: Custom properties of processes that the step up would take for parameters; their keys follow.
PROPERTY = _START_2_0_0 + "customProperties/"

#: Parameters that the step up makes of defaults where 1.2.0 stated nothing.
_FILLED_IN = {TASK_GROUP, QUANTUM}

#: Of all objects that are looked at.
_TAGS = {*("osModel", "osOverheads", "taskSchedulers", "interruptControllers", "taskAllocation", "tasks", "isrs"), *DEFINITIONS}

_RESTORED = "restored from a custom property"


def restore_3_0_0(models: ModelSet, notes: StepNotes) -> None:
    """Restore what the step from 3.0.0 to 2.2.0 kept; call it at the end of the step from 2.2.0 to 3.0.0."""
    for node in models.nodes("semaphores"):
        found = property_of(node, OWNERSHIP)
        if found is not None:
            node.attributes["ownership"] = text_of(found.child("value"))
            _finish(node, found, notes)


def restore_2_0_0(models: ModelSet, notes: StepNotes) -> None:
    """Restore what the step from 2.0.0 to 1.2.0 kept; call it at the end of the step from 1.2.0 to 2.0.0."""
    if not any(node.get("key").startswith(_START_2_0_0) for node in models.nodes("customProperties")):
        return
    by_tag: dict[str, list[Node]] = {}
    # Not by `models.nodes`: the step up made new ones.
    for node in models.walk():
        if node.tag in _TAGS:
            by_tag.setdefault(node.tag, []).append(node)
    for node in by_tag.get("osOverheads", ()):
        found = property_of(node, TAGS)
        if found is not None:
            node.refer("tags", *targets_of(found.child("value")))
            _finish(node, found, notes)
    _Scheduling(by_tag, notes).restore()
    for node in (*by_tag.get("tasks", ()), *by_tag.get("isrs", ())):
        for key, found in kept(node, PROPERTY).items():
            found.attributes["key"] = key
            notes.renamed(node, _RESTORED, key)


def _finish(node: Node, found: Node, notes: StepNotes) -> None:
    notes.converted(node, _RESTORED, found.get("key"))
    found.remove()


class _Scheduling:
    """Definitions as they were, instead of those that the step up made of the algorithm classes."""

    def __init__(self, by_tag: dict[str, list[Node]], notes: StepNotes) -> None:
        self.by_tag, self.notes = by_tag, notes
        self.definitions: dict[str, Node] = {}
        self.parameters: dict[str, Node] = {}
        self.known: set[Node | None] = set()
        self.schedulers = [*by_tag.get("taskSchedulers", ()), *by_tag.get("interruptControllers", ())]
        self.holders = [
            *self.schedulers,
            *(association for node in self.schedulers for association in node.all("parentAssociation")),
            *by_tag.get("taskAllocation", ()),
        ]

    def restore(self) -> None:
        """Put everything back, if there is anything."""
        models = self.by_tag.get("osModel", ())
        if not any(kept(model, start) for model in models for start in DEFINITIONS.values()):
            return
        names: dict[Node, dict[str, list[str]]] = {}
        for model in models:
            names |= self.restore_definitions(model)
        self.link_definitions(names)
        self.known = set(self.definitions.values())
        for node in self.schedulers:
            self.link_scheduler(node)
        for node in self.schedulers:
            self.restore_parameters(node, node, OWN, node)
            for association in node.all("parentAssociation"):
                self.restore_parameters(association, node, OF_ASSOCIATION, association.target("parent"))
        for node in self.by_tag.get("taskAllocation", ()):
            self.restore_parameters(node, node, OWN, node.target("scheduler"))
        self.remove_unused()

    def restore_definitions(self, model: Node) -> dict[Node, dict[str, list[str]]]:
        """Put the definitions of an OS model back, before those that the step up put there; the parameters that they name."""
        made = model.all(*DEFINITIONS)
        names: dict[Node, dict[str, list[str]]] = {}
        used = []
        for tag, by_name in zip(DEFINITIONS, (self.definitions, self.parameters), strict=True):
            for found in kept(model, DEFINITIONS[tag]).values():
                value = found.child("value")
                if value is None:
                    continue
                definition, lists = from_map(tag, value)
                names[definition] = lists
                definition.comments = found.comments
                by_name.setdefault(definition.name, definition)
                used.append(found)
                self.notes.converted(model, _RESTORED, found.get("key"))
        remove_all(used)
        model.take([*names, *made])
        return names

    def link_definitions(self, names: dict[Node, dict[str, list[str]]]) -> None:
        for definition, lists in names.items():
            for name, parameters in lists.items():
                definition.refer(name, *(self.parameters[p] for p in parameters if p in self.parameters))
                for missing in (p for p in parameters if p not in self.parameters):
                    self.notes.lost(
                        definition, "the custom property that held a parameter definition is missing", missing, name
                    )
        for definition in self.by_tag.get("schedulerDefinitions", ()):
            for name in PARAMETER_LISTS:
                if name in definition.references:
                    definition.references[name] = [self.parameters.get(p.name, p) for p in definition.references[name]]

    def link_scheduler(self, scheduler: Node) -> None:
        made = scheduler.target("definition")
        if made is None:
            return
        name = made.name
        found = property_of(scheduler, DEFINITION)
        if found is not None and name.startswith(USER_SPECIFIC):
            name = text_of(found.child("value"))
        if name in self.definitions:
            scheduler.references["definition"] = [self.definitions[name]]
            if found is not None:
                _finish(scheduler, found, self.notes)

    def restore_parameters(self, holder: Node, keeper: Node, keys: ParameterKeys, scheduler: Node | None) -> None:
        """Restore the parameters of an allocation, scheduler or association."""
        restored = kept(keeper, keys.parameter)
        defaults = property_of(keeper, keys.defaults)
        defaulted = set() if defaults is None else set(texts_of(defaults.child("value")))
        definition = None if scheduler is None else scheduler.target("definition")
        dropped = []
        for node in holder.all("schedulingParameters"):
            key = node.target("key")
            if key is None:
                continue
            is_filled_in = key.name in _FILLED_IN and _is_zero(node) and definition in self.known
            is_default = key.name in defaulted and _is_default(node, self.parameters.get(key.name))
            if key.name in restored or is_filled_in or is_default:
                dropped.append(node)
            node.references["key"] = [self.parameters.get(key.name, key)]
        remove_all(dropped)
        for name, found in restored.items():
            value, key = found.child("value"), self.parameters.get(name)
            if value is None or key is None:
                continue
            node = holder.add("schedulingParameters", like=found)
            node.refer("key", key)
            node.insert(value)
            node.comments = found.comments
            _finish(keeper, found, self.notes)
        if defaults is not None:
            _finish(keeper, defaults, self.notes)
        order = property_of(keeper, keys.order)
        if order is not None:
            _sort(holder, texts_of(order.child("value")))
            _finish(keeper, order, self.notes)

    def remove_unused(self) -> None:
        """Remove definitions that the step up made, and instead of which others were restored."""
        made = self.by_tag.get("schedulerDefinitions", ())
        used = {node.target("definition") for node in self.schedulers}
        remove_all(node for node in made if node not in used)
        needed = {
            *(
                parameter
                for node in made
                if node in used
                for name in PARAMETER_LISTS
                for parameter in node.references.get(name, ())
            ),
            *(node.target("key") for holder in self.holders for node in holder.all("schedulingParameters")),
        }
        remove_all(node for node in self.by_tag.get("schedulingParameterDefinitions", ()) if node not in needed)


def _is_zero(parameter: Node) -> bool:
    value = parameter.child("value")
    return value is not None and value.get("value", "0") == "0"


def _is_default(parameter: Node, definition: Node | None) -> bool:
    """Whether a parameter states what it would be, anyway."""
    value, default = parameter.child("value"), definition and definition.child("defaultValue")
    return value is not None and default is not None and value.type == default.type and value.attributes == default.attributes


def _sort(holder: Node, names: list[str]) -> None:
    """Put the parameters of a holder in the order of their names; others come last."""
    places = {name: place for place, name in enumerate(names)}
    nodes = holder.all("schedulingParameters")
    holder.take(sorted(nodes, key=lambda node: places.get(_key_name(node), len(places))))


def _key_name(node: Node) -> str:
    key = node.target("key")
    return "" if key is None else key.name
