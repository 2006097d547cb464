"""Features of processing units."""

from __future__ import annotations

from amalthea_uros.metamodel.classes import HwFeature, HwFeatureCategory, ProcessingUnitDefinition


def shared_categories(definition: ProcessingUnitDefinition) -> dict[HwFeatureCategory, list[HwFeature]]:
    """The categories of which a definition has more than one feature, with these."""
    found: dict[HwFeatureCategory, list[HwFeature]] = {}
    for feature in dict.fromkeys(definition.features):
        if isinstance(feature.container, HwFeatureCategory):
            found.setdefault(feature.container, []).append(feature)
    return {category: features for category, features in found.items() if len(features) > 1}
