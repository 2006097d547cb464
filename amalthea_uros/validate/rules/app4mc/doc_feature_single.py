"""Category with several features."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ProcessingUnitDefinition
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.app4mc._features import shared_categories


def _check(element: ProcessingUnitDefinition, context: Context) -> Iterator[str]:
    for category, features in shared_categories(element).items():
        yield f"{element.name!r} has {len(features)} features of category {category.name!r}"


RULE = ModelRule(
    id="DOC-Feature-Single",
    title="category with several features",
    severity=Severity.ERROR,
    target=ProcessingUnitDefinition,
    check=_check,
    rationale="It is undefined which feature an execution need refers to. The APP4MC documentation requires at most one "
    "feature per category.",
    remedy="Refer to only one feature of each category.",
    fails="""
<hwModel>
  <definitions xsi:type="am:ProcessingUnitDefinition" name="D" features="I/a?type=HwFeature I/b?type=HwFeature"/>
  <featureCategories name="I">
    <features name="a"/>
    <features name="b"/>
  </featureCategories>
</hwModel>
""",
    edits={'features="I/a?type=HwFeature I/b?type=HwFeature"': 'features="I/a?type=HwFeature"'},
)
