"""Features that define the instructions per cycle (IPC) of a core."""

from __future__ import annotations

from amalthea_uros.metamodel.classes import HwFeature
from amalthea_uros.metamodel.naming import name_of


def is_per_cycle(feature: HwFeature) -> bool:
    """Whether a feature defines the IPC, judged by its name and the name of its category."""
    return name_of(feature.container).lower() == "instructions" and name_of(feature).startswith("IPC_")
