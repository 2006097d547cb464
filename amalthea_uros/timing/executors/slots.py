"""Messages that are stored, and those that are lost because there is no room.

All subscriptions, services and clients of a process share one pool of slots, whatever their executor. A message for a handle that has
`depth` messages overwrites the oldest of them, or is dropped itself if all are to be kept. Below that depth, a message for which the
pool has no slot is dropped (micro-ROS/rmw_microxrcedds, src/callbacks.c, src/types.c).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from amalthea_uros.perf.executors import Handle
from amalthea_uros.units import SECOND

#: A stored message is removed when it is older than the lifespan of its QoS, by default 30 s.
LIFESPAN = 30 * SECOND


def can_exceed_depth(handle: Handle, stored: int) -> bool:
    """Whether so many messages are more than a handle keeps."""
    return handle.depth is not None and stored > handle.depth


def can_exceed_slots(slots: int | None, handles: Iterable[Handle], stored: Mapping[str, int | None]) -> bool:
    """Whether the messages of all handles can be more than there are slots; by the names of handles, None for an unknown number."""
    kept = [_kept(handle, stored[handle.name]) for handle in handles]
    return slots is not None and (None in kept or sum(filter(None, kept)) > slots)


def _kept(handle: Handle, stored: int | None) -> int | None:
    """How many messages of a handle can occupy slots."""
    known = [number for number in (handle.depth, stored) if number is not None]
    return min(known) if known else None
