"""Memory access timing."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwAccessElement, HwConnection, HwDefinition
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

#: The features of connections and module definitions that specify the cost of an access.
_COSTS = frozenset({"access_latency", "read_latency", "write_latency", "data_rate"})


def _check(element: HwAccessElement | HwConnection | HwDefinition, context: Context) -> Iterator[str]:
    if isinstance(element, HwAccessElement):
        yield f"the cost of accesses to {element.destination.name if element.destination else ''!r} is ignored by am2inc"
    elif any(element.__dict__.get(name) is not None for name in _COSTS & element.__dict__.keys()):
        yield f"the access cost of {element.name or ''!r} is ignored by am2inc"


RULE = ModelRule(
    id="INC-HW-ACCESS",
    title="memory access timing",
    severity=Severity.WARNING,
    target=(HwAccessElement, HwConnection, HwDefinition),
    check=_check,
    rationale="am2inc silently ignores access elements, access paths, latencies and data rates, so the time of memory "
    "accesses is lost.",
    remedy="Include the access times in the Ticks of the runnables, or do not rely on them after the import.",
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
    edits={
        """<modules xsi:type="am:ProcessingUnit" name="core">
      <accessElements name="a"/>
    </modules>""": '<modules xsi:type="am:ProcessingUnit" name="core"/>',
    },
)
