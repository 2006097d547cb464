"""Sections in 0.7.1: their members name them, and no longer the other way round."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node, remove_all
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.properties import free_key
from amalthea_uros.xmi.migrate.steps.v0_7_tools import content_of, names_of, remove_and_keep

#: Reference of a section -> element of the members.
_MEMBERS = {"labels": "labels", "runEntities": "runnables"}


def change_sections(models: ModelSet, notes: Notes) -> None:
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


def _place(member: Node, tag: str, section: Node, notes: Notes) -> None:
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


def _change_mappings(models: ModelSet, notes: Notes) -> None:
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


def _remove_constraints(models: ModelSet, notes: Notes) -> None:
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


def name_mappings(models: ModelSet, notes: Notes) -> None:
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
