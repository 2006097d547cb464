"""Unsupported memory mapping."""

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
        yield "the memory mapping has no element"
    elif element.memory is None:
        yield Downgraded(f"the memory mapping of {name_of(mapped)!r} has no memory")
    elif not isinstance(mapped, Label):
        yield Downgraded(f"the memory mapping of the {type(mapped).__name__} {name_of(mapped)!r} is dropped by am2inc")


RULE = ModelRule(
    id="INC-MAP-MEMORY",
    title="unsupported memory mapping",
    severity=Severity.ERROR,
    target=MemoryMapping,
    check=_check,
    rationale="am2inc crashes with a segmentation fault if the mapped element is missing. It silently drops mappings of "
    "anything but labels.",
    remedy="Map only labels, and set both the label and the memory.",
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
    edits={
        "<mappingModel>": """<swModel>
  <labels name="L"/>
</swModel>
<mappingModel>""",
        'memory="RAM?type=Memory"': 'abstractElement="L?type=Label" memory="RAM?type=Memory"',
    },
)
