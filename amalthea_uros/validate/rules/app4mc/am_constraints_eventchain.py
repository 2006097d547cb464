"""Segments that do not fit together."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractEventChain
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: AbstractEventChain, context: Context) -> Iterator[str]:
    parts = [chain for item in element.items if (chain := getattr(item, "event_chain", None)) is not None]
    if element.item_type == "parallel" or not parts or any(part.unresolved is not None for part in parts):
        return
    if element.stimulus is not parts[0].stimulus:
        yield "the first segment does not start with the stimulus of the chain"
    if element.response is not parts[-1].response:
        yield "the last segment does not end with the response of the chain"
    for number, (first, then) in enumerate(pairwise(parts), start=2):
        if first.response is not then.stimulus:
            yield f"the segment {number} does not start with the response of the one before it"


RULE = ModelRule(
    id="AM-Constraints-EventChain",
    title="segments that do not fit together",
    severity=Severity.ERROR,
    target=AbstractEventChain,
    check=_check,
    rationale="A chain is a path without gaps. APP4MC reports it when it validates the model.",
    remedy="Start each segment with the response of the one before it, and keep to the ends of the chain.",
    fails="""
<eventModel>
  <events xsi:type="am:CustomEvent" name="a"/>
  <events xsi:type="am:CustomEvent" name="b"/>
</eventModel>
<constraintsModel>
  <eventChains name="C" stimulus="a?type=CustomEvent" response="b?type=CustomEvent">
    <items xsi:type="am:EventChainContainer">
      <eventChain stimulus="b?type=CustomEvent" response="b?type=CustomEvent"/>
    </items>
  </eventChains>
</constraintsModel>
""",
    passes="""
<eventModel>
  <events xsi:type="am:CustomEvent" name="a"/>
  <events xsi:type="am:CustomEvent" name="b"/>
</eventModel>
<constraintsModel>
  <eventChains name="C" stimulus="a?type=CustomEvent" response="b?type=CustomEvent">
    <items xsi:type="am:EventChainContainer">
      <eventChain stimulus="a?type=CustomEvent" response="b?type=CustomEvent"/>
    </items>
  </eventChains>
</constraintsModel>
""",
)
