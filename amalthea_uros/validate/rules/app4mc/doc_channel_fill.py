"""Channel that is to hold more than it can."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Channel, ChannelSend
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Channel, context: Context) -> Iterator[str]:
    most = element.max_elements
    if most is None:
        return
    if (element.default_elements or 0) > most:
        yield f"{element.name!r} holds {element.default_elements} elements at the start, of at most {most}"
    sent = context.once(_sent).get(element, 0)
    if sent > most:
        yield f"{sent} elements at once are sent to {element.name!r}, which holds at most {most}"


def _sent(context: Context) -> dict[Channel, int]:
    """The most elements that are sent to each channel at once."""
    found: dict[Channel, int] = {}
    for access in context.all(ChannelSend):
        if access.data is not None:
            found[access.data] = max(found.get(access.data, 0), access.elements or 0)
    return found


RULE = ModelRule(
    id="DOC-Channel-Fill",
    title="channel that is to hold more than it can",
    severity=Severity.ERROR,
    target=Channel,
    check=_check,
    rationale="What does not fit in is lost. The documentation of APP4MC asks for no more elements than the greatest number.",
    remedy="Raise the greatest number of elements, or put fewer of them in.",
    fails="""
<swModel>
  <channels name="C" defaultElements="3" maxElements="2"/>
</swModel>
""",
    passes="""
<swModel>
  <channels name="C" defaultElements="2" maxElements="2"/>
</swModel>
""",
)
