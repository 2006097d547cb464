"""Messages that are stored, and those that are lost because there is no room.

All subscriptions, services and clients of a process share one pool of slots, whatever their executor. A message for a handle that has
`depth` messages overwrites the oldest of them, or is dropped itself if all are to be kept. Below that depth, a message for which the
pool has no slot is dropped (micro-ROS/rmw_microxrcedds, src/callbacks.c, src/types.c).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from amalthea_uros.perf.executors import Handle, HandleKind
from amalthea_uros.units import SECOND

#: A stored message is removed when it is older than the lifespan of its QoS, by default 30 s.
LIFESPAN = 30 * SECOND


def can_exceed_depth(handle: Handle, stored: int) -> bool:
    """Whether so many messages are more than a handle keeps."""
    return handle.depth is not None and stored > handle.depth


def slots_needed(handles: Iterable[Handle], stored: Mapping[str, int | None]) -> int | None:
    """The slots for the messages of all handles, by their names; None if a number of messages is not known, and nothing limits it."""
    kept = [_kept(handle, stored[handle.name]) for handle in handles]
    return None if None in kept else sum(filter(None, kept))


def _kept(handle: Handle, stored: int | None) -> int | None:
    """How many messages of a handle can occupy slots."""
    # Each entity behind an action keeps as many; of a server's, one is a timer.
    entities = handle.sources - (handle.kind is HandleKind.ACTION_SERVER and handle.sources > 1)
    depth = None if handle.depth is None else handle.depth * entities
    known = [number for number in (depth, stored) if number is not None]
    return min(known) if known else None
