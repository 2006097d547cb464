"""Content that the published conversions lose, and that comes back beyond them."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.postponed import Postponed

#: The first version after those of which the content of ITEA versions was published as converted.
BEYOND_ITEA = "0.7.1"

#: The first version after those that the official converters were published for step by step.
BEYOND_CONVERTERS = "0.9.6"


def lose_for_now(models: ModelSet, notes: Notes, official: bool, content: Postponed) -> None:
    """Leave content out up to a version; for good, as the official converter does."""
    if official:
        notes.lost(content.node, content.message, content.detail, content.attribute)
    else:
        models.postponed.append(content)
