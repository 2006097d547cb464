"""0.9.3 -> 0.9.4: modes as text, deadlines of runnables as requirements, aliases of data types."""

from __future__ import annotations

from urllib.parse import unquote_plus

from amalthea_uros.xmi.migrate.steps.tools import add_property, by_class, names_of
from amalthea_uros.xmi.tree.model_set import ModelSet, Step
from amalthea_uros.xmi.tree.node import Node, proxy
from amalthea_uros.xmi.tree.notes import BEYOND_CONVERTERS, NoteKind, Postponed, StepNotes

# Modes: what mode labels are set to and compared with is text now, and conditions have relations

_CLASSES = {
    "Mode": "EnumMode",
    "ModeValueConjunction": "ModeConditionConjunction",
    "ModeValueDisjunction": "ModeConditionDisjunction",
}

#: Elements with a list of alternatives, each a comparison or a conjunction of some.
_DISJUNCTIONS = ("condition", "enablingModeValueList", "disablingModeValueList")

_CONJUNCTION = "ModeConditionConjunction"

#: A mode label and the name of a literal.
Comparison = tuple[Node, str]


class ModeConversion:
    """Converts modes, mode labels, and everything that sets or compares them."""

    def __init__(self, models: ModelSet, notes: StepNotes) -> None:
        self.models, self.notes = models, notes
        modes = [node for tree in models.trees for node in tree.root.find("swModel", "modes")]
        self.by_name = {node.name: node for node in reversed(modes)}
        #: Modes of the literals with which mode labels are used.
        self.used: dict[Node, dict[Node, None]] = {}
        #: Modes in no file, by their encoded names.
        self.proxies: dict[str, Node] = {}

    def convert(self) -> None:
        """Convert everything, uses before labels: those without an initial value have the mode of their uses."""
        for node in self.models.proxies:
            node.target_class = _CLASSES.get(node.target_class, node.target_class)
        for node in self.models.nodes("modes"):
            node.type = node.type if node.type not in ("", "Mode") else "EnumMode"
        for node in by_class(self.models, ("ModeLabelAccess",))["ModeLabelAccess"]:
            self.convert_access(node)
        for node in self.models.nodes("setModeValueList"):
            for entry in node.all("entries"):
                self.convert_assignment(entry)
        for node in self.models.nodes(*_DISJUNCTIONS):
            self.convert_disjunction(node)
        for node in self.models.nodes("modeLabels"):
            self.convert_label(node)

    def convert_label(self, node: Node) -> None:
        """The mode is a reference of its own, and the initial value the name of a literal."""
        literal = node.target("initialValue")
        if literal is not None:
            del node.references["initialValue"]
            node.attributes["initialValue"] = literal_name(literal)
            mode = self.mode_of(literal)
            if mode is not None:
                node.references["mode"] = [mode]
            self.notes.converted(node, "the initial value of a mode label is now text", literal_name(literal), "initialValue")
        elif not node.references.get("mode"):
            self.restore_mode(node, list(self.used.get(node, ())))

    def restore_mode(self, node: Node, used: list[Node]) -> None:
        """Give a mode label without initial value the mode that it had until 0.8.0, or the only one of its uses."""
        stated = self.models.set_aside.pop((node, "mode"), [])
        if stated:
            node.refer("mode", *stated)
            self.notes.moved(node, "the mode of a mode label is stated again", stated[0].name, "mode")
        elif len(used) == 1:
            node.refer("mode", *used)
            self.notes.defaulted(node, "a mode label without initial value has the mode of its uses", names_of(used), "mode")
        else:
            message = "mode label without initial value: its mode, which is mandatory now, is not known"
            self.notes.to_check(node, message, names_of(used), "mode")

    def convert_access(self, node: Node) -> None:
        """`write` is called `set`."""
        if node.get("access") == "write":
            node.attributes["access"] = "set"
            self.notes.renamed(node, "access 'write' of a mode label is now 'set'", attribute="access")
        node.rename("modeValue", "value")
        self.convert_value(node, node.target("data"))

    def convert_assignment(self, node: Node) -> None:
        """An entry of the list of what a stimulus sets."""
        if node.type == "ModeValue":
            # The class is abstract now; the only one that can be here needs not be stated.
            node.type = ""
        node.rename("valueProvider", "label")
        self.convert_value(node, node.target("label"))

    def convert_disjunction(self, node: Node) -> None:
        """The alternatives of a condition."""
        node.type = _CLASSES.get(node.type, node.type)
        for entry in node.all("entries"):
            if entry.type in ("ModeValueConjunction", _CONJUNCTION):
                entry.type = _CONJUNCTION
                for part in entry.all("entries"):
                    self.convert_comparison(part, "")
            elif entry.type in ("", "ModeValue"):
                self.convert_comparison(entry, "ModeCondition")

    def convert_comparison(self, node: Node, class_name: str) -> None:
        """A label and a literal: their relation is stated now."""
        if "relation" in node.attributes:
            return
        node.type = class_name
        node.attributes["relation"] = "EQUAL"
        node.rename("valueProvider", "label")
        self.convert_value(node, node.target("label"))
        self.notes.converted(node, "a mode value in a condition is now a comparison")

    def convert_value(self, node: Node, label: Node | None) -> None:
        """Replace the reference to a literal by its name."""
        literal = node.target("value")
        if literal is None:
            return
        del node.references["value"]
        node.attributes["value"] = literal_name(literal)
        mode = self.mode_of(literal)
        if label is not None and mode is not None:
            self.used.setdefault(label, {})[mode] = None

    def mode_of(self, literal: Node) -> Node | None:
        """The mode of a literal, None if unknown."""
        if not literal.is_proxy:
            return literal.parent if literal.parent is not None and literal.parent.tag == "modes" else None
        path = literal.get("path").rpartition("/")[0]
        if not path:
            return None
        if unquote_plus(path) in self.by_name:
            return self.by_name[unquote_plus(path)]
        if path not in self.proxies:
            self.proxies[path] = proxy(path, "EnumMode")
            self.models.proxies.append(self.proxies[path])
        return self.proxies[path]

    # What enables and disables stimuli

    def convert_stimuli(self) -> None:
        """One condition instead of a list that enables and one that disables; after all comparisons."""
        for node in self.models.nodes("enablingModeValueList"):
            node.tag = "executionCondition"
            self.notes.renamed(node, "enablingModeValueList is now executionCondition")
        for node in self.models.nodes("disablingModeValueList"):
            self.dissolve(node)

    def dissolve(self, disabling: Node) -> None:
        """Say the opposite of a list that disables, where that can be said."""
        stimulus = disabling.parent
        if stimulus is None:
            return
        disabling.remove()
        entries = disabling.all("entries")
        comparisons = [comparison for entry in entries if (comparison := _comparison(entry)) is not None]
        if not entries:
            self.notes.lost(disabling, "an empty disablingModeValueList")
        elif len(comparisons) < len(entries):
            add_property(stimulus, "disablingModeValueList", _text(disabling))
            message = "disablingModeValueList with more than single values; the stimulus is enabled without regard to it"
            self.notes.kept(disabling, message, _text(disabling))
        else:
            self.exclude(stimulus, comparisons, disabling)
            self.notes.converted(disabling, "disablingModeValueList is now part of executionCondition", _text(disabling))

    def exclude(self, stimulus: Node, comparisons: list[Comparison], like: Node) -> None:
        """Enable a stimulus only where none of some comparisons is true."""
        condition = stimulus.child_or_new("executionCondition", like)
        alternatives = condition.all("entries")
        if not alternatives:
            single = len(comparisons) == 1
            holder = condition if single else condition.add("entries", _CONJUNCTION, like=like)
            for comparison in comparisons:
                _add_unequal(holder, "ModeCondition" if single else "", comparison, like)
            return
        for entry in alternatives:
            stated = [_comparison(part) for part in (entry.all("entries") if entry.type == _CONJUNCTION else [entry])]
            needed = [comparison for comparison in comparisons if not _is_implied(comparison, stated)]
            if not needed:
                continue
            holder = entry
            if entry.type != _CONJUNCTION:
                holder = entry.wrap("entries", _CONJUNCTION)
                entry.type = ""
            for comparison in needed:
                _add_unequal(holder, "", comparison, like)


