"""Items of runnables in 0.7.2: instructions, groups and probability groups."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node, remove_all
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.v0_7_tools import content_of

_ITEMS = ("runnableItems", "runnableItem", "items")

_INSTRUCTIONS = frozenset({"InstructionsConstant", "InstructionsDeviation"})


def change_runnable_items(models: ModelSet, notes: Notes) -> None:
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


def _wrap_instructions(item: Node, notes: Notes) -> None:
    """The item stays, and what it said becomes a part of it."""
    default = Node("default", item.type, item.attributes, item.origin)
    default.references = item.references
    # Instructions have no custom properties any more.
    moved = [child for child in item.children if child.tag != "customProperties"]
    default.take(moved)
    item.insert(default)
    item.type, item.attributes, item.references = "RunnableInstructions", {}, {}
    notes.converted(item, f"{default.type} -> RunnableInstructions with default")


def _unwrap_items(group: Node, notes: Notes) -> None:
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


def _unwrapped(wrapper: Node, notes: Notes) -> list[Node]:
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


def _make_switch(group: Node, notes: Notes) -> None:
    group.type = "RunnableProbabilitySwitch"
    notes.converted(group, "ProbabilityGroup -> RunnableProbabilitySwitch")
    for entry in group.all("items"):
        entry.tag = "entries"
        for item in entry.all("runnableItem"):
            item.tag = "items"
