"""Event chain with a gap."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractEventChain
from amalthea_uros.validate.chains import parts
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: AbstractEventChain, context: Context) -> Iterator[str]:
    segments = parts(element)
    if element.item_type == "parallel" or not segments or any(segment.unresolved is not None for segment in segments):
        return
    if element.stimulus is not segments[0].stimulus:
        yield "the first segment does not start with the stimulus of the chain"
    if element.response is not segments[-1].response:
        yield "the last segment does not end with the response of the chain"
    for number, (first, then) in enumerate(pairwise(segments), start=2):
        if first.response is not then.stimulus:
            yield f"segment {number} does not start with the response of segment {number - 1}"


RULE = ModelRule(
    id="AM-Constraints-EventChain",
    title="event chain with a gap",
    severity=Severity.ERROR,
    target=AbstractEventChain,
    check=_check,
    rationale="The segments of an event chain must form a path from its stimulus to its response. APP4MC's validation also reports it.",
    remedy="Start each segment at the response of the previous one, and begin and end with the stimulus and response of the chain.",
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
    edits={'stimulus="b?type=CustomEvent"': 'stimulus="a?type=CustomEvent"'},
)