def literal_name(literal: Node) -> str:
    """The name of a literal, also of one in no file."""
    return unquote_plus(literal.get("path").rpartition("/")[2]) if literal.is_proxy else literal.name


def _comparison(node: Node) -> Comparison | None:
    """The label and the literal to which it has to be equal; None for anything else."""
    label = node.target("label")
    if label is None or "value" not in node.attributes or node.get("relation") != "EQUAL":
        return None
    return label, node.attributes["value"]


def _is_implied(unequal: Comparison, stated: list[Comparison | None]) -> bool:
    """Whether a label is certainly not equal to a literal, because it is equal to another one."""
    return any(one is not None and one[0] is unequal[0] and one[1] != unequal[1] for one in stated)


def _add_unequal(holder: Node, class_name: str, comparison: Comparison, like: Node) -> None:
    label, literal = comparison
    made = holder.add("entries", class_name, like=like, value=literal, relation="NOT_EQUAL")
    made.refer("label", label)


def _text(disjunction: Node) -> str:
    """A condition in words, for messages and custom properties."""
    texts = []
    for entry in disjunction.all("entries"):
        parts = entry.all("entries") if entry.type == _CONJUNCTION else [entry]
        texts.append(" AND ".join(map(_comparison_text, parts)))
    return " OR ".join(f"({text})" if " AND " in text else text for text in texts)


