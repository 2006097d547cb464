"""Section in a memory that is not for it."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import PhysicalSectionConstraint, PhysicalSectionMapping, Section
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: PhysicalSectionMapping, context: Context) -> Iterator[str]:
    memory = element.memory
    if memory is None:
        return
    for section in element.origin:
        for constraint in context.once(_constraints).get(section, []):
            if memory not in constraint.memories:
                yield f"{section.qualified_name!r} lies in {memory.qualified_name!r}, which {constraint.name!r} does not allow"


def _constraints(context: Context) -> dict[Section, list[PhysicalSectionConstraint]]:
    found: dict[Section, list[PhysicalSectionConstraint]] = {}
    for constraint in context.all(PhysicalSectionConstraint):
        if constraint.section is not None and constraint.memories:
            found.setdefault(constraint.section, []).append(constraint)
    return found


RULE = ModelRule(
    id="DOC-PhysicalSection",
    title="section in a memory that is not for it",
    severity=Severity.ERROR,
    target=PhysicalSectionMapping,
    check=_check,
    rationale="A constraint says in which memories the section may lie. The documentation of APP4MC asks for mappings that keep to it.",
    remedy="Map the section to a memory of the constraint, or add the memory there.",
    fails="""
<swModel>
  <sections name="s"/>
</swModel>
<hwModel>
  <structures name="ECU">
    <modules xsi:type="am:Memory" name="a"/>
    <modules xsi:type="am:Memory" name="b"/>
  </structures>
</hwModel>
<constraintsModel>
  <physicalSectionConstraints name="C" section="s?type=Section" memories="a?type=Memory"/>
</constraintsModel>
<mappingModel>
  <physicalSectionMapping name="P" origin="s?type=Section" memory="b?type=Memory"/>
</mappingModel>
""",
    passes="""
<swModel>
  <sections name="s"/>
</swModel>
<hwModel>
  <structures name="ECU">
    <modules xsi:type="am:Memory" name="a"/>
    <modules xsi:type="am:Memory" name="b"/>
  </structures>
</hwModel>
<constraintsModel>
  <physicalSectionConstraints name="C" section="s?type=Section" memories="a?type=Memory"/>
</constraintsModel>
<mappingModel>
  <physicalSectionMapping name="P" origin="s?type=Section" memory="a?type=Memory"/>
</mappingModel>
""",
)
