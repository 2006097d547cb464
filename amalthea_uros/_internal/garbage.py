"""Garbage collection while many objects are made."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

#: With fewer objects, nothing is collected here; these take less than a gigabyte.
FEW_OBJECTS = 1_000_000


@contextmanager
def paused_garbage_collection() -> Iterator[None]:
    """Making a model makes many objects and no garbage: scanning them again and again would take half of the time."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
        if was_enabled and not gc.get_freeze_count():
            _keep()
    finally:
        if was_enabled:
            gc.enable()


class _Collected:
    """How many objects were left by the last collection here."""

    objects = 0


def _keep() -> None:
    """Move all new objects to the oldest generation, unscanned; else the first collection would go through them all.

    Python does not count objects that get there in this way, so that it would never collect them. This is done here once they have
    doubled, which keeps the effort proportional to the number of objects made.
    """
    gc.freeze()
    objects = gc.get_freeze_count()
    gc.unfreeze()
    if objects > max(FEW_OBJECTS, 2 * _Collected.objects):
        gc.collect()
        gc.freeze()
        _Collected.objects = gc.get_freeze_count()
        gc.unfreeze()
