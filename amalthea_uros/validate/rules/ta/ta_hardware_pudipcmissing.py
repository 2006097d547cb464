"""Missing or ambiguous instructions per cycle (IPC)."""

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
        yield f"IPC of {element.name!r} is not defined; assuming 1.0"
    elif element.pu_type is PuType.CPU and count > 1:
        yield f"IPC of {element.name!r} is defined {count} times; using the first value"


RULE = ModelRule(
    id="TA-Hardware-PUDIPCMissing",
    title="missing or ambiguous instructions per cycle (IPC)",
    severity=Severity.INFO,
    target=ProcessingUnitDefinition,
    check=_check,
    rationale="The IPC converts execution needs in instructions into times. APP4MC's validation also reports it.",
    remedy="Refer to exactly one feature of the category Instructions whose name starts with IPC_.",
    fails="""
<hwModel>
  <definitions xsi:type="am:ProcessingUnitDefinition" name="D" puType="CPU"/>
  <featureCategories name="Instructions">
    <features name="IPC_1" value="1.5"/>
  </featureCategories>
</hwModel>
""",
    edits={'puType="CPU"': 'puType="CPU" features="Instructions/IPC_1?type=HwFeature"'},
)
