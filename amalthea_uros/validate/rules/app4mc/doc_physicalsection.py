"""Section in a disallowed memory."""

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
                where = f"mapped to {memory.qualified_name!r}, which {constraint.name!r} does not allow"
                yield f"section {section.qualified_name!r} is {where}"


def _constraints(context: Context) -> dict[Section, list[PhysicalSectionConstraint]]:
    found: dict[Section, list[PhysicalSectionConstraint]] = {}
    for constraint in context.all(PhysicalSectionConstraint):
        if constraint.section is not None and constraint.memories:
            found.setdefault(constraint.section, []).append(constraint)
    return found


RULE = ModelRule(
    id="DOC-PhysicalSection",
    title="section in a disallowed memory",
    severity=Severity.ERROR,
    target=PhysicalSectionMapping,
    check=_check,
    rationale="A constraint limits the memories of the section. The APP4MC documentation requires mappings to respect it.",
    remedy="Map the section to a memory that the constraint allows, or add the memory to the constraint.",
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
    edits={'memory="b?type=Memory"': 'memory="a?type=Memory"'},
)
