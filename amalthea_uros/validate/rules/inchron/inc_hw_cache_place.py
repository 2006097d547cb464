"""Cache without a processing unit."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Cache, HwStructure, ProcessingUnit
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Cache, context: Context) -> Iterator[str]:
    holder = element.container
    modules = holder.modules if isinstance(holder, HwStructure) else []
    if not isinstance(holder, ProcessingUnit) and not any(isinstance(module, ProcessingUnit) for module in modules):
        yield f"the cache {element.name or ''!r} is neither inside a processing unit nor in the same structure as one"


RULE = ModelRule(
    id="INC-HW-CACHE-PLACE",
    title="cache without a processing unit",
    severity=Severity.ERROR,
    target=Cache,
    check=_check,
    rationale="am2inc crashes with a segmentation fault.",
    remedy="Move the cache into a processing unit or into the structure of one.",
    fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:Cache" name="L2"/>
  </structures>
</hwModel>
""",
    edits={
        'xsi:type="am:Cache" name="L2"/>': """xsi:type="am:ProcessingUnit" name="core"/>
    <modules xsi:type="am:Cache" name="L2"/>""",
    },
)
