"""Features that tell how many instructions a core executes in a cycle."""

from __future__ import annotations

from amalthea_uros.metamodel.classes import HwFeature
from amalthea_uros.metamodel.naming import name_of


def is_per_cycle(feature: HwFeature) -> bool:
    """Whether a feature tells it, by the names of it and its category."""
    return name_of(feature.container).lower() == "instructions" and name_of(feature).startswith("IPC_")
