"""Access that carries timing."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwAccessElement, HwConnection, HwDefinition
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

#: The features by which connections, and the types of modules, say what an access costs.
_COSTS = frozenset({"access_latency", "read_latency", "write_latency", "data_rate"})


def _check(element: HwAccessElement | HwConnection | HwDefinition, context: Context) -> Iterator[str]:
    if isinstance(element, HwAccessElement):
        yield f"what accesses to {element.destination.name if element.destination else 'a memory'!r} cost is ignored"
    elif any(element.__dict__.get(name) is not None for name in _COSTS & element.__dict__.keys()):
        yield f"what accesses by way of {element.name!r} cost is ignored"


RULE = ModelRule(
    id="INC-HW-ACCESS",
    title="access that carries timing",
    severity=Severity.WARNING,
    target=(HwAccessElement, HwConnection, HwDefinition),
    check=_check,
    rationale="am2inc ignores access elements, paths, latencies and data rates without a word.",
    remedy="Do not rely on the timing of memory accesses after the import.",
    fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core">
      <accessElements name="a"/>
    </modules>
  </structures>
</hwModel>
""",
    passes="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core"/>
  </structures>
</hwModel>
""",
)
