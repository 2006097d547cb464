"""Garbage collection while many objects are made."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

#: As long as fewer objects have been made since the last collection, nothing is collected here.
FEW_OBJECTS = 300_000
#: More than Python itself keeps from collections when it starts: 375 objects in 3.12, none in 3.11 and 3.13.
FROZEN_BY_PYTHON = 1_000


@contextmanager
def paused_garbage_collection() -> Iterator[None]:
    """Making a model makes many objects and no garbage: scanning them again and again would take half of the time."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
        if was_enabled and gc.get_freeze_count() < FROZEN_BY_PYTHON:
            _keep()
    finally:
        if was_enabled:
            gc.enable()


class _Collected:
    """How many objects were left by the last collection here, and how many have been made since then."""

    left = 0
    made = 0


def _keep() -> None:
    """Move all new objects to the oldest generation, unscanned; else the first collection would go through them all.

    Python does not count objects that get there in this way, so that it would never collect them. Here they are collected as Python
    does it: once a quarter has been added, but later where the process has asked for rare collections.
    """
    _Collected.made += gc.get_count()[0]
    gc.freeze()
    gc.unfreeze()
    if _Collected.made > max(FEW_OBJECTS, 20 * gc.get_threshold()[0], _Collected.left // 4):
        gc.collect()
        gc.freeze()
        _Collected.left, _Collected.made = gc.get_freeze_count(), 0
        gc.unfreeze()
