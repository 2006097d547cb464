"""Messages that are stored, and those that are lost because there is no room.

All subscriptions, services and clients share one pool of slots. A message for a handle that has `depth` messages overwrites the
oldest of them, or is dropped itself if all are to be kept. Below that depth, a message for which the pool has no slot is dropped
(micro-ROS/rmw_microxrcedds, src/callbacks.c, src/types.c).
"""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros.perf.executors import Executor, Handle
from amalthea_uros.units import SECOND

#: A stored message is removed when it is older than the lifespan of its QoS, by default 30 s.
LIFESPAN = 30 * SECOND


def can_exceed_depth(handle: Handle, stored: int) -> bool:
    """Whether so many messages are more than a handle keeps."""
    return handle.depth is not None and stored > handle.depth


def slots_needed(executor: Executor, stored: Mapping[str, int]) -> int:
    """The slots for the messages of all handles, with those by the names of handles."""
    return sum(
        stored[handle.name] if handle.depth is None else min(stored[handle.name], handle.depth)
        for handle in executor.handles
        if handle.name in stored
    )
