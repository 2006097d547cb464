"""Several structures of type System."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwStructure
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: HwStructure, context: Context) -> Iterator[str]:
    last = context.once(_systems)[-1:]
    if element.structure_type == "System" and element not in last:
        yield f"the imported project is named after {last[0].name!r}, not after {element.name or ''!r}"


def _systems(context: Context) -> list[HwStructure]:
    return [structure for structure in context.all(HwStructure) if structure.structure_type == "System"]


RULE = ModelRule(
    id="INC-HW-ONE-SYSTEM",
    title="several structures of type System",
    severity=Severity.INFO,
    target=HwStructure,
    check=_check,
    rationale="am2inc names the project after the last structure of type System.",
    remedy="Set the type System for one structure only.",
    fails="""
<hwModel>
  <structures name="A" structureType="System"/>
  <structures name="B" structureType="System"/>
</hwModel>
""",
    edits={'name="B" structureType="System"': 'name="B" structureType="ECU"'},
)
