"""Parallel branch with a different stimulus or response."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractEventChain
from amalthea_uros.validate.chains import ends, parts
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._chains import is_parallel


def _check(element: AbstractEventChain, context: Context) -> Iterator[str]:
    if not is_parallel(element):
        return
    branches = parts(element)
    for branch in branches:
        if ends(branch) != ends(element):
            yield f"the branch {branch.name or ''!r} and its event chain {element.name or ''!r} differ in stimulus or response"
    if len(branches) < len(element.items):
        yield f"the event chain {element.name or ''!r} has an item without a chain, which am2inc skips"


RULE = ModelRule(
    id="INC-EC-PAR",
    title="parallel branch with a different stimulus or response",
    severity=Severity.WARNING,
    target=AbstractEventChain,
    check=_check,
    rationale="am2inc drops the event chain and prints a warning. It silently skips items without a chain.",
    remedy="Give every branch the stimulus and the response of the event chain, and remove items without a chain.",
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
    <items xsi:type="am:EventChainContainer">
      <eventChain stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
    </items>
  </eventChains>
</constraintsModel>
""",
    edits={'stimulus="b?type=ProcessEvent"': 'stimulus="a?type=ProcessEvent"'},
)
