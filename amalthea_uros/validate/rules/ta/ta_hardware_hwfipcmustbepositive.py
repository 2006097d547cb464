"""Instructions per cycle (IPC) of zero or less."""

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
        yield f"the IPC {element.name!r} is {value}, but must be greater than 0"


RULE = ModelRule(
    id="TA-Hardware-HWFIPCMustBePositive",
    title="instructions per cycle (IPC) of zero or less",
    severity=Severity.ERROR,
    target=HwFeature,
    check=_check,
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
)
