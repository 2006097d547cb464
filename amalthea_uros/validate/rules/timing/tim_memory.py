"""Insufficient memory size."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    AbstractMemoryElement,
    Label,
    Memory,
    MemoryMapping,
    PhysicalSectionMapping,
    Runnable,
    Section,
)
from amalthea_uros.metamodel.magnitudes import bits
from amalthea_uros.units import data_size_text
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Memory, context: Context) -> Iterator[str]:
    size = bits(element.definition.size) if element.definition is not None else None
    mapped = context.once(_mapped).get(element, {})
    needed = sum(bits(part.size) or 0 for part in mapped)
    if size is not None and needed > size:
        yield f"{element.name!r} has a size of {data_size_text(size)}, but the objects mapped to it need {data_size_text(needed)}"


def _mapped(context: Context) -> dict[Memory, dict[AbstractMemoryElement, None]]:
    """The objects mapped to each memory, each of them once, even if it is mapped in several ways."""
    sections: dict[Section, list[AbstractMemoryElement]] = {}
    candidates: tuple[Label | Runnable, ...] = (*context.all(Label), *context.all(Runnable))
    for part in candidates:
        if part.section is not None:
            sections.setdefault(part.section, []).append(part)
    found: dict[Memory, dict[AbstractMemoryElement, None]] = {}
    for mapping in context.all(MemoryMapping):
        if mapping.memory is not None and mapping.abstract_element is not None:
            found.setdefault(mapping.memory, {})[mapping.abstract_element] = None
    for placed in context.all(PhysicalSectionMapping):
        if placed.memory is not None:
            parts = [part for section in placed.origin for part in sections.get(section, ())]
            found.setdefault(placed.memory, {}).update(dict.fromkeys((*parts, *placed.labels, *placed.run_entities)))
    return found


RULE = ModelRule(
    id="TIM-MEMORY",
    title="insufficient memory size",
    severity=Severity.WARNING,
    target=Memory,
    check=_check,
    rationale="Some of the objects must be moved. Their access times change, so times computed with this mapping are wrong.",
    remedy="Map some of the objects to another memory, or correct the sizes.",
    fails="""
<swModel>
  <labels name="L">
    <size value="1024" unit="B"/>
  </labels>
  <labels name="M" section="S?type=Section">
    <size value="8" unit="bit"/>
  </labels>
  <sections name="S"/>
</swModel>
<hwModel>
  <definitions xsi:type="am:MemoryDefinition" name="D">
    <size value="1" unit="KiB"/>
  </definitions>
  <structures name="ECU">
    <modules xsi:type="am:Memory" name="RAM" definition="D?type=MemoryDefinition"/>
  </structures>
</hwModel>
<mappingModel>
  <memoryMapping abstractElement="L?type=Label" memory="RAM?type=Memory"/>
  <physicalSectionMapping name="P" origin="S?type=Section" memory="RAM?type=Memory"/>
</mappingModel>
""",
    edits={'value="1024"': 'value="1023"'},
)
