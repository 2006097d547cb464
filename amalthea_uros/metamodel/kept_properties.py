"""Keys of the custom properties in which a model of an older version keeps what only newer versions have features for."""

from __future__ import annotations


def prefix(version: str) -> str:
    """The start of the keys of all properties that keep content of that version."""
    return f"AMALTHEA {version}: "


#: Of semaphores: whether only the holder may release it.
OWNERSHIP = prefix("3.0.0") + "ownership"
#: Of schedulers and allocations: the name of a scheduling parameter follows.
SCHEDULING_PARAMETER = prefix("2.0.0") + "schedulingParameters/"
#: Of schedulers: the same of a parameter that the association with the parent has.
PARENT_PARAMETER = prefix("2.0.0") + "parentAssociation/schedulingParameters/"
