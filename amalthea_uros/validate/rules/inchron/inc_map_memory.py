"""Memory mapping of something else than a label."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Label, MemoryMapping
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, ModelRule


def _check(element: MemoryMapping, context: Context) -> Iterator[str | Downgraded]:
    mapped = element.abstract_element
    if mapped is None:
        yield "the memory mapping lacks its label"
    elif element.memory is None:
        yield Downgraded(f"the mapping of {name_of(mapped)!r} names no memory")
    elif not isinstance(mapped, Label):
        yield Downgraded(f"the mapping of the {type(mapped).__name__} {name_of(mapped)!r} is dropped")


RULE = ModelRule(
    id="INC-MAP-MEMORY",
    title="memory mapping of something else than a label",
    severity=Severity.ERROR,
    target=MemoryMapping,
    check=_check,
    rationale="Without an element am2inc ends with a segmentation fault; what is no label is dropped without a word.",
    remedy="Map labels to memories only, and name both.",
    fails="""
<hwModel>
  <structures name="ECU">
    <modules xsi:type="am:Memory" name="RAM"/>
  </structures>
</hwModel>
<mappingModel>
  <memoryMapping memory="RAM?type=Memory"/>
</mappingModel>
""",
    passes="""
<hwModel>
  <structures name="ECU">
    <modules xsi:type="am:Memory" name="RAM"/>
  </structures>
</hwModel>
<swModel>
  <labels name="L"/>
</swModel>
<mappingModel>
  <memoryMapping abstractElement="L?type=Label" memory="RAM?type=Memory"/>
</mappingModel>
""",
)
