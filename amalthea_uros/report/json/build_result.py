"""A built model with the decisions of its assembly, for programs."""

from __future__ import annotations

from typing import Any

from amalthea_uros.perf.executors import Executor
from amalthea_uros.report.findings import finding_json
from amalthea_uros.services.build import BuildResult


def content(result: BuildResult) -> dict[str, Any]:
    """The model, the choices, the executors with loops, the messages, and the start and the pools of the middleware."""
    assembly = result.assembly
    start = assembly.initialisation
    return {
        "model": str(result.document.path or "unsaved"),
        "description": str(result.description),
        "amalthea": result.document.version,
        "choices": [{"task": c.task, "period_ps": c.period, "reason": c.reason} for c in assembly.choices],
        "placement": assembly.placement,
        "executors": [_executor(executor) for executor in assembly.system.executors],
        "messages": [
            {
                "topic": item.message.topic,
                "incoming": item.incoming,
                "interval_ps": item.message.interval,
                "bytes": item.length,
                "frames": item.frames,
                "bus_time_ps": item.transmission_time,
            }
            for item in assembly.messages
        ],
        "initialisation": start
        and {
            "entities": [{"kind": entity.kind, "name": entity.name} for entity in start.entities],
            "least_cycles": start.min_cycles,
            "most_cycles": start.max_cycles,
            "least_time_ps": start.min_time,
            "most_time_ps": start.max_time,
        },
        "pools": [
            {"option": p.option, "needed": p.needed, "available": p.available, "stated": p.configured} for p in assembly.pools
        ],
        "findings": [finding_json(finding) for finding in result.findings],
    }


def _executor(executor: Executor) -> dict[str, Any]:
    loop = executor.loop
    return {
        "executor": executor.name,
        "loop": loop.kind,
        "timeout_ps": loop.timeout,
        "sleep_ps": loop.sleep,
        "period_ps": loop.period,
        "trigger": executor.trigger.kind,
        "takes_first": executor.takes_first,
        "handles": [
            {"handle": h.name, "kind": h.kind, "interval_ps": h.interval, "runnable": h.runnable, "depth": h.depth}
            for h in executor.handles
        ],
    }
