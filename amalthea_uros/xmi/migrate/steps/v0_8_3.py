"""0.8.2 -> 0.8.3: kinds of stimuli, conditions of mode switches, interface ports."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.steps.tools import add_property, add_value
from amalthea_uros.xmi.tree.classes import reference_text
from amalthea_uros.xmi.tree.model_set import ModelSet, Step
from amalthea_uros.xmi.tree.node import Node
from amalthea_uros.xmi.tree.notes import StepNotes

# Mode switches, whose entries have conditions of their own now

_PROVIDER = "valueProvider"
_SWITCH, _RUNNABLE_SWITCH = "ModeSwitch", "RunnableModeSwitch"


def state_conditions(models: ModelSet, notes: StepNotes) -> None:
    """Label of a switch, and literals of each entry -> condition of each entry: one of the literals."""
    for switch in models.nodes("graphEntries", "runnableItems", "items"):
        if switch.type not in (_SWITCH, _RUNNABLE_SWITCH):
            continue
        label = switch.target(_PROVIDER)
        switch.references.pop(_PROVIDER, None)
        text = switch.attributes.pop(_PROVIDER, None)
        if text is not None:
            notes.lost(switch, "mode label of a switch that is not a reference", text, _PROVIDER)
        entries = switch.all("entries")
        if label is not None and not entries:
            notes.lost(switch, "mode label of a switch without entries", reference_text(label), _PROVIDER)
        for entry in entries:
            _state_condition(entry, label, notes)


def _state_condition(entry: Node, label: Node | None, notes: StepNotes) -> None:
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


_CLASSES = {
    "FInterfacePort": "InterfacePort",
    "SporadicStimulus": "RelativePeriodicStimulus",
    "SyntheticStimulus": "PeriodicSyntheticStimulus",
}

_OLD_NAMES = {new: old for old, new in _CLASSES.items()}

_DEVIATION = "stimulusDeviation"

#: Classes of stimuli -> the old and the new name of a part.
_PARTS = {
    "PeriodicStimulus": (_DEVIATION, "jitter"),
    "PeriodicSyntheticStimulus": ("period", "recurrence"),
    "RelativePeriodicStimulus": (_DEVIATION, "nextOccurrence"),
    "SingleStimulus": ("activation", "occurrence"),
}


def change(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 0.8.2."""
    for node in models.rename_classes(_CLASSES):
        notes.renamed(node, "class renamed", f"{_OLD_NAMES[node.type]} -> {node.type}")
    for stimulus in models.parts("stimuliModel", "stimuli"):
        _change_stimulus(stimulus, notes)
        _keep_deviation(stimulus, _DEVIATION, "deviation of a stimulus", notes)
    for activation in models.parts("swModel", "activations"):
        if activation.type == "VariableRateActivation":
            _keep_deviation(activation, "activationDeviation", "deviation of a variable rate activation", notes)
    state_conditions(models, notes)


def _keep_deviation(holder: Node, tag: str, what: str, notes: StepNotes) -> None:
    for deviation in holder.all(tag):
        deviation.remove()
        text = _outline(deviation)
        if not text:
            notes.lost(holder, what, text)
        else:
            add_property(holder, tag, text)
            notes.kept(holder, what, text)


def _change_stimulus(stimulus: Node, notes: StepNotes) -> None:
    if stimulus.type == "PeriodicStimulus" and ("clock" in stimulus.references or "clock" in stimulus.attributes):
        _follow_clock(stimulus, notes)
    old, new = _PARTS.get(stimulus.type, ("", ""))
    for part in stimulus.all(old):
        part.tag = new
        notes.renamed(part, f"{old} -> {new}")
    if stimulus.type == "RelativePeriodicStimulus" and (description := stimulus.attributes.pop("description", None)):
        notes.lost(stimulus, "description of a sporadic stimulus", repr(description), "description")
    elif stimulus.type == "PeriodicSyntheticStimulus":
        for times in stimulus.all("triggerTimes"):
            for time in times.all("timestamps"):
                time.tag = "occurrenceTimes"
            notes.converted(times, "triggerTimes / timestamps -> occurrenceTimes")
            stimulus.take(times.children)
            times.remove()
    elif stimulus.type == "ArrivalCurveStimulus":
        for entry in stimulus.all("entries"):
            if entry.rename("numberOfEvents", "numberOfOccurrences"):
                notes.renamed(entry, "numberOfEvents -> numberOfOccurrences", attribute="numberOfEvents")


def _follow_clock(stimulus: Node, notes: StepNotes) -> None:
    """A periodic stimulus whose recurrence a clock stretches, becomes one of variable rate."""
    stimulus.type = "VariableRateStimulus"
    notes.converted(stimulus, "PeriodicStimulus with a clock -> VariableRateStimulus with a scenario; its step is not known")
    scenario = stimulus.add("scenario")
    if "clock" in stimulus.references:
        scenario.references["clock"] = stimulus.references.pop("clock")
    else:
        scenario.attributes["clock"] = stimulus.attributes.pop("clock")
    scenario.take(stimulus.all("recurrence"))
    for offset in stimulus.all("offset"):
        notes.kept(offset, "offset of a periodic stimulus with a clock", offset.get("value") + offset.get("unit"))
        offset.type = "TimeObject"
        add_value(scenario, "offset", offset)
    for deviation in stimulus.all(_DEVIATION):
        notes.lost(deviation, "deviation of a periodic stimulus with a clock", _outline(deviation))
        deviation.remove()


def _outline(node: Node) -> str:
    """What the parts of an object are, as text: `lowerBound=1ms, distribution=WeibullEstimators(pRemainPromille=0.5)`."""
    return ", ".join(f"{child.tag}={_value(child)}" for child in node.children)


def _value(node: Node) -> str:
    if "value" in node.attributes:
        return node.get("value") + node.get("unit")
    stated = [f"{name}={text}" for name, text in node.attributes.items()]
    stated += [_outline(node)] if node.children else []
    return node.type + (f"({', '.join(stated)})" if stated else "")


STEP = Step("0.8.2", "0.8.3", change, frozenset({*_CLASSES, _DEVIATION, "triggerTimes", "timestamps"}))
