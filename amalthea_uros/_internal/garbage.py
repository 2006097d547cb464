"""Garbage collection while many objects are made."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def paused_garbage_collection() -> Iterator[None]:
    """Making a model makes many objects and no garbage: scanning them again and again would take half of the time."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
        if was_enabled and not gc.get_freeze_count():
            # Moves the new objects to the oldest generation, unscanned; else the first collection would go through them all.
            gc.freeze()
            gc.unfreeze()
    finally:
        if was_enabled:
            gc.enable()
