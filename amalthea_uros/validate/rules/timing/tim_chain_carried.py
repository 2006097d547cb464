"""Segment of a chain in which nothing carries the effect."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise, product

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractEventChain, Event, EventChainItemType
from amalthea_uros.validate.chains import events, parts
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.timing._effects import Effects


def _check(element: AbstractEventChain, context: Context) -> Iterator[str]:
    effects = context.once(Effects)
    for step in _steps(element):
        for first, then in product(*map(events, step)):
            if first is not then and not effects.is_carried(first, then):
                yield f"nothing carries the effect from {first.name!r} to {then.name!r}"


def _steps(chain: AbstractEventChain) -> Iterator[tuple[Event | None, Event | None]]:
    """From where to where a chain leads by itself, besides what its parts do."""
    if not chain.items:
        yield chain.stimulus, chain.response
    elif chain.item_type is EventChainItemType.PARALLEL:
        yield from ((chain.stimulus, part.stimulus) for part in parts(chain))
        yield from ((part.response, chain.response) for part in parts(chain))
    else:
        yield from ((part.response, following.stimulus) for part, following in pairwise(parts(chain)))


RULE = ModelRule(
    id="TIM-CHAIN-CARRIED",
    title="segment of a chain in which nothing carries the effect",
    severity=Severity.WARNING,
    target=AbstractEventChain,
    check=_check,
    rationale="No data, no activation and no order within a job takes it from the one event to the other, so that the latency is "
    "that of two things that have nothing to do with each other: it is computed as if there were a variable between "
    "them.",
    remedy="Model the label, trigger or call that carries it, or let the segment lead to another event.",
    fails="""
<eventModel>
  <events xsi:type="am:ProcessEvent" name="start of T" eventType="start" entity="T?type=Task"/>
  <events xsi:type="am:ProcessEvent" name="end of U" eventType="terminate" entity="U?type=Task"/>
</eventModel>
<swModel>
  <tasks name="T">
    <activityGraph>
      <items xsi:type="am:LabelAccess" data="L?type=Label" access="write"/>
    </activityGraph>
  </tasks>
  <tasks name="U">
    <activityGraph>
      <items xsi:type="am:LabelAccess" data="M?type=Label" access="read"/>
    </activityGraph>
  </tasks>
  <labels name="L"/>
  <labels name="M"/>
</swModel>
<constraintsModel>
  <eventChains name="C" stimulus="start+of+T?type=ProcessEvent" response="end+of+U?type=ProcessEvent"/>
</constraintsModel>
""",
    passes="""
<eventModel>
  <events xsi:type="am:ProcessEvent" name="start of T" eventType="start" entity="T?type=Task"/>
  <events xsi:type="am:ProcessEvent" name="end of U" eventType="terminate" entity="U?type=Task"/>
</eventModel>
<swModel>
  <tasks name="T">
    <activityGraph>
      <items xsi:type="am:LabelAccess" data="L?type=Label" access="write"/>
    </activityGraph>
  </tasks>
  <tasks name="U">
    <activityGraph>
      <items xsi:type="am:LabelAccess" data="L?type=Label" access="read"/>
    </activityGraph>
  </tasks>
  <labels name="L"/>
  <labels name="M"/>
</swModel>
<constraintsModel>
  <eventChains name="C" stimulus="start+of+T?type=ProcessEvent" response="end+of+U?type=ProcessEvent"/>
</constraintsModel>
""",
)
