"""Activity item without a target."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ActivityGraphItem, ClearEvent, ProcessPrototype, SetEvent, WaitEvent
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._needed import OF_ITEMS

#: What each of these items needs.
_PARTS = {**OF_ITEMS, **dict.fromkeys((SetEvent, ClearEvent, WaitEvent), "event_mask")}


def _check(element: ActivityGraphItem, context: Context) -> Iterator[str]:
    feature = _PARTS[type(element)]
    # am2inc does not read the calls of prototypes.
    if getattr(element, feature) is None and not isinstance(element.container, ProcessPrototype):
        yield f"the {feature.replace('_', ' ')} of the {type(element).__name__} is not set"


RULE = ModelRule(
    id="INC-SW-REF",
    title="activity item without a target",
    severity=Severity.ERROR,
    target=tuple(_PARTS),
    check=_check,
    rationale="am2inc crashes with a segmentation fault.",
    remedy="Set the runnable, label, stimulus or event mask that the item uses.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:RunnableCall"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={
        'xsi:type="am:RunnableCall"': 'xsi:type="am:RunnableCall" runnable="Other?type=Runnable"',
        "</swModel>": """  <runnables name="Other"/>
</swModel>""",
    },
)
