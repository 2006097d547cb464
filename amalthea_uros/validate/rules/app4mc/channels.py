"""Numbers of elements of channels."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Channel, ChannelReceive, ChannelSend
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check_fill(element: Channel, context: Context) -> Iterator[str]:
    most = element.max_elements
    if most is None:
        return
    if (element.default_elements or 0) > most:
        yield f"{element.name!r} starts with {counted(element.default_elements or 0, 'element')}, but can hold at most {most}"
    sent = context.once(_sent).get(element, 0)
    if sent > most:
        yield f"{element.name!r} receives {counted(sent, 'element')} at once, but can hold at most {most}"


def _sent(context: Context) -> dict[Channel, int]:
    """The largest number of elements that is sent to each channel at once."""
    found: dict[Channel, int] = {}
    for access in context.all(ChannelSend):
        if access.data is not None:
            found[access.data] = max(found.get(access.data, 0), access.elements or 0)
    return found


def _check_lower_bound(element: ChannelReceive, context: Context) -> Iterator[str]:
    least, most = element.lower_bound, element.elements
    if least is not None and least < 0:
        yield f"the lower bound {least} is negative"
    if least is not None and most is not None and least > most:
        yield f"the lower bound {least} is above the number of elements {most}"


RULES = (
    ModelRule(
        id="DOC-Channel-Fill",
        title="channel filled beyond its capacity",
        severity=Severity.ERROR,
        target=Channel,
        check=_check_fill,
        rationale="Elements beyond the maximum are lost. The APP4MC documentation requires the number of elements to stay within "
        "the maximum.",
        remedy="Increase the maximum number of elements, or reduce the number of initial or sent elements.",
        fails="""
<swModel>
  <channels name="C" defaultElements="3" maxElements="2"/>
</swModel>
""",
        edits={'defaultElements="3"': 'defaultElements="2"'},
    ),
    ModelRule(
        id="DOC-Channel-LowerBound",
        title="lower bound of received elements out of range",
        severity=Severity.ERROR,
        target=ChannelReceive,
        check=_check_lower_bound,
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
    ),
)
