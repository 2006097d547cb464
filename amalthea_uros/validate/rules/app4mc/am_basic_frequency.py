"""Frequency of zero or less."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ClockFunction, Frequency, FrequencyDomain
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Frequency, context: Context) -> Iterator[str]:
    holder = element.container
    decides = isinstance(holder, FrequencyDomain) or (isinstance(holder, ClockFunction) and holder.y_offset is element)
    if decides and (element.value or 0) <= 0:
        yield f"the frequency of {name_of(holder)!r} is {element.value or 0}, but must be greater than 0"


RULE = ModelRule(
    id="AM-Basic-Frequency",
    title="frequency of zero or less",
    severity=Severity.ERROR,
    target=Frequency,
    check=_check,
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
)
