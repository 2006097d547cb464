"""Parallel branch without items."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractEventChain
from amalthea_uros.validate.chains import ends, parts
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, ModelRule
from amalthea_uros.validate.rules.inchron._chains import is_parallel


def _check(element: AbstractEventChain, context: Context) -> Iterator[str | Downgraded]:
    branches = parts(element) if is_parallel(element) else []
    # Otherwise the event chain is dropped.
    is_converted = all(ends(branch) == ends(element) for branch in branches)
    for branch in branches:
        if not branch.items:
            message = f"the branch {branch.name or ''!r} of the event chain {element.name or ''!r} has no items"
            yield message if is_converted else Downgraded(message)


RULE = ModelRule(
    id="INC-EC-PAR-ITEMS",
    title="parallel branch without items",
    severity=Severity.ERROR,
    target=AbstractEventChain,
    check=_check,
    rationale="am2inc silently writes a broken event graph, unless it drops the event chain because the branches differ in stimulus "
    "or response (warning).",
    remedy="Add at least one segment to every branch.",
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
)
