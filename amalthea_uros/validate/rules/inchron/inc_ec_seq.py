"""Event chain with mismatched segments."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractEventChain
from amalthea_uros.validate.chains import parts
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import TASK_EVENTS
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._chains import is_parallel


def _check(element: AbstractEventChain, context: Context) -> Iterator[str]:
    if is_parallel(element) or not element.items:
        return
    name, segments = element.name or "", parts(element)
    if len(segments) < len(element.items):
        yield f"the event chain {name!r} has an item without a chain, which am2inc skips"
    if any(segment.unresolved is not None for segment in segments):
        return
    expected = [element.stimulus, *(segment.response for segment in segments)]
    if segments and ([segment.stimulus for segment in segments] != expected[:-1] or expected[-1] is not element.response):
        yield f"the segments of the event chain {name!r} do not connect its stimulus to its response"


RULE = ModelRule(
    id="INC-EC-SEQ",
    title="event chain with mismatched segments",
    severity=Severity.WARNING,
    target=AbstractEventChain,
    check=_check,
    rationale="am2inc silently changes the event chain: it skips items without a chain, and reads only the stimulus and "
    "response of the chain and the stimuli of the second and later segments.",
    remedy="Remove items without a chain, and let the segments lead without gaps from the stimulus of the chain to its "
    "response.",
    fails=f"""
{TASK_EVENTS}
<swModel>
  <tasks name="T"/>
</swModel>
<constraintsModel>
  <eventChains name="C" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent">
    <items xsi:type="am:EventChainContainer">
      <eventChain stimulus="b?type=ProcessEvent" response="b?type=ProcessEvent"/>
    </items>
  </eventChains>
</constraintsModel>
""",
    edits={'stimulus="b?type=ProcessEvent"': 'stimulus="a?type=ProcessEvent"'},
)
