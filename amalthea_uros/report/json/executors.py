"""Executors that spin in loops, and the hops of chains over them, for programs."""

from __future__ import annotations

from typing import Any

from amalthea_uros.executors.results import ExecutorResult, HandleResult, Hop, Loss, TimePart


def executor_json(executor: ExecutorResult) -> dict[str, Any]:
    """The rounds of an executor, and its handles in their order."""
    return {
        "name": executor.name,
        "task": executor.task,
        "round": {"min_ps": executor.round.least, "max_ps": executor.round.most},
        "loop": {"min_ps": executor.loop.least, "max_ps": executor.loop.most},
        "reason": executor.reason,
        "handles": [handle_json(handle) for handle in executor.handles],
    }


def handle_json(handle: HandleResult) -> dict[str, Any]:
    """The response time of a handle, and what can be lost."""
    response, lateness = handle.response, handle.lateness
    return {
        "name": handle.name,
        "kind": handle.kind,
        "callback": handle.runnable,
        "interval_ps": handle.interval,
        "bcrt_ps": response.best,
        "wcrt_ps": response.worst,
        "lateness_ps": None if lateness is None else lateness.most,
        "claim": response.claim,
        "method": response.method,
        "source": response.source,
        "reason": response.reason,
        "lost": None if handle.lost is None else _loss_json(handle.lost),
        "terms": [part_json(term) for term in handle.terms],
    }


def _loss_json(loss: Loss) -> dict[str, Any]:
    return {"what": loss.what, "is_certain": loss.is_certain, "most": loss.most, "sequence": loss.sequence}


def part_json(part: TimePart) -> dict[str, Any]:
    """A part of a response time or of a hop."""
    return {"name": part.name, "min_ps": part.least, "max_ps": part.most, "why": part.why}


def hop_json(hop: Hop) -> dict[str, Any]:
    """A hop, with its part of the latency."""
    return {
        "kind": hop.kind,
        "name": hop.name,
        "best_ps": hop.best,
        "worst_ps": hop.worst,
        "share": None if hop.share is None else float(hop.share),
        "source": hop.source,
        "reason": hop.reason,
        "remedy": hop.remedy,
        "parts": list(map(part_json, hop.parts)),
    }
