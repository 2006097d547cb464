"""The messages of a host that recordings of ROS 2 show as chains, from publication to callback."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

from amalthea_uros.perf.host import Host, HostCallback

#: Between a topic and the node that subscribes to it.
ARROW = " -> "


def receptions(host: Host) -> Mapping[str, HostCallback]:
    """The subscriptions by the names that the chains of their messages have in recordings."""
    named = [(f"/{each.topic}{ARROW}{each.group.rpartition('/')[0]}", each) for each in host.callbacks if each.topic]
    counts = Counter(name for name, _ in named)
    return {name: callback for name, callback in named if counts[name] == 1}
