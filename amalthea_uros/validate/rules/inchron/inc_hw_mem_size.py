"""Memory without a size."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Cache, Memory
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._importer import has_unit


def _check(element: Memory | Cache, context: Context) -> Iterator[str]:
    size = element.definition.size if element.definition is not None else None
    if size is None or not has_unit(size):
        yield f"the memory {element.name or ''!r} has no definition with a size and a unit"


RULE = ModelRule(
    id="INC-HW-MEM-SIZE",
    title="memory without a size",
    severity=Severity.WARNING,
    target=(Memory, Cache),
    check=_check,
    rationale="am2inc silently uses 1 KiB.",
    remedy="Assign a definition with a size and a unit, e.g. 512 KiB.",
    fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:Memory" name="RAM"/>
  </structures>
</hwModel>
""",
    edits={
        '<domains xsi:type="am:FrequencyDomain" name="clock"': '<definitions xsi:type="am:MemoryDefinition" name="type"',
        '<defaultValue value="300" unit="MHz"': '<size value="1" unit="MB"',
        "</domains": "</definitions",
        'name="RAM"': 'name="RAM" definition="type?type=MemoryDefinition"',
    },
)
