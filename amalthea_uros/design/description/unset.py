"""Values that a description leaves open, and without which nothing bounds how long messages take."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.description.keys import short_name
from amalthea_uros.design.description.origin import DescriptionOrigin

#: The sections of the middleware with such times, and their keys.
_TIMES = {"transport": ("latency",), "agent": ("to_controller", "to_host", "acknowledgement")}
#: An example, which nobody takes for the time of his network.
_EXAMPLE = "{min: 0 ms, max: 1 ms}"


def unset_times(origin: DescriptionOrigin) -> Iterator[Change]:
    """Examples of the times that messages take in networks, agents and the host, where none is stated."""
    keys = origin.keys
    for key in keys:
        if (
            key.path[:1] == ("middleware",)
            and len(key.path) > 2
            and key.field in _TIMES.get(str(key.path[1]), ())
            and key.value is None
        ):
            target, _, field = short_name(key, keys).rpartition(".")
            yield Change(target, field, _EXAMPLE)
