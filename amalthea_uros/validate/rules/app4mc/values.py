"""Values that must be positive or not negative, and units."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractMemoryElement, ClockFunction, Counter, Frequency, FrequencyDomain, Quantity
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import runnable_with
from amalthea_uros.validate.rule import ModelRule


def _check_counter(element: Counter, context: Context) -> Iterator[str]:
    if (element.offset or 0) < 0:
        yield f"the counter offset is {element.offset}, but must be 0 or more"


def _check_size(element: AbstractMemoryElement, context: Context) -> Iterator[str]:
    if element.size is not None and (element.size.value or 0) <= 0:
        yield f"the size of {element.name!r} is {element.size.value or 0}, but must be greater than 0"


def _check_frequency(element: Frequency, context: Context) -> Iterator[str]:
    holder = element.container
    decides = isinstance(holder, FrequencyDomain) or (isinstance(holder, ClockFunction) and holder.y_offset is element)
    if decides and (element.value or 0) <= 0:
        yield f"the frequency of {name_of(holder)!r} is {element.value or 0}, but must be greater than 0"


def _check_unit(element: Quantity, context: Context) -> Iterator[str]:
    if getattr(element, "unit", None) in (None, "_undefined_"):
        yield f"the {type(element).__name__} has no unit"


RULES = (
    ModelRule(
        id="AM-Basic-Counter",
        title="negative counter offset",
        severity=Severity.ERROR,
        target=Counter,
        check=_check_counter,
        rationale="A counter cannot take effect before the first occurrence. APP4MC's validation also reports it.",
        remedy="Set the offset to 0 or more.",
        fails=runnable_with("""
<items xsi:type="am:RunnableCall">
  <counter prescaler="2" offset="-1"/>
</items>
"""),
        edits={'offset="-1"': 'offset="1"'},
    ),
    ModelRule(
        id="AM-Basic-Data-Size",
        title="size of zero or less",
        severity=Severity.ERROR,
        target=AbstractMemoryElement,
        check=_check_size,
        rationale="An object in memory occupies at least one bit. APP4MC's validation also reports it.",
        remedy="Set a size greater than 0, or remove the size.",
        fails="""
<swModel>
  <labels name="L">
    <size value="0" unit="B"/>
  </labels>
</swModel>
""",
        edits={'value="0"': 'value="4"'},
    ),
    ModelRule(
        id="AM-Basic-Frequency",
        title="frequency of zero or less",
        severity=Severity.ERROR,
        target=Frequency,
        check=_check_frequency,
        rationale="A clock needs a positive frequency to tick. APP4MC's validation also reports it.",
        remedy="Set a frequency greater than 0.",
        fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="c">
    <defaultValue value="0.0" unit="MHz"/>
  </domains>
</hwModel>
""",
        edits={'value="0.0"': 'value="1.0"'},
    ),
    ModelRule(
        id="AM-Basic-Quantity",
        title="quantity without a unit",
        severity=Severity.ERROR,
        target=Quantity,
        check=_check_unit,
        rationale="A value without a unit is meaningless, even if it is 0. APP4MC's validation also reports it.",
        remedy="Add the unit.",
        fails="""
<swModel>
  <labels name="L">
    <size value="4"/>
  </labels>
</swModel>
""",
        edits={'value="4"': 'value="4" unit="B"'},
    ),
)
