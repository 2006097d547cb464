"""Definitions of hardware modules, and their features."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.metamodel.classes import (
    Cache,
    ConnectionHandler,
    HwFeature,
    HwFeatureCategory,
    HwModule,
    Memory,
    ProcessingUnit,
    ProcessingUnitDefinition,
)
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule


@model_rule("AM-HW-Module-Definition", HwModule)
def _check_module_definition(element: HwModule, context: Context) -> Iterator[str]:
    if isinstance(element, Memory | ProcessingUnit | ConnectionHandler | Cache) and element.definition is None:
        yield f"{element.name!r} has no definition"


def shared_categories(definition: ProcessingUnitDefinition) -> dict[HwFeatureCategory, list[HwFeature]]:
    """The categories from which a definition refers to more than one feature, with these features."""
    found: dict[HwFeatureCategory, list[HwFeature]] = {}
    for feature in dict.fromkeys(definition.features):
        if isinstance(feature.container, HwFeatureCategory):
            found.setdefault(feature.container, []).append(feature)
    return {category: features for category, features in found.items() if len(features) > 1}


@model_rule("AM-HW-Definition", ProcessingUnitDefinition)
def _check_definition(element: ProcessingUnitDefinition, context: Context) -> Iterator[str]:
    for features in shared_categories(element).values():
        for feature in features:
            yield f"feature {feature.name!r} is not the only feature of its category in {element.name!r}"


@model_rule("DOC-Feature-Single", ProcessingUnitDefinition)
def _check_category(element: ProcessingUnitDefinition, context: Context) -> Iterator[str]:
    for category, features in shared_categories(element).items():
        yield f"{element.name!r} has {len(features)} features of category {category.name!r}"
