"""0.7.0 -> 0.7.1: sections, sizes, frequencies, switches and timing constraints."""

from __future__ import annotations

from collections.abc import Iterable
from decimal import Decimal
from math import isfinite

from amalthea_uros.xmi.migrate.steps.file_roots import wrap_roots
from amalthea_uros.xmi.migrate.steps.tools import content_of, free_key, names_of, remove_and_keep
from amalthea_uros.xmi.tree.model_set import ModelSet, Step
from amalthea_uros.xmi.tree.node import Node, remove_all
from amalthea_uros.xmi.tree.notes import StepNotes

# Sections: their members name them, and no longer the other way round

#: Reference of a section -> element of the members.
_MEMBERS = {"labels": "labels", "runEntities": "runnables"}


def change_sections(models: ModelSet, notes: StepNotes) -> None:
    """Give labels and runnables their section, and map sections to memories in the new way."""
    for section in models.nodes("sections"):
        for reference, tag in _MEMBERS.items():
            for member in section.references.pop(reference, ()):
                _place(member, tag, section, notes)
            if text := section.attributes.pop(reference, ""):
                notes.lost(section, "members of a section that are no references", text, reference)
        sizes = section.all("size")
        remove_all(sizes)
        for size in sizes:
            notes.lost(section, "size of a section", content_of(size))
    _change_mappings(models, notes)
    _remove_constraints(models, notes)


def _place(member: Node, tag: str, section: Node, notes: StepNotes) -> None:
    if member.tag != tag:
        why = "in no file of the set" if member.is_proxy else "of another kind"
        notes.lost(section, f"member of a section that is {why}", names_of([member]))
        return
    placed = member.target("section")
    if placed is None:
        member.refer("section", section)
        notes.moved(member, "member of a section -> reference of the member to the section", section.name)
    elif placed is not section:
        notes.lost(member, "another section of a label or runnable: only the first is kept", section.name)


def _change_mappings(models: ModelSet, notes: StepNotes) -> None:
    lost = []
    for mapping in models.nodes("mapping"):
        if mapping.type != "SectionMapping":
            continue
        if "section" not in mapping.references or "memory" not in mapping.references:
            notes.lost(mapping, "mapping of a section", content_of(mapping))
            lost.append(mapping)
            continue
        mapping.tag, mapping.type = "physicalSectionMapping", ""
        mapping.rename("section", "origin")
        mapping.rename("memoryPositionAddress", "startAddress")
        notes.converted(mapping, "SectionMapping -> PhysicalSectionMapping", names_of(mapping.references["origin"]))
    remove_all(lost)


def _remove_constraints(models: ModelSet, notes: StepNotes) -> None:
    constraints = [node for node in models.nodes("mappingConstraints") if node.type == "SectionMappingConstraint"]
    # Without a condition for the memory a constraint says nothing.
    kept = [node for node in constraints if node.child("hwConstraint") is not None]
    for constraint in kept:
        notes.kept(constraint, "constraint for the mapping of a section", names_of(constraint.references.get("section", ())))
    remove_and_keep(kept, "0.7.1")
    lost = [node for node in constraints if node.parent is not None]
    for constraint in lost:
        notes.lost(constraint, "constraint for the mapping of a section", content_of(constraint))
    remove_all(lost)


def name_mappings(models: ModelSet, notes: StepNotes) -> None:
    """Name what was a SectionMapping, which had no name; what it is now needs one from 0.7.2 on."""
    labels = models.origins.labels
    mappings = models.parts("mappingModel", "physicalSectionMapping")
    used = {mapping.name for mapping in mappings}
    for mapping in mappings:
        if mapping.name or labels[mapping.origin][0] != "mapping":
            continue
        ends = [target.name for name in ("origin", "memory") for target in mapping.references.get(name, ())]
        mapping.attributes["name"] = free_key("_".join(filter(None, ends)) or "mapping", used)
        used.add(mapping.name)
        notes.defaulted(mapping, "name of a PhysicalSectionMapping", mapping.name)


# Timing, affinity and sequencing constraints

#: Old class -> new class.
RENAMED_CONSTRAINTS = {
    "AgeConstraint": "EventChainLatencyConstraint",
    "ReactionConstraint": "EventChainLatencyConstraint",
    "SynchronisationConstraint": "EventSynchronizationConstraint",
}

#: Classes without successor.
REMOVED_CONSTRAINTS = frozenset({"OrderConstraint", "SchedulerPairingConstraint", "SchedulerSeparationConstraint"})

_LATENCY_TYPES = {"AgeConstraint": "Age", "ReactionConstraint": "Reaction"}


def change_constraints(models: ModelSet, notes: StepNotes) -> None:
    """Change everything below constraintsModel."""
    for constraint in models.nodes("timingConstraints"):
        if constraint.type in _LATENCY_TYPES:
            constraint.attributes["type"] = _LATENCY_TYPES[constraint.type]
        elif constraint.type == "DelayConstraint" and "mappingType" not in constraint.attributes:
            constraint.attributes["mappingType"] = "Reaction"
            notes.defaulted(
                constraint, "mappingType of a delay constraint: Reaction is what 0.7.0 meant", attribute="mappingType"
            )
        if constraint.type in RENAMED_CONSTRAINTS:
            notes.renamed(constraint, f"{constraint.type} -> {RENAMED_CONSTRAINTS[constraint.type]}")
    models.rename_classes(RENAMED_CONSTRAINTS)
    removed = [node for node in models.nodes("timingConstraints", "affinityConstraints") if node.type in REMOVED_CONSTRAINTS]
    for constraint in removed:
        notes.kept(constraint, f"{constraint.type}: there is no successor", constraint.name)
    remove_and_keep(removed, "0.7.1")
    for constraint in models.nodes("runnableSequencingConstraints"):
        _change_groups(constraint, notes)


