"""Lower bound of received elements out of range."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ChannelReceive
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: ChannelReceive, context: Context) -> Iterator[str]:
    least, most = element.lower_bound, element.elements
    if least is not None and least < 0:
        yield f"the lower bound {least} is negative"
    if least is not None and most is not None and least > most:
        yield f"the lower bound {least} is above the number of elements {most}"


RULE = ModelRule(
    id="DOC-Channel-LowerBound",
    title="lower bound of received elements out of range",
    severity=Severity.ERROR,
    target=ChannelReceive,
    check=_check,
    rationale="A negative bound is meaningless, and a bound above the number of elements can never be met. The APP4MC "
    "documentation requires a value from 0 to the number of elements.",
    remedy="Set a lower bound from 0 to the number of elements.",
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
    edits={'lowerBound="3"': 'lowerBound="2"'},
)
