"""Hardware module without a definition."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Cache, ConnectionHandler, HwModule, Memory, ProcessingUnit
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: HwModule, context: Context) -> Iterator[str]:
    if isinstance(element, Memory | ProcessingUnit | ConnectionHandler | Cache) and element.definition is None:
        yield f"{element.name!r} has no definition"


RULE = ModelRule(
    id="AM-HW-Module-Definition",
    title="hardware module without a definition",
    severity=Severity.WARNING,
    target=HwModule,
    check=_check,
    rationale="Without a definition, the properties of the module are unknown. APP4MC's validation also reports it.",
    remedy="Add a reference to a definition.",
    fails="""
<hwModel>
  <structures name="ECU">
    <modules xsi:type="am:Memory" name="RAM"/>
  </structures>
</hwModel>
""",
    edits={
        '<structures name="ECU">': """<definitions xsi:type="am:MemoryDefinition" name="D"/>
  <structures name="ECU">""",
        'name="RAM"': 'name="RAM" definition="D?type=MemoryDefinition"',
    },
)
