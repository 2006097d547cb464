"""Chain without an end."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractEventChain
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: AbstractEventChain, context: Context) -> Iterator[str]:
    if element.stimulus is None or element.response is None:
        yield f"the chain {element.name or ''!r} lacks its stimulus or its response"


RULE = ModelRule(
    id="INC-EC-ENDS",
    title="chain without an end",
    severity=Severity.WARNING,
    target=AbstractEventChain,
    check=_check,
    rationale="The chain is dropped, with a warning.",
    remedy="Name its stimulus and its response.",
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
  <eventChains name="C" stimulus="a?type=ProcessEvent"/>
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
