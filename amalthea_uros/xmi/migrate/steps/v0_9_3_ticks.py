"""0.9.2 -> 0.9.3: execution needs in instructions and overheads of operating systems become ticks."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import partial

from amalthea_uros.xmi.emf.data_types import parse_float
from amalthea_uros.xmi.migrate.steps.tools import insert_after, keep_comments, whole_number
from amalthea_uros.xmi.migrate.steps.v0_9_3_values import Values
from amalthea_uros.xmi.tree.model_set import ModelSet
from amalthea_uros.xmi.tree.node import Node, remove_all
from amalthea_uros.xmi.tree.notes import BEYOND_CONVERTERS, NoteKind, Postponed, StepNotes

#: The key of needs that are instructions, and the category of the feature that says how many of them a cycle executes.
_INSTRUCTIONS = "Instructions"

#: Attributes in instructions.
_DIVIDED = ("value", "lowerBound", "upperBound", "mean", "average")

#: Also in instructions; converted only in versions for which the converters of APP4MC are not published.
_DEVIATION = "sd"

_DIVIDED_EXACTLY = (
    "instructions are divided by the instructions per cycle without cutting off fractions, also standard deviations"
)

_OVERHEADS = ("apiOverhead", "isrCategory1Overhead", "isrCategory2Overhead")


class Ticks:
    """Converts what is stated in instructions; knows how many of them each kind of processing unit executes per cycle."""

    def __init__(self, models: ModelSet, values: Values, notes: StepNotes) -> None:
        self.models, self.notes = models, notes
        self.values = values
        self.known: dict[Node, Fraction | None] = {}
        # Also in files of newer versions: the features of definitions are the same in them.
        definitions = [node for tree in models.trees for node in tree.root.find("hwModel", "definitions")]
        self.definitions = [node for node in definitions if node.type == "ProcessingUnitDefinition"]
        #: Definitions on which an instruction does not take one cycle.
        self.rates = {node: rate for node in self.definitions if (rate := self.rate(node)) is not None and rate != 1}

    def rate(self, definition: Node) -> Fraction | None:
        """Instructions per cycle, None if unknown."""
        if definition not in self.known:
            self.known[definition] = self.find_rate(definition)
        return self.known[definition]

    def find_rate(self, definition: Node) -> Fraction | None:
        """The instructions per cycle of the first feature that states them."""
        features = definition.references.get("features", ())
        feature = next(filter(_is_rate, features), None)
        if feature is not None:
            return self.rate_of(feature)
        for missing in (each.get("path") for each in features):
            if missing.startswith(f"{_INSTRUCTIONS}/"):
                message = "number of instructions per cycle not found in the files; assuming 1"
                self.notes.defaulted(definition, message, missing, "features")
        return None

    def rate_of(self, feature: Node) -> Fraction | None:
        """The value of a feature, None if it cannot be the number of instructions per cycle."""
        try:
            rate = parse_float(feature.get("value", "0"))
        except ValueError:
            rate = 0.0
        if math.isfinite(rate) and rate > 0:
            # The decimal that is written: 7 instructions at 0.7 per cycle are 10 ticks, not a little more.
            return Fraction(repr(rate))
        self.notes.defaulted(feature, "not a number of instructions per cycle; assuming 1", feature.get("value"), "value")
        return None

    # Execution needs

    def convert_needs(self, needs: Sequence[Node]) -> None:
        """Convert the items that state execution needs."""
        if needs and not self.definitions:
            self.notes.defaulted(needs[0], "no definition of a processing unit in the files; assuming 1 instruction per cycle")
        following: dict[Node, Node] = {}
        for node in needs:
            self.convert_need(node, following)
        insert_after(following)

    def convert_need(self, node: Node, following: dict[Node, Node]) -> None:
        """Instructions become ticks; needs of other keys become an item of their own."""
        defaults, extended = node.all("default"), node.all("extended")
        if not defaults and not extended:
            return
        remove_all([*defaults, *extended])
        by_key = self.last_of_each_key(defaults)
        instructions = by_key.pop(_INSTRUCTIONS, None)
        others = list(by_key.values())
        by_definition = self.instructions_by_definition(extended)
        if node.tag == "computationItems":
            for entry in others:
                self.notes.lost(entry, "schedulers no longer have execution needs other than ticks", _shown(entry))
            others = []
        if not instructions and not by_definition:
            if others:
                self.keep_others(node, others)
            else:
                # Without it, the runnable would take no time, instead of an unknown one.
                node.type = "Ticks"
                self.notes.to_check(node, "execution need without content is now Ticks without a number")
            return
        if others:
            following[node] = Node(node.tag, "ExecutionNeed", origin=node.origin)
            self.keep_others(following[node], others)
            self.notes.moved(node, "execution needs other than instructions are now a separate item")
        node.type = "Ticks"
        self.notes.renamed(node, "an execution need in instructions is now Ticks")
        self.fill(node, instructions, by_definition)

    def last_of_each_key(self, entries: list[Node]) -> dict[str, Node]:
        """The entries by their keys; of several with one key the last one counts."""
        found: dict[str, Node] = {}
        for entry in entries:
            key = entry.get("key")
            if key in found:
                self.notes.lost(found[key], "another need of the same key follows", _shown(found[key]))
            found[key] = entry
        return found

    def instructions_by_definition(self, extended: list[Node]) -> list[tuple[Node, Node]]:
        """The entries of definitions, each with its need in instructions."""
        found = []
        for entry in extended:
            values = entry.all("value")
            fitting = [value for value in values if value.get("key") == _INSTRUCTIONS]
            if not values:
                self.notes.lost(entry, "the execution need of a definition has no value")
            for value in values:
                if value not in fitting[:1]:
                    message = "execution needs of definitions no longer have keys other than instructions"
                    self.notes.lost(value, message, _shown(value))
            if fitting:
                found.append((entry, fitting[0]))
        return found

    def keep_others(self, holder: Node, entries: list[Node]) -> None:
        """Make needs that are not in instructions parts of an item for them."""
        kept = []
        for entry in entries:
            stated = self.stated(entry, "value", holder)
            entry.tag = "needs"
            entry.set_children([])
            if stated is not None:
                entry.take([stated])
                kept.append(entry)
        holder.take(kept)

    def stated(self, entry: Node, tag: str, owner: Node) -> Node | None:
        """The value of an entry in the newer form."""
        value = entry.child("value")
        return self.values.number(value, tag, owner) if value else None

    def fill(self, node: Node, default: Node | None, by_definition: list[tuple[Node, Node]]) -> None:
        """Give an item its default ticks, and those of definitions."""
        parts = []
        stated = self.stated(default, "default", node) if default else None
        if default and stated:
            keep_comments(default, stated)
            parts.append(stated)
        for entry, value in by_definition:
            ticks = self.stated(value, "value", node)
            entry.set_children([])
            # An entry without a value would be nothing that can be read.
            if ticks is not None:
                self.divide_for(entry, ticks)
                entry.take([ticks])
                parts.append(entry)
        node.take(parts)
        if stated:
            self.add_definitions(node, stated)

    def divide_for(self, entry: Node, ticks: Node) -> None:
        """Turn the instructions of one definition into ticks."""
        definition = entry.target("key")
        if definition is None or definition.is_proxy:
            self.notes.defaulted(
                entry, "definition of a processing unit not found in the files; assuming 1 instruction per cycle"
            )
            return
        rate = self.rate(definition)
        if rate is not None and rate != 1:
            self.divide(ticks, rate)

    def add_definitions(self, node: Node, default: Node) -> None:
        """Keep what the default meant on definitions on which an instruction does not take one cycle: ticks of their own."""
        if not self.rates:
            return
        known = {target for entry in node.all("extended") for target in entry.references.get("key", ())}
        for definition, rate in self.rates.items():
            if definition not in known:
                entry = node.add("extended", like=default)
                entry.refer("key", definition)
                ticks = entry.add("value", default.type, like=default)
                ticks.attributes = dict(default.attributes)
                self.divide(ticks, rate)

    def divide(self, ticks: Node, rate: Fraction) -> None:
        """Divide by the instructions per cycle; fractions are cut off, as APP4MC does."""
        shown = []
        exact = {}
        for name in (*_DIVIDED, _DEVIATION):
            text = ticks.attributes.get(name)
            if text is None:
                continue
            try:
                quotient, cut = _quotient(text, rate), str(int(float(text) / float(rate)))
            except (ValueError, OverflowError):
                self.notes.lost(ticks, "not a number, so not divided by the instructions per cycle", text, name)
                continue
            if name != _DEVIATION:
                ticks.attributes[name] = cut
                shown.append(f"{name} {text} / {float(rate):g} = {cut}")
            if name == _DEVIATION or quotient.denominator != 1:
                exact[name] = _rounded(name, quotient)
        if shown:
            message = "instructions are now ticks: divided by the instructions per cycle of the definition"
            self.notes.converted(ticks, message, ", ".join(shown))
        if exact:
            self.postpone_exact(ticks, exact)

    def postpone_exact(self, ticks: Node, exact: dict[str, str]) -> None:
        """Divide exactly in versions for which the converters of APP4MC are not published: nothing takes less time then."""
        state = partial(ticks.attributes.update, exact)
        detail = ", ".join(f"{name} {ticks.attributes[name]} -> {text}" for name, text in exact.items())
        self.models.postponed.append(
            Postponed(BEYOND_CONVERTERS, state, NoteKind.CONVERTED, ticks, _DIVIDED_EXACTLY, detail, is_kept=True)
        )

    # Overheads of operating systems

    def convert_overheads(self, overheads: Iterable[Node]) -> None:
        """Convert the numbers of instructions of the functions of operating systems."""
        for node in overheads:
            for group in node.all(*_OVERHEADS):
                for part in group.children:
                    if part.tag != "customProperties" and (part.type or part.attributes or part.child("deviation")):
                        self.convert_overhead(part)

    def convert_overhead(self, part: Node) -> None:
        """Keep the part, with its number as the default."""
        stated = self.values.number(part, "default", part)
        part.type = ""
        part.attributes.pop("value", None)
        properties = part.all("customProperties")
        part.set_children([])
        part.take([*properties, *([stated] if stated else ())])
        self.notes.converted(part, "instructions of the operating system are now ticks")
        if stated:
            self.add_definitions(part, stated)


def _quotient(text: str, rate: Fraction) -> Fraction:
    """Some instructions divided by those per cycle.

    Raises
    ------
    ValueError, OverflowError : the text is no number.
    """
    whole = whole_number(text)
    return (Fraction(float(text)) if whole is None else whole) / rate


def _rounded(name: str, ticks: Fraction) -> str:
    """Ticks as an attribute: bounds are whole numbers, and rounded so that they enclose the exact ones."""
    match name:
        case "mean" | "average" | "sd":
            return repr(float(ticks))
        case "lowerBound":
            return str(math.floor(ticks))
        case _:
            return str(math.ceil(ticks))


def _is_rate(feature: Node) -> bool:
    """Whether a feature is the number of instructions per cycle."""
    return feature.parent is not None and feature.parent.name == _INSTRUCTIONS


def _shown(entry: Node) -> str:
    """Key and content of an entry, for messages."""
    texts = [entry.get("key")]
    for value in entry.find("value"):
        texts += [f"{name}={text}" for part in value.walk() for name, text in part.attributes.items()]
    return " ".join(texts)