def _change_groups(constraint: Node, notes: StepNotes) -> None:
    entries = []
    for group in constraint.all("runnableGroups"):
        grouping = group.attributes.pop("groupingType", "")
        if grouping == "atLeastOneOfThem":
            notes.lost(
                group,
                "grouping of a runnable sequencing constraint: all of the runnables are meant now",
                grouping,
                "groupingType",
            )
        of_group = group.all("entries")
        entries += of_group
        # The same runnable once.
        runnables = dict.fromkeys(target for entry in of_group for target in entry.references.pop("runnable", ()))
        if runnables:
            group.refer("runnables", *runnables)
            notes.converted(group, "entries of a group of runnables -> references", names_of(runnables))
    remove_all(entries)
    _move_scope(constraint, entries, notes)


def _move_scope(constraint: Node, entries: list[Node], notes: StepNotes) -> None:
    """The scope of all entries can be that of the constraint; scopes that differ have no place any more."""
    scopes = {tuple(entry.references.pop("processScope", ())) for entry in entries}
    if len(scopes) == 1 and "processScope" not in constraint.references and (scope := next(iter(scopes))):
        constraint.refer("processScope", *scope)
        notes.moved(
            constraint, "processScope of all entries -> processScope of the constraint", names_of(scope), "processScope"
        )
    elif any(scopes):
        detail = names_of(dict.fromkeys(target for scope in scopes for target in scope))
        notes.lost(constraint, "scopes of single runnables in a sequencing constraint", detail, "processScope")
    for entry in entries:
        if rest := content_of(entry):
            notes.lost(constraint, "content of an entry of a group of runnables", rest)


_SWITCHES = frozenset({"ModeSwitch", "ProbabiltitySwitch"})

_TRUE = frozenset({"true", "1"})


def change(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 0.7.0."""
    wrap_roots(models, notes)
    change_sections(models, notes)
    _state_units(models.nodes("size"), notes)
    _make_element(models.nodes("memoryTypes", "memoryTypeDefinitions"), "size", notes)
    for quartz in models.nodes("quartzes"):
        if "frequency" in quartz.attributes:
            # As in APP4MC, which writes the integer as Java writes a double.
            quartz.attributes["frequency"] = java_double(quartz.attributes["frequency"])
    _make_element(models.nodes("quartzes"), "frequency", notes)
    _change_switches(models, notes)
    change_constraints(models, notes)


def _state_units(sizes: Iterable[Node], notes: StepNotes) -> None:
    for size in sizes:
        bits = size.attributes.pop("numberBits", None)
        # Those of sections are not there any more.
        if bits is not None and size.parent is not None:
            size.attributes |= {"value": bits, "unit": "bit"}
            notes.converted(size, "number of bits -> value with unit", f"{bits} bit", "numberBits")


def _make_element(holders: Iterable[Node], name: str, notes: StepNotes) -> None:
    """An attribute becomes an element with a value. Its unit stays unstated: 0.7.0 did not state it either."""
    for holder in holders:
        text = holder.attributes.pop(name, None)
        if text is None:
            continue
        holder.child_or_new(name).attributes.setdefault("value", text)
        notes.converted(
            holder,
            f"{name} of {holder.tag} -> element with value; neither version states its unit",
            text,
            name,
        )


def java_double(text: str) -> str:
    """A number as Java writes doubles (2.0E8); any other text as it is."""
    try:
        number = float(text)
    except ValueError:
        return text
    if number == 0 or 0.001 <= abs(number) < 1e7 or not isfinite(number):
        return repr(number) if isfinite(number) else text
    sign, digits, exponent = Decimal(repr(number)).normalize().as_tuple()
    first, *rest = map(str, digits)
    return f"{'-' * sign}{first}.{''.join(rest) or '0'}E{int(exponent) + len(rest)}"


def _change_switches(models: ModelSet, notes: StepNotes) -> None:
    """Entries of switches in call graphs."""
    for switch in models.nodes("graphEntries", "items"):
        if switch.type not in _SWITCHES:
            continue
        entries = switch.all("entries")
        for entry in entries:
            nested = entry.all("graphEntries")
            for item in nested:
                item.tag = "items"
            if nested:
                notes.renamed(entry, "graphEntries of a switch entry -> items")
            if entry.rename("value", "values"):
                notes.renamed(entry, "value of a switch entry -> values", attribute="value")
        if switch.type == "ModeSwitch":
            _find_default(switch, entries, notes)


def _find_default(switch: Node, entries: Iterable[Node], notes: StepNotes) -> None:
    """The first default entry of a mode switch gets an element of its own."""
    found = switch.child("defaultEntry")
    for entry in entries:
        stated = entry.attributes.pop("default", None)
        if stated not in _TRUE:
            continue
        if found is not None:
            notes.lost(entry, "second default entry of a mode switch: it is an ordinary entry now")
            continue
        found = entry
        entry.tag = "defaultEntry"
        values = names_of(entry.references.pop("values", ()))
        entry.attributes.pop("values", None)
        notes.converted(entry, "entry of a mode switch with default -> defaultEntry, which has no values", values)


STEP = Step(
    "0.7.0",
    "0.7.1",
    change,
    frozenset({*RENAMED_CONSTRAINTS, *REMOVED_CONSTRAINTS, "SectionMapping", "SectionMappingConstraint"}),
)
