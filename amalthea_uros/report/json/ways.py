"""The ways of messages for programs."""

from __future__ import annotations

from typing import Any

from amalthea_uros.analyze.ways.results import Way
from amalthea_uros.executors.results import Hop
from amalthea_uros.report.json.executors import part_json


def way_json(way: Way) -> dict[str, Any]:
    """A way with its hops; times in picoseconds."""
    return {
        "name": way.name,
        "start": way.start,
        "end": way.end,
        "best_ps": way.best,
        "worst_ps": way.worst,
        "worst_if_not_lost_ps": way.delivered,
        "reason": way.reason,
        "remedy": way.remedy,
        "loss": way.loss,
        "assumptions": list(way.assumptions),
        "hops": [hop_json(hop, way) for hop in way.hops],
    }


def hop_json(hop: Hop, way: Way) -> dict[str, Any]:
    """A hop, with its part of the latency."""
    share = way.share(hop)
    return {
        "kind": hop.kind,
        "name": hop.name,
        "best_ps": hop.best,
        "worst_ps": hop.worst,
        "share": None if share is None else float(share),
        "source": hop.source,
        "reason": hop.reason,
        "remedy": hop.remedy,
        "parts": list(map(part_json, hop.parts)),
    }
