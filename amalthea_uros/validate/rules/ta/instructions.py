"""The instructions per cycle (IPC) of processing units."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwFeature, ProcessingUnitDefinition, PuType
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def is_per_cycle(feature: HwFeature) -> bool:
    """Whether a feature defines the IPC, judged by its name and the name of its category."""
    return name_of(feature.container).lower() == "instructions" and name_of(feature).startswith("IPC_")


def _check_positive(element: HwFeature, context: Context) -> Iterator[str]:
    value: float = element.effective("value")
    if is_per_cycle(element) and isfinite(value) and value <= 0:
        yield f"the IPC {element.name!r} is {value}, but must be greater than 0"


def _check_missing(element: ProcessingUnitDefinition, context: Context) -> Iterator[str]:
    count = sum(is_per_cycle(feature) for feature in element.features)
    if element.pu_type is PuType.CPU and count == 0:
        yield f"IPC of {element.name!r} is not defined; assuming 1.0"
    elif element.pu_type is PuType.CPU and count > 1:
        yield f"IPC of {element.name!r} is defined {count} times; using the first value"


RULES = (
    ModelRule(
        id="TA-Hardware-HWFIPCMustBePositive",
        title="instructions per cycle (IPC) of zero or less",
        severity=Severity.ERROR,
        target=HwFeature,
        check=_check_positive,
        rationale="With an IPC of 0 no job would ever finish. APP4MC's validation also reports it.",
        remedy="Set the number of instructions per cycle to a value greater than 0.",
        fails="""
<hwModel>
  <featureCategories name="Instructions">
    <features name="IPC_1" value="0.0"/>
  </featureCategories>
</hwModel>
""",
        edits={'value="0.0"': 'value="1.5"'},
    ),
    ModelRule(
        id="TA-Hardware-PUDIPCMissing",
        title="missing or ambiguous instructions per cycle (IPC)",
        severity=Severity.INFO,
        target=ProcessingUnitDefinition,
        check=_check_missing,
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
    ),
)
