"""Least number of received elements that is out of range."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ChannelReceive
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: ChannelReceive, context: Context) -> Iterator[str]:
    least, most = element.lower_bound, element.elements
    if least is not None and least < 0:
        yield f"the lower bound is {least}, which is below 0"
    if least is not None and most is not None and least > most:
        yield f"the lower bound is {least}, of at most {most} elements"


RULE = ModelRule(
    id="DOC-Channel-LowerBound",
    title="least number of received elements that is out of range",
    severity=Severity.ERROR,
    target=ChannelReceive,
    check=_check,
    rationale="Nothing can be received that fulfils it. The documentation of APP4MC asks for 0 to the number of elements.",
    remedy="State a lower bound from 0 to the number of elements.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:ChannelReceive" data="C?type=Channel" elements="2" lowerBound="3"/>
    </activityGraph>
  </runnables>
  <channels name="C"/>
</swModel>
""",
    passes="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:ChannelReceive" data="C?type=Channel" elements="2" lowerBound="2"/>
    </activityGraph>
  </runnables>
  <channels name="C"/>
</swModel>
""",
)
