"""The fields of what descriptions become: models, and files for the build of the firmware."""

from __future__ import annotations

from typing import Any

from amalthea_uros.perf.executors import Executor
from amalthea_uros.report.fields.declaration import declare
from amalthea_uros.services.build import BuildResult
from amalthea_uros.services.generate import GenerateResult, MetaCheck
from amalthea_uros.uros.assemble import Assembly
from amalthea_uros.uros.creation_traffic import CreationTraffic, SentForCreation
from amalthea_uros.uros.generated_options import values_of
from amalthea_uros.uros.initialisation import Initialisation
from amalthea_uros.uros.memory import MemoryDemand


def _messages(assembly: Assembly) -> list[dict[str, Any]]:
    return [
        {
            "topic": item.message.topic,
            "incoming": item.message.is_incoming,
            "interval_ps": item.message.interval,
            "bytes": item.length,
            "frames": item.frames,
            "bus_time_ps": item.transmission_time,
        }
        for item in assembly.messages
    ]


def _pools(assembly: Assembly) -> list[dict[str, Any]]:
    return [
        {"option": pool.name, "needed": pool.needed, "available": pool.available, "stated": pool.is_stated}
        for pool in assembly.pools
    ]


def _of_controller(assembly: Assembly) -> dict[str, Any]:
    """The middleware of a controller of a robot."""
    return {
        "messages": _messages(assembly),
        "initialisation": assembly.initialisation,
        "pools": _pools(assembly),
        "memory": assembly.memory,
    }


def _options(result: GenerateResult) -> list[dict[str, Any]]:
    return [
        {
            "option": option.name,
            "package": option.package,
            "generated": option.text(value),
            "described": option.text(option.available),
            "needed": option.needed,
            "unit": option.unit,
            "counts": option.counts,
        }
        for option, value in values_of(result.assembly.options)
    ]


declare(
    BuildResult,
    ("model", lambda result: str(result.document.path or "unsaved")),
    ("description", lambda result: str(result.description)),
    ("amalthea", "document.version"),
    (
        "choices",
        lambda result: [{"task": c.task, "period_ps": c.period, "reason": c.reason} for c in result.assembly.choices],
    ),
    ("placement", "assembly.placement"),
    ("executors", "assembly.system.executors"),
    ("messages", lambda result: _messages(result.assembly)),
    ("initialisation", "assembly.initialisation"),
    ("pools", lambda result: _pools(result.assembly)),
    ("memory", lambda result: None if result.assembly.controllers else result.assembly.memory),
    ("controllers", lambda result: {name: _of_controller(each) for name, each in result.assembly.controllers.items()}),
    "findings",
)
declare(
    Initialisation,
    ("entities", lambda start: [{"kind": entity.kind, "name": entity.name} for entity in start.entities]),
    ("least_cycles", "min_cycles"),
    ("most_cycles", "max_cycles"),
    ("least_time_ps", "min_time"),
    ("most_time_ps", "max_time"),
    "reason",
    ("limit_ps", "limit"),
    "traffic",
    ("most_load", lambda start: None if start.most_load is None else float(start.most_load)),
)
declare(
    CreationTraffic,
    "to_agent",
    "to_controller",
    ("least_wire_time_ps", "least_wire_time"),
    ("most_wire_time_ps", "most_wire_time"),
    "reason",
)
declare(SentForCreation, "messages", "least_bytes", "most_bytes", "acknowledgements")
declare(
    Executor,
    ("executor", "name"),
    ("loop", "loop.kind"),
    ("timeout_ps", "loop.timeout"),
    ("sleep_ps", "loop.sleep"),
    ("period_ps", "loop.period"),
    ("trigger", "trigger.kind"),
    "takes_first",
    (
        "handles",
        lambda executor: [
            {"handle": h.name, "kind": h.kind, "interval_ps": h.interval, "runnable": h.runnable, "depth": h.depth}
            for h in executor.handles
        ],
    ),
)
declare(
    MemoryDemand,
    ("parts", lambda memory: [{"name": use.name, "bytes": use.size, "formula": use.formula} for use in memory.uses]),
    (
        "stacks",
        lambda memory: {
            "shared": memory.stacks.shared,
            "bytes": memory.stacks.size,
            "of": [{"process": user.name, "bytes": user.size} for user in memory.stacks.users],
            "unknown": memory.stacks.unknown,
        },
    ),
    ("total_bytes", "total"),
    "is_complete",
    ("ram_bytes", "ram"),
    ("budget_bytes", "budget"),
)
declare(
    GenerateResult,
    ("description", lambda result: str(result.description)),
    ("folder", "folder"),
    ("files", lambda result: [{"name": name, "text": text} for name, text in result.texts.items()]),
    ("options", _options),
    *("memory", "findings"),
)
declare(MetaCheck, "description", ("checked", "path"), *("is_fine", "findings"))
