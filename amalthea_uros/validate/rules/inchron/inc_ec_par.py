"""Branch with other ends than its chain."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractEventChain
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: AbstractEventChain, context: Context) -> Iterator[str]:
    branches = [chain for item in element.items if (chain := getattr(item, "event_chain", None)) is not None]
    ends = (element.stimulus, element.response)
    if element.item_type == "parallel" and any((b.stimulus, b.response) != ends for b in branches):
        yield f"a branch of the chain {element.name or ''!r} has other ends than the chain"


RULE = ModelRule(
    id="INC-EC-PAR",
    title="branch with other ends than its chain",
    severity=Severity.WARNING,
    target=AbstractEventChain,
    check=_check,
    rationale="The chain is dropped, with a warning.",
    remedy="Give each branch the stimulus and the response of the chain.",
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
  <eventChains name="C" itemType="parallel" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent">
    <items xsi:type="am:EventChainContainer">
      <eventChain stimulus="b?type=ProcessEvent" response="b?type=ProcessEvent"/>
    </items>
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
  <eventChains name="C" itemType="parallel" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent">
    <items xsi:type="am:EventChainContainer">
      <eventChain stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
    </items>
  </eventChains>
</constraintsModel>
""",
)
