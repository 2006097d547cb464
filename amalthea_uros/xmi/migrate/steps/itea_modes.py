"""Values of labels that select what is executed -> modes: label switches, and conditions of stimuli (ITEA 1.2.0 -> 1.3.0)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from amalthea_uros.xmi.migrate.classes import local_name
from amalthea_uros.xmi.migrate.model_set import ModelSet, Tree
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.itea_tools import SUB_MODELS, by_root, sub_model_or_new, trees_of

_LISTS = {
    "setLabelsList": "setModeValueList",
    "enablingLabelsList": "enablingModeValueList",
    "disablingLabelsList": "disablingModeValueList",
}


def convert_label_values(models: ModelSet, notes: Notes) -> None:
    """Make labels that select something mode labels, and their values literals of modes."""
    converter = _Converter(models, notes)
    converter.convert_stimuli()
    converter.convert_switches()


class _Converter:
    def __init__(self, models: ModelSet, notes: Notes) -> None:
        self.models, self.notes = models, notes
        #: The mode labels that take the place of labels.
        self.made: dict[Node, Node] = {}
        #: Mode labels by name and the root of their file.
        self.known: dict[tuple[Node, str], Node] = {}
        for node in models.nodes("modeLabels"):
            self.known.setdefault((node.root, node.name), node)

    def convert_stimuli(self) -> None:
        """Convert the lists of values that stimuli set, and which enable and disable them."""
        lists = [part for stimulus in self.models.nodes("stimuli") for part in stimulus.all(*_LISTS)]
        for part in lists:
            self.notes.renamed(part, f"{part.tag} is {_LISTS[part.tag]}")
            part.tag = _LISTS[part.tag]
        entries = [entry for part in lists for entry in part.all("entries")]
        self.make_modes(entries, "valueProvider", "mode_stimuli_{}_migration_generated", 1)
        for entry in entries:
            self.provide(entry, "valueProvider")

    def convert_switches(self) -> None:
        """Make label switches mode switches."""
        switches = []
        for switch in self.models.nodes("graphEntries"):
            if local_name(switch.type) != "LabelSwitch":
                continue
            label = switch.target("label")
            self.provide(switch, "label")
            switch.rename("label", "valueProvider")
            switch.type = "sw:ModeSwitch"
            switches.append(switch)
            self.notes.converted(
                switch, "label switch: mode switch on a mode label of the same name", label.name if label else ""
            )
        converted = set(switches)
        entries = [entry for entry in self.models.nodes("entries") if entry.parent in converted]
        self.make_modes(entries, "valueProvider", "mode_sw_{}_migration_generated", 0)

    # Labels

    def provide(self, holder: Node, reference: str) -> None:
        """Let a reference to a label name its mode label."""
        labels = holder.references.get(reference)
        if labels:
            source = holder.root
            holder.references[reference] = [self.mode_label(label, source) for label in labels]

    def mode_label(self, label: Node, source: Node) -> Node:
        """The mode label of the name of a label; the label stays, because others may access it."""
        holder = label.parent
        if label.tag != "labels" or holder is None:
            if label.is_proxy:
                self.notes.lost(source, "mode label of a label that is in no file", label.get("path"))
            return label
        found = self.made.get(label) or (self.known.get((label.root, label.name)) if label.name else None)
        if found is None:
            found = holder.add("modeLabels", like=label)
            found.attributes |= {"name": label.name} if "name" in label.attributes else {}
            found.target_class = "sw:ModeLabel"
            self.notes.converted(label, "label that selects something: a mode label of the same name is added", label.name)
        self.made[label] = found
        return found

    # Values

    def make_modes(self, entries: Iterable[Node], reference: str, name: str, first: int) -> None:
        """One mode for each file: its literals are the different values that its entries state.

        Parameters
        ----------
        reference : that of entries to labels
        name : that of the modes, with a place for the number
        first : number of the first mode
        """
        number = first
        trees = trees_of(self.models)
        converted = [entry for entry in entries if "value" not in entry.references]
        for root, own in by_root(converted).items():
            model = self.model_for(trees[root], own, reference)
            if model is None:
                continue
            mode = model.add("modes", like=own[0], name=name.format(number))
            mode.target_class = "common:Mode"
            number += 1
            self.notes.converted(mode, "values of labels: literals of a new mode", mode.name)
            self.give_literals(mode, own)

    def give_literals(self, mode: Node, entries: Sequence[Node]) -> None:
        """Make the values of entries references to literals of a mode."""
        literals: dict[str, Node] = {}
        for entry in entries:
            # The default of the attribute was 0.
            value = entry.attributes.pop("value", "0")
            literal = literals.get(value)
            if literal is None:
                literal = literals[value] = mode.add("literals", like=entry, name=value)
                literal.target_class = "common:ModeLiteral"
            entry.refer("value", literal)

    def model_for(self, tree: Tree, entries: Sequence[Node], reference: str) -> Node | None:
        """The software model that the mode of a file belongs to: its own; a new one, or that of the labels if the file has no place."""
        own = tree.root if tree.root.tag == "SWModel" else tree.root.child("swModel")
        if own is not None:
            return own
        for entry in entries if tree.root.tag in SUB_MODELS else ():
            label = entry.target(reference)
            if (
                label is not None
                and label.parent is not None
                and "swModel" in (label.parent.tag, SUB_MODELS.get(label.parent.tag))
            ):
                return label.parent
        return sub_model_or_new(tree, "swModel")
