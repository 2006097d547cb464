"""Features of processing units."""

from __future__ import annotations

from amalthea_uros.metamodel.classes import HwFeature, HwFeatureCategory, ProcessingUnitDefinition


def shared_categories(definition: ProcessingUnitDefinition) -> dict[HwFeatureCategory, list[HwFeature]]:
    """The categories from which a definition refers to more than one feature, with these features."""
    found: dict[HwFeatureCategory, list[HwFeature]] = {}
    for feature in dict.fromkeys(definition.features):
        if isinstance(feature.container, HwFeatureCategory):
            found.setdefault(feature.container, []).append(feature)
    return {category: features for category, features in found.items() if len(features) > 1}
