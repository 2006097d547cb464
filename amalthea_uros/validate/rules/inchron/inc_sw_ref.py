"""Item that refers to nothing."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    ActivityGraphItem,
    ClearEvent,
    InterProcessTrigger,
    LabelAccess,
    ModeLabelAccess,
    ProcessPrototype,
    RunnableCall,
    SetEvent,
    WaitEvent,
)
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

#: What each of these has to refer to.
_REFERENCES: dict[type[ActivityGraphItem], str] = {
    RunnableCall: "runnable",
    LabelAccess: "data",
    ModeLabelAccess: "data",
    InterProcessTrigger: "stimulus",
    SetEvent: "event_mask",
    ClearEvent: "event_mask",
    WaitEvent: "event_mask",
}


def _check(element: ActivityGraphItem, context: Context) -> Iterator[str]:
    feature = _REFERENCES[type(element)]
    # The calls of prototypes are never looked at.
    if getattr(element, feature) is None and not isinstance(element.container, ProcessPrototype):
        yield f"the {type(element).__name__} names no {feature.replace('_', ' ')}"


RULE = ModelRule(
    id="INC-SW-REF",
    title="item that refers to nothing",
    severity=Severity.ERROR,
    target=tuple(_REFERENCES),
    check=_check,
    rationale="am2inc ends with a segmentation fault.",
    remedy="Name what is called, accessed, triggered or waited for.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:RunnableCall"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    passes="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="Other?type=Runnable"/>
    </activityGraph>
  </runnables>
  <runnables name="Other"/>
</swModel>
""",
)
