"""0.7.0 -> 0.7.1: sections, sizes, frequencies, switches and timing constraints."""

from __future__ import annotations

from collections.abc import Iterable
from decimal import Decimal
from math import isfinite

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.step import Step
from amalthea_uros.xmi.migrate.steps.file_roots import wrap_roots
from amalthea_uros.xmi.migrate.steps.v0_7_1_constraints import REMOVED_CONSTRAINTS, RENAMED_CONSTRAINTS, change_constraints
from amalthea_uros.xmi.migrate.steps.v0_7_1_sections import change_sections
from amalthea_uros.xmi.migrate.steps.v0_7_tools import names_of

_SWITCHES = frozenset({"ModeSwitch", "ProbabiltitySwitch"})

_TRUE = frozenset({"true", "1"})


def change(models: ModelSet, notes: Notes) -> None:
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


def _state_units(sizes: Iterable[Node], notes: Notes) -> None:
    for size in sizes:
        bits = size.attributes.pop("numberBits", None)
        # Those of sections are not there any more.
        if bits is not None and size.parent is not None:
            size.attributes |= {"value": bits, "unit": "bit"}
            notes.converted(size, "number of bits -> value with unit", f"{bits} bit", "numberBits")


def _make_element(holders: Iterable[Node], name: str, notes: Notes) -> None:
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


def _change_switches(models: ModelSet, notes: Notes) -> None:
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


def _find_default(switch: Node, entries: Iterable[Node], notes: Notes) -> None:
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
