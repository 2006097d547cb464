"""Cyclic event chain."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import EventChain, EventChainReference
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import TASK_EVENTS
from amalthea_uros.validate.rule import ModelRule


def _check(element: EventChain, context: Context) -> Iterator[str]:
    if element in context.once(_endless):
        yield f"the event chain {element.name or ''!r} is part of a reference cycle or leads into one"


def _endless(context: Context) -> set[EventChain]:
    """The chains that remain after repeatedly removing those without references to a remaining chain."""
    holders: dict[EventChain, list[EventChain]] = {}
    left: dict[EventChain, int] = dict.fromkeys(context.all(EventChain), 0)
    for reference in context.all(EventChainReference):
        holder = reference.enclosing(EventChain)
        if holder is not None and reference.event_chain in left:
            holders.setdefault(reference.event_chain, []).append(holder)
            left[holder] += 1
    pending = [chain for chain, count in left.items() if not count]
    while pending:
        chain = pending.pop()
        del left[chain]
        for holder in holders.get(chain, []):
            left[holder] -= 1
            if not left[holder]:
                pending.append(holder)
    return set(left)


RULE = ModelRule(
    id="INC-EC-CYCLE",
    title="cyclic event chain",
    severity=Severity.ERROR,
    target=EventChain,
    check=_check,
    rationale="am2inc follows the references without end and crashes with a segmentation fault.",
    remedy="Remove the reference that closes the cycle.",
    fails=f"""
{TASK_EVENTS}
<swModel>
  <tasks name="T"/>
</swModel>
<constraintsModel>
  <eventChains name="C" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent">
    <items xsi:type="am:EventChainReference" eventChain="C?type=EventChain"/>
  </eventChains>
</constraintsModel>
""",
    edits={
        """<eventChains name="C" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent">
    <items xsi:type="am:EventChainReference" eventChain="C?type=EventChain"/>
  </eventChains>""": '<eventChains name="C" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>',
    },
)
