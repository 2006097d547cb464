"""Hardware feature used by execution needs."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwFeature, HwFeatureCategory, NeedEntry
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: HwFeature, context: Context) -> Iterator[str]:
    category = element.container
    if isinstance(category, HwFeatureCategory) and category.name in context.once(_needed):
        name = element.name or ""
        yield f"the feature {name!r} is ignored by am2inc, although execution needs for {category.name!r} depend on it"


def _needed(context: Context) -> set[str | None]:
    """The names of the feature categories that execution needs use."""
    return {entry.key for entry in context.all(NeedEntry)}


RULE = ModelRule(
    id="INC-HW-FEATURE",
    title="hardware feature used by execution needs",
    severity=Severity.WARNING,
    target=HwFeature,
    check=_check,
    rationale="am2inc silently ignores hardware features, so execution times that depend on them are lost.",
    remedy="Specify execution times as Ticks.",
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
    edits={
        """<items xsi:type="am:ExecutionNeed">
        <needs key="Instructions">
          <value xsi:type="am:DiscreteValueConstant" value="100"/>
        </needs>""": """<items xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueConstant" value="100"/>""",
    },
)
