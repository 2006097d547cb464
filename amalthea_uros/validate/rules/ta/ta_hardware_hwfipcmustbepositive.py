"""Processing unit type that never gets on."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwFeature
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.ta._instructions import is_per_cycle


def _check(element: HwFeature, context: Context) -> Iterator[str]:
    value: float = element.effective("value")
    if is_per_cycle(element) and isfinite(value) and value <= 0:
        yield f"{element.name!r} is {value}"


RULE = ModelRule(
    id="TA-Hardware-HWFIPCMustBePositive",
    title="instructions per cycle that are not above zero",
    severity=Severity.ERROR,
    target=HwFeature,
    check=_check,
    rationale="A core that executes no instruction in a cycle never ends anything. APP4MC reports it when it validates the model.",
    remedy="State how many instructions a cycle executes.",
    fails="""
<hwModel>
  <featureCategories name="Instructions">
    <features name="IPC_1" value="0.0"/>
  </featureCategories>
</hwModel>
""",
    passes="""
<hwModel>
  <featureCategories name="Instructions">
    <features name="IPC_1" value="1.5"/>
  </featureCategories>
</hwModel>
""",
)
