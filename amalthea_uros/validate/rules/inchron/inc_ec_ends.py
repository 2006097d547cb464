"""Event chain without a stimulus or response."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractEventChain, EventChain
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, ModelRule
from amalthea_uros.validate.rules.inchron._missing import missing


def _check(element: AbstractEventChain, context: Context) -> Iterator[str | Downgraded]:
    absent = missing({"stimulus": element.stimulus, "response": element.response})
    if absent:
        message = f"the event chain {element.name or ''!r} has no {absent}"
        yield f"{message} of its own" if isinstance(element, EventChain) and element.items else Downgraded(message)


RULE = ModelRule(
    id="INC-EC-ENDS",
    title="event chain without a stimulus or response",
    severity=Severity.ERROR,
    target=AbstractEventChain,
    check=_check,
    rationale="am2inc crashes if an event chain with items has no stimulus or response of its own. It drops an event chain without "
    "items, and one with such a segment, and prints a warning.",
    remedy="Set the stimulus and the response of the event chain.",
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
  <eventChains name="C" stimulus="a?type=ProcessEvent">
    <items xsi:type="am:EventChainContainer">
      <eventChain name="segment" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
    </items>
  </eventChains>
</constraintsModel>
""",
    edits={
        """<eventChains name="C" stimulus="a?type=ProcessEvent">
    <items xsi:type="am:EventChainContainer">
      <eventChain name="segment" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
    </items>
  </eventChains>""": '<eventChains name="C" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>',
    },
)
