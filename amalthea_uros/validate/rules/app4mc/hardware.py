"""Definitions of hardware modules, and their features."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.metamodel import classes as am
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule


@model_rule("AM-HW-Module-Definition", am.HwModule)
def _check_module_definition(element: am.HwModule, context: Context) -> Iterator[str]:
    if isinstance(element, am.Memory | am.ProcessingUnit | am.ConnectionHandler | am.Cache) and element.definition is None:
        yield f"{element.name!r} has no definition"


def shared_categories(definition: am.ProcessingUnitDefinition) -> dict[am.HwFeatureCategory, list[am.HwFeature]]:
    """The categories from which a definition refers to more than one feature, with these features."""
    found: dict[am.HwFeatureCategory, list[am.HwFeature]] = {}
    for feature in dict.fromkeys(definition.features):
        if isinstance(feature.container, am.HwFeatureCategory):
            found.setdefault(feature.container, []).append(feature)
    return {category: features for category, features in found.items() if len(features) > 1}


@model_rule("AM-HW-Definition", am.ProcessingUnitDefinition)
def _check_definition(element: am.ProcessingUnitDefinition, context: Context) -> Iterator[str]:
    for features in shared_categories(element).values():
        for feature in features:
            yield f"feature {feature.name!r} is not the only feature of its category in {element.name!r}"


@model_rule("DOC-Feature-Single", am.ProcessingUnitDefinition)
def _check_category(element: am.ProcessingUnitDefinition, context: Context) -> Iterator[str]:
    for category, features in shared_categories(element).items():
        yield f"{element.name!r} has {len(features)} features of category {category.name!r}"
