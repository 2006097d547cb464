"""Channel filled beyond its capacity."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Channel, ChannelSend
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Channel, context: Context) -> Iterator[str]:
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


RULE = ModelRule(
    id="DOC-Channel-Fill",
    title="channel filled beyond its capacity",
    severity=Severity.ERROR,
    target=Channel,
    check=_check,
    rationale="Elements beyond the maximum are lost. The APP4MC documentation requires the number of elements to stay within "
    "the maximum.",
    remedy="Increase the maximum number of elements, or reduce the number of initial or sent elements.",
    fails="""
<swModel>
  <channels name="C" defaultElements="3" maxElements="2"/>
</swModel>
""",
    edits={'defaultElements="3"': 'defaultElements="2"'},
)
