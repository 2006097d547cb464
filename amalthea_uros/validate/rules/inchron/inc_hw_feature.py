"""Hardware feature on which execution times depend."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwFeature, HwFeatureCategory, NeedEntry
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: HwFeature, context: Context) -> Iterator[str]:
    category = element.container
    if isinstance(category, HwFeatureCategory) and category.name in context.once(_needed):
        yield f"the feature {element.name!r}, on which execution needs of {category.name!r} depend, is ignored"


def _needed(context: Context) -> set[str | None]:
    """The categories of features that execution needs name."""
    return {entry.key for entry in context.all(NeedEntry)}


RULE = ModelRule(
    id="INC-HW-FEATURE",
    title="hardware feature on which execution times depend",
    severity=Severity.WARNING,
    target=HwFeature,
    check=_check,
    rationale="am2inc ignores features, also those from which execution times follow, without a word.",
    remedy="State execution times as Ticks.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:ExecutionNeed">
        <needs key="Instructions">
          <value xsi:type="am:DiscreteValueConstant" value="100"/>
        </needs>
      </items>
    </activityGraph>
  </runnables>
</swModel>
<hwModel>
  <featureCategories name="Instructions">
    <features name="IPC" value="1.5"/>
  </featureCategories>
</hwModel>
""",
    passes="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueConstant" value="100"/>
      </items>
    </activityGraph>
  </runnables>
</swModel>
<hwModel>
  <featureCategories name="Instructions">
    <features name="IPC" value="1.5"/>
  </featureCategories>
</hwModel>
""",
)
