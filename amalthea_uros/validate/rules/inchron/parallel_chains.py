"""Parallel branches of event chains."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractEventChain
from amalthea_uros.validate.chains import ends, parts
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import TASK_EVENTS
from amalthea_uros.validate.rule import Downgraded, ModelRule
from amalthea_uros.validate.rules.inchron._chains import is_parallel


def _check_ends(element: AbstractEventChain, context: Context) -> Iterator[str]:
    if not is_parallel(element):
        return
    branches = parts(element)
    for branch in branches:
        if ends(branch) != ends(element):
            yield f"the branch {branch.name or ''!r} and its event chain {element.name or ''!r} differ in stimulus or response"
    if len(branches) < len(element.items):
        yield f"the event chain {element.name or ''!r} has an item without a chain, which am2inc skips"


def _check_items(element: AbstractEventChain, context: Context) -> Iterator[str | Downgraded]:
    branches = parts(element) if is_parallel(element) else []
    # Otherwise the event chain is dropped.
    is_converted = all(ends(branch) == ends(element) for branch in branches)
    for branch in branches:
        if not branch.items:
            message = f"the branch {branch.name or ''!r} of the event chain {element.name or ''!r} has no items"
            yield message if is_converted else Downgraded(message)


RULES = (
    ModelRule(
        id="INC-EC-PAR",
        title="parallel branch with a different stimulus or response",
        severity=Severity.WARNING,
        target=AbstractEventChain,
        check=_check_ends,
        rationale="am2inc drops the event chain and prints a warning. It silently skips items without a chain.",
        remedy="Give every branch the stimulus and the response of the event chain, and remove items without a chain.",
        fails=f"""
{TASK_EVENTS}
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
    ),
    ModelRule(
        id="INC-EC-PAR-ITEMS",
        title="parallel branch without items",
        severity=Severity.ERROR,
        target=AbstractEventChain,
        check=_check_items,
        rationale="am2inc silently writes a broken event graph, unless it drops the event chain because the branches differ in "
        "stimulus or response (warning).",
        remedy="Add at least one segment to every branch.",
        fails=f"""
{TASK_EVENTS}
<swModel>
  <tasks name="T"/>
</swModel>
<constraintsModel>
  <eventChains name="C" itemType="parallel" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent">
    <items xsi:type="am:EventChainContainer">
      <eventChain stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
    </items>
    <items xsi:type="am:EventChainContainer">
      <eventChain stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
    </items>
  </eventChains>
</constraintsModel>
""",
        edits={
            """<eventChain stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
    </items>
    <items xsi:type="am:EventChainContainer">""": """<eventChain stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent">
        <items xsi:type="am:EventChainContainer">
          <eventChain stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
        </items>
      </eventChain>
    </items>
    <items xsi:type="am:EventChainContainer">""",
            """<eventChain stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
    </items>
  </eventChains>""": """<eventChain stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent">
        <items xsi:type="am:EventChainContainer">
          <eventChain stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
        </items>
      </eventChain>
    </items>
  </eventChains>""",
        },
    ),
)
