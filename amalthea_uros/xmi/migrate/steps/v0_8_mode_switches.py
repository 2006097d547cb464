"""Mode switches, whose entries have conditions of their own from AMALTHEA 0.8.3 on."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.names import reference_text
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes

_PROVIDER = "valueProvider"
_SWITCH, _RUNNABLE_SWITCH = "ModeSwitch", "RunnableModeSwitch"


def state_conditions(models: ModelSet, notes: Notes) -> None:
    """Label of a switch, and literals of each entry -> condition of each entry: one of the literals."""
    for switch in models.nodes("graphEntries", "runnableItems", "items"):
        if switch.type not in (_SWITCH, _RUNNABLE_SWITCH):
            continue
        _change(switch, notes)


def _change(switch: Node, notes: Notes) -> None:
    labels = switch.references.pop(_PROVIDER, [])
    text = switch.attributes.pop(_PROVIDER, None)
    if text is not None:
        notes.lost(switch, "mode label of a switch that is not a reference", text, _PROVIDER)
    label = labels[0] if labels else None
    entries = switch.all("entries")
    if label is not None and not entries:
        notes.lost(switch, "mode label of a switch without entries", reference_text(label), _PROVIDER)
    for entry in entries:
        _state_condition(entry, label, notes)


def _state_condition(entry: Node, label: Node | None, notes: Notes) -> None:
    literals = entry.references.pop("values", [])
    text = entry.attributes.pop("values", None)
    if text is not None:
        notes.lost(entry, "mode literal of a switch that is not a reference", text, "values")
    if not literals and entry.child("condition"):
        return  # converted before
    condition = entry.child_or_new("condition")
    for literal in literals:
        value = condition.add("entries", "ModeValue")
        value.refer("value", literal)
        if label is None:
            continue
        value.refer(_PROVIDER, label)
    notes.converted(entry, "mode label and literals of a switch -> condition", ", ".join(map(reference_text, literals)))