def _comparison_text(node: Node) -> str:
    label = node.target("label")
    name = "" if label is None else unquote_plus(label.get("path")) if label.is_proxy else label.name
    return f"{name} == {node.get('value')}"


def change(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 0.9.3."""
    for node in models.parts("swModel", "runnables"):
        _move_deadlines(node, models, notes)
    for node in models.nodes("dataMapping"):
        node.tag = "aliases"
        node.rename("platformName", "target")
        node.rename("platformType", "alias")
        notes.renamed(node, "the mapping of a data type to a platform is now an alias", node.get("alias"))
    for node in models.nodes("ports"):
        if node.get("portInterface") == "ABH":
            node.attributes["portInterface"] = "AHB"
            notes.renamed(node, "the port interface ABH is now spelled AHB", attribute="portInterface")
    modes = ModeConversion(models, notes)
    modes.convert()
    modes.convert_stimuli()


def _move_deadlines(runnable: Node, models: ModelSet, notes: StepNotes) -> None:
    """Make requirements of the deadlines of a runnable."""
    for deadline in runnable.all("deadline"):
        constraints = runnable.root.child_or_new("constraintsModel")
        requirement = constraints.add("requirements", "RunnableRequirement", like=deadline, name="deadline")
        requirement.refer("runnable", runnable)
        limit = requirement.add("limit", "TimeRequirementLimit", like=deadline, limitType="UpperLimit", metric="ResponseTime")
        deadline.tag = "limitValue"
        limit.insert(deadline)
        notes.moved(deadline, "the deadline of a runnable is now a requirement", deadline.get("value") + deadline.get("unit"))
        if "value" not in deadline.attributes:
            # It would be one for a response time of 0.
            drop, message = requirement.remove, "a deadline without value is no requirement"
            models.postponed.append(Postponed(BEYOND_CONVERTERS, drop, NoteKind.CONVERTED, deadline, message, is_kept=True))


STEP = Step(
    "0.9.3",
    "0.9.4",
    change,
    frozenset(
        {
            *("ModeValue", "ModeValueConjunction", "ModeValueDisjunction"),
            *("dataMapping", "enablingModeValueList", "disablingModeValueList", "deadline"),
        }
    ),
)
