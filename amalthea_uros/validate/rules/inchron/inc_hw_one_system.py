"""Several systems."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwStructure
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: HwStructure, context: Context) -> Iterator[str]:
    last = context.once(_systems)[-1:]
    if element.structure_type == "System" and element not in last:
        yield f"the last system, {last[0].name!r}, names the project, not {element.name!r}"


def _systems(context: Context) -> list[HwStructure]:
    return [structure for structure in context.all(HwStructure) if structure.structure_type == "System"]


RULE = ModelRule(
    id="INC-HW-ONE-SYSTEM",
    title="system that does not name the project",
    severity=Severity.INFO,
    target=HwStructure,
    check=_check,
    rationale="Of several structures of the type System the last one names the project.",
    remedy="Give only one structure the type System.",
    fails="""
<hwModel>
  <structures name="A" structureType="System"/>
  <structures name="B" structureType="System"/>
</hwModel>
""",
    passes="""
<hwModel>
  <structures name="A" structureType="System"/>
  <structures name="B" structureType="ECU"/>
</hwModel>
""",
)
