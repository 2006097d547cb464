"""0.9.4 -> 0.9.5: one kind of call graph for processes and runnables, and new clocks."""

from __future__ import annotations

from decimal import Decimal, InvalidOperation
from functools import partial
from typing import NamedTuple

from amalthea_uros.xmi.migrate.steps.tools import add_property, attributes_text, by_class, keep_comments, quantity_text
from amalthea_uros.xmi.tree.model_set import ModelSet, Step
from amalthea_uros.xmi.tree.node import Node
from amalthea_uros.xmi.tree.notes import BEYOND_CONVERTERS, NoteKind, Postponed, StepNotes

# Clocks: they are described by frequencies now, whose units the older version does not state

#: The key of the custom properties that keep the older definition, as APP4MC writes it.
_KEY = "old_definition_v0.9.4"

_MESSAGE = "the definition of a clock has no successor whose meaning is certain"


class _Function(NamedTuple):
    """The shape of a clock: its name since 0.9.5, and its numbers, in the order in which they are written down."""

    curve: str
    numbers: tuple[str, str]


_FUNCTIONS = {
    "ClockSinusFunction": _Function("sine", ("amplitude", "yOffset")),
    "ClockTriangleFunction": _Function("triangle", ("max", "min")),
}
_TIMES = {"period": "period", "shift": "xOffset"}
_LIST = "ClockMultiplierList"

_CLASSES = {**dict.fromkeys(_FUNCTIONS, "ClockFunction"), _LIST: "ClockStepList"}


def convert_clocks(models: ModelSet, notes: StepNotes) -> None:
    """Convert scenarios and clocks; references to clocks follow."""
    for node in models.nodes("scenario"):
        _keep_recurrence(node, notes)
    found = by_class(models, (*_FUNCTIONS, _LIST))
    for node in models.proxies:
        node.target_class = _CLASSES.get(node.target_class, node.target_class)
    for name, function in _FUNCTIONS.items():
        _postpone_curves(models, found[name])
        _convert_functions(found[name], function, notes)
    for node in found[_LIST]:
        _convert_list(node, notes)


def _keep_recurrence(scenario: Node, notes: StepNotes) -> None:
    for recurrence in scenario.all("recurrence"):
        text = f"recurrence={quantity_text(recurrence)}"
        recurrence.remove()
        keep_comments(recurrence, scenario)
        add_property(scenario, _KEY, text)
        notes.kept(recurrence, "the recurrence of a scenario has no successor", text)


def _convert_functions(clocks: list[Node], function: _Function, notes: StepNotes) -> None:
    for clock in clocks:
        clock.type = "ClockFunction"
        clock.attributes["curveType"] = function.curve
        texts = [f"{name}={clock.attributes.pop(name)}" for name in function.numbers if name in clock.attributes]
        for part in clock.all(*_TIMES):
            texts.append(f"{part.tag}={quantity_text(part)}")
            keep_comments(part, clock)
            part.remove()
        if texts:
            add_property(clock, _KEY, " ".join(texts))
            notes.kept(clock, _MESSAGE, " ".join(texts))


def _postpone_curves(models: ModelSet, clocks: list[Node]) -> None:
    """State the curves in the newer form, too, in versions for which the converters of APP4MC are not published."""
    for clock in clocks:
        parts = [_time(new, part) for old, new in _TIMES.items() for part in clock.all(old)]
        parts += _frequencies(clock)
        if parts:
            message = "curve of a clock: the unit of its frequencies was not stated"
            state = partial(clock.take, parts)
            models.postponed.append(Postponed(BEYOND_CONVERTERS, state, NoteKind.TO_CHECK, clock, message, is_kept=True))


def _time(tag: str, old: Node) -> Node:
    return Node(tag, "", dict(old.attributes), old.origin)


def _frequencies(clock: Node) -> list[Node]:
    """Height and offset of the curve, as far as they are stated."""
    amplitude, offset = _number(clock, "amplitude"), _number(clock, "yOffset")
    highest, lowest = _number(clock, "max"), _number(clock, "min")
    height = 2 * amplitude if amplitude is not None else None
    if highest is not None and lowest is not None:
        height = highest - lowest
    stated = {"peakToPeak": height, "yOffset": offset if offset is not None else lowest}
    return [Node(tag, "", {"value": str(value)}, clock.origin) for tag, value in stated.items() if value is not None]


def _number(clock: Node, name: str) -> Decimal | None:
    try:
        number = Decimal(clock.get(name))
    except InvalidOperation:
        return None
    return number if number.is_finite() else None


def _convert_list(clock: Node, notes: StepNotes) -> None:
    clock.type = "ClockStepList"
    for entry in clock.all("entries"):
        if "multiplier" in entry.attributes:
            text = f"multiplier={entry.attributes.pop('multiplier')}"
            add_property(entry, _KEY, text)
            notes.kept(entry, _MESSAGE, text)


_RENAMED = {
    "TaskRunnableCall": "RunnableCall",
    "RunnableModeSwitch": "ModeSwitch",
    "RunnableProbabilitySwitch": "ProbabilitySwitch",
}

#: Steps of a call sequence that have no counter any more; calls of runnables have one again soon.
_WITHOUT_COUNTER = ("EnforcedMigration", "SchedulePoint")


def change(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 0.9.4."""
    found = by_class(models, ("CallSequence", *_RENAMED, *_WITHOUT_COUNTER))
    for node in models.nodes("graphEntries"):
        node.tag = "items"
        notes.renamed(node, "graphEntries of a call graph are now items")
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


def _convert_sequence(node: Node, notes: StepNotes) -> None:
    """Convert a sequence to an ordered group."""
    node.type = "Group"
    node.attributes["ordered"] = "true"
    if not node.name:
        node.attributes["name"] = "CallSequence"
    for call in node.all("calls"):
        call.tag = "items"
    notes.renamed(node, "CallSequence is now an ordered Group", node.name)


def _keep_counter(node: Node, notes: StepNotes) -> None:
    for counter in node.all("counter"):
        text = attributes_text(counter, " ")
        counter.remove()
        keep_comments(counter, node)
        add_property(node, "counter", text)
        notes.kept(counter, f"{node.type} no longer has a counter", text)


def _make_graph(runnable: Node, notes: StepNotes) -> None:
    """Every runnable has a call graph, as in APP4MC, if an empty one."""
    items = runnable.all("runnableItems")
    graph = runnable.child_or_new("callGraph")
    for item in items:
        item.tag = "items"
    graph.take(items)
    if items:
        notes.moved(runnable, "the items of a runnable are now in a call graph")


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
