"""Chain that is part of itself."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import EventChain, EventChainReference
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: EventChain, context: Context) -> Iterator[str]:
    if _contains(element, (element,)):
        yield f"the chain {element.name!r} is part of itself"


def _contains(chain: EventChain, above: tuple[EventChain, ...]) -> bool:
    inner = [part.event_chain for part in chain.walk() if isinstance(part, EventChainReference)]
    return any(each in above or _contains(each, (*above, each)) for each in inner if each is not None)


RULE = ModelRule(
    id="INC-EC-CYCLE",
    title="chain that is part of itself",
    severity=Severity.ERROR,
    target=EventChain,
    check=_check,
    rationale="am2inc ends with a segmentation fault.",
    remedy="Break the circle of references.",
    fails="""
<eventModel>
  <events xsi:type="am:ProcessEvent" name="a" entity="T?type=Task" eventType="start"/>
  <events xsi:type="am:ProcessEvent" name="b" entity="T?type=Task" eventType="terminate"/>
  <events xsi:type="am:CustomEvent" name="c"/>
</eventModel>
<swModel>
  <tasks name="T"/>
</swModel>
<constraintsModel>
  <eventChains name="C" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent">
    <items xsi:type="am:EventChainReference" eventChain="C?type=EventChain"/>
  </eventChains>
</constraintsModel>
""",
    passes="""
<eventModel>
  <events xsi:type="am:ProcessEvent" name="a" entity="T?type=Task" eventType="start"/>
  <events xsi:type="am:ProcessEvent" name="b" entity="T?type=Task" eventType="terminate"/>
  <events xsi:type="am:CustomEvent" name="c"/>
</eventModel>
<swModel>
  <tasks name="T"/>
</swModel>
<constraintsModel>
  <eventChains name="C" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
</constraintsModel>
""",
)
