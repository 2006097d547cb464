"""Processor type of which the instructions per cycle are not certain."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ProcessingUnitDefinition, PuType
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.ta._instructions import is_per_cycle


def _check(element: ProcessingUnitDefinition, context: Context) -> Iterator[str]:
    count = sum(is_per_cycle(feature) for feature in element.features)
    if element.pu_type is PuType.CPU and count == 0:
        yield f"{element.name!r} has no instructions per cycle, 1.0 is taken"
    elif element.pu_type is PuType.CPU and count > 1:
        yield f"{element.name!r} has {count} values of instructions per cycle, the first one is taken"


RULE = ModelRule(
    id="TA-Hardware-PUDIPCMissing",
    title="instructions per cycle that are not certain",
    severity=Severity.INFO,
    target=ProcessingUnitDefinition,
    check=_check,
    rationale="Execution needs in instructions become times by them. APP4MC reports it when it validates the model.",
    remedy="Refer to one feature whose name starts with IPC_, of the category Instructions.",
    fails="""
<hwModel>
  <definitions xsi:type="am:ProcessingUnitDefinition" name="D" puType="CPU"/>
  <featureCategories name="Instructions">
    <features name="IPC_1" value="1.5"/>
  </featureCategories>
</hwModel>
""",
    passes="""
<hwModel>
  <definitions xsi:type="am:ProcessingUnitDefinition" name="D" puType="CPU" features="Instructions/IPC_1?type=HwFeature"/>
  <featureCategories name="Instructions">
    <features name="IPC_1" value="1.5"/>
  </featureCategories>
</hwModel>
""",
)
