"""Execution need in an unknown unit."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ExecutionNeed, HwFeatureCategory, ProcessingUnit, ProcessingUnitDefinition
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.scheduling import units
from amalthea_uros.validate.wording import listed


def _check(element: ExecutionNeed, context: Context) -> Iterator[str]:
    types = context.once(_types)
    for key in (entry.key or "" for entry in element.needs):
        if types and all(not _has_cost(kind, key) for kind in types):
            yield f"need {key!r} is not a feature category of any processing unit in use"
        elif missing := [unit for unit in units(element, context) if not _has_cost(unit.definition, key)]:
            yield f"the cost of need {key!r} is not defined for {listed(missing)}"


def _types(context: Context) -> set[ProcessingUnitDefinition | None]:
    return {unit.definition for unit in context.all(ProcessingUnit)}


def _has_cost(definition: ProcessingUnitDefinition | None, need: str) -> bool:
    """Whether it is defined how many ticks a unit of a need takes on a type of processing unit."""
    if need == "Instructions":
        return True  # one instruction per tick if nothing else is defined
    features = definition.features if definition is not None else ()
    return any(
        isinstance(feature.container, HwFeatureCategory)
        and feature.container.name == need
        and feature.value
        and isfinite(feature.value)
        for feature in features
    )


RULE = ModelRule(
    id="TIM-UNIT",
    title="execution need in an unknown unit",
    severity=Severity.WARNING,
    target=ExecutionNeed,
    check=_check,
    rationale="The need cannot be converted into a time, so the load and the response times of everything that executes it "
    "are unknown.",
    remedy="Use a feature category as the key of the need, and give each processing unit definition that executes it a "
    "nonzero feature of this category.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:ExecutionNeed">
        <needs key="MATRIX">
          <value xsi:type="am:DiscreteValueConstant" value="100"/>
        </needs>
      </items>
    </activityGraph>
  </runnables>
</swModel>
<hwModel>
  <definitions xsi:type="am:ProcessingUnitDefinition" name="D" features="Matrix/cost?type=HwFeature"/>
  <featureCategories name="Matrix">
    <features name="cost" value="4.0"/>
  </featureCategories>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core" definition="D?type=ProcessingUnitDefinition"/>
  </structures>
</hwModel>
""",
    edits={'key="MATRIX"': 'key="Matrix"'},
)
