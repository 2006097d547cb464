"""Garbage collection while many objects are made."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

#: As long as fewer objects have been made since the last collection, nothing is collected here.
FEW_OBJECTS = 300_000


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

    Python does not count objects that get there in this way, so that it would never collect them. Here they are collected as Python
    does it: once a quarter has been added, but later where the process has asked for rare collections.
    """
    objects = _moved()
    few = max(FEW_OBJECTS, 20 * gc.get_threshold()[0], _Collected.objects // 4)
    if objects > _Collected.objects + few:
        gc.collect()
        _Collected.objects = _moved()


def _moved() -> int:
    """Move all objects to the oldest generation; returns their number."""
    gc.freeze()
    objects = gc.get_freeze_count()
    gc.unfreeze()
    return objects
