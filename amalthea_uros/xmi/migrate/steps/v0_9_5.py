"""0.9.4 -> 0.9.5: one kind of call graph for processes and runnables, and new clocks."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.step import Step
from amalthea_uros.xmi.migrate.steps.properties import add_property
from amalthea_uros.xmi.migrate.steps.v0_9_5_clocks import convert_clocks
from amalthea_uros.xmi.migrate.steps.v0_9_parts import by_class, keep_comments

_RENAMED = {
    "TaskRunnableCall": "RunnableCall",
    "RunnableModeSwitch": "ModeSwitch",
    "RunnableProbabilitySwitch": "ProbabilitySwitch",
}

#: Steps of a call sequence that have no counter any more; calls of runnables have one again soon.
_WITHOUT_COUNTER = ("EnforcedMigration", "SchedulePoint")


def change(models: ModelSet, notes: Notes) -> None:
    """Change the content of the files of AMALTHEA 0.9.4."""
    found = by_class(models, ("CallSequence", *_RENAMED, *_WITHOUT_COUNTER))
    for node in models.nodes("graphEntries"):
        node.tag = "items"
        notes.renamed(node, "graphEntries of a call graph are items now")
    for node in found["CallSequence"]:
        _convert_sequence(node, notes)
    for old, new in _RENAMED.items():
        for node in found[old]:
            node.type = new
            notes.renamed(node, f"{old} is {new} now")
    for name in _WITHOUT_COUNTER:
        for node in found[name]:
            _keep_counter(node, notes)
    for node in models.parts("swModel", "runnables"):
        _make_graph(node, notes)
    convert_clocks(models, notes)


def _convert_sequence(node: Node, notes: Notes) -> None:
    """Convert a sequence to an ordered group."""
    node.type = "Group"
    node.attributes["ordered"] = "true"
    if not node.name:
        node.attributes["name"] = "CallSequence"
    for call in node.all("calls"):
        call.tag = "items"
    notes.renamed(node, "CallSequence is an ordered Group now", node.name)


def _keep_counter(node: Node, notes: Notes) -> None:
    for counter in node.all("counter"):
        text = " ".join(f"{name}={value}" for name, value in counter.attributes.items())
        counter.remove()
        keep_comments(counter, node)
        add_property(node, "counter", text)
        notes.kept(counter, f"{node.type} has no counter any more", text)


def _make_graph(runnable: Node, notes: Notes) -> None:
    """Every runnable has a call graph, as in APP4MC, if an empty one."""
    items = runnable.all("runnableItems")
    graph = runnable.child_or_new("callGraph")
    for item in items:
        item.tag = "items"
    graph.take(items)
    if items:
        notes.moved(runnable, "the items of a runnable are in a call graph now")


STEP = Step(
    "0.9.4",
    "0.9.5",
    change,
    frozenset(
        {
            *("graphEntries", "runnableItems", "CallSequence", "TaskRunnableCall", "RunnableModeSwitch"),
            *("RunnableProbabilitySwitch", "ClockSinusFunction", "ClockTriangleFunction", "ClockMultiplierList"),
        }
    ),
)
