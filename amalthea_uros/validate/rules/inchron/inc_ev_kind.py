"""Chain with an event that is not converted."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractEventChain, EventSet, LabelEvent, ProcessEvent, RunnableEvent
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: AbstractEventChain, context: Context) -> Iterator[str]:
    for event in (element.stimulus, element.response):
        if event is not None and not isinstance(event, ProcessEvent | RunnableEvent | LabelEvent | EventSet):
            yield f"the event {event.name!r} is not converted, and the chain is dropped"


RULE = ModelRule(
    id="INC-EV-KIND",
    title="chain with an event that is not converted",
    severity=Severity.WARNING,
    target=AbstractEventChain,
    check=_check,
    rationale="The chain is dropped, with a warning.",
    remedy="Use events of processes, runnables or labels.",
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
  <eventChains name="C" stimulus="c?type=CustomEvent" response="b?type=ProcessEvent"/>
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
