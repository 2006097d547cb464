"""Several hardware features of one category."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwFeature, HwFeatureCategory, ProcessingUnitDefinition
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def shared_categories(definition: ProcessingUnitDefinition) -> dict[HwFeatureCategory, list[HwFeature]]:
    """The categories from which a definition refers to more than one feature, with these features."""
    found: dict[HwFeatureCategory, list[HwFeature]] = {}
    for feature in dict.fromkeys(definition.features):
        if isinstance(feature.container, HwFeatureCategory):
            found.setdefault(feature.container, []).append(feature)
    return {category: features for category, features in found.items() if len(features) > 1}


def _check_definition(element: ProcessingUnitDefinition, context: Context) -> Iterator[str]:
    for features in shared_categories(element).values():
        for feature in features:
            yield f"feature {feature.name!r} is not the only feature of its category in {element.name!r}"


def _check_category(element: ProcessingUnitDefinition, context: Context) -> Iterator[str]:
    for category, features in shared_categories(element).items():
        yield f"{element.name!r} has {len(features)} features of category {category.name!r}"


RULES = (
    ModelRule(
        id="AM-HW-Definition",
        title="hardware features of the same category",
        severity=Severity.ERROR,
        target=ProcessingUnitDefinition,
        check=_check_definition,
        rationale="Execution needs select a feature by its category; with several features the selection is ambiguous. APP4MC's "
        "validation also reports it.",
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
        edits={
            'features="I/a?type=HwFeature I/b?type=HwFeature"': 'features="I/a?type=HwFeature"',
            '    <features name="b"/>\n': "",
        },
    ),
    ModelRule(
        id="DOC-Feature-Single",
        title="category with several features",
        severity=Severity.ERROR,
        target=ProcessingUnitDefinition,
        check=_check_category,
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
    ),
)
