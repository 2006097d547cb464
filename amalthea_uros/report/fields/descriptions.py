"""The fields of what descriptions become: models, and files for the build of the firmware."""

from __future__ import annotations

from typing import Any

from amalthea_uros.perf.executors import Executor
from amalthea_uros.report.fields.declaration import ALSO, Field, declare, group, list_of, record
from amalthea_uros.services.build import BuildResult
from amalthea_uros.services.generate import GenerateResult, MetaCheck
from amalthea_uros.uros.creation_traffic import CreationTraffic, SentForCreation
from amalthea_uros.uros.generated_options import values_of
from amalthea_uros.uros.initialisation import Initialisation
from amalthea_uros.uros.memory import MemoryDemand

#: The middleware of a controller.
_MIDDLEWARE: tuple[Field, ...] = (
    (
        "messages",
        list_of(
            "messages",
            *(("topic", "message.topic"), ("incoming", "message.is_incoming"), ("interval_ps", "message.interval")),
            *(("bytes", "length"), "frames", ("bus_time_ps", "transmission_time")),
        ),
    ),
    "initialisation",
    ("pools", list_of("pools", ("option", "name"), "needed", "available", ("stated", "is_stated"))),
)


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
    ("choices", list_of("assembly.choices", "task", "period_ps", "reason")),
    ("placement", "assembly.placement"),
    ("executors", "assembly.system.executors"),
    (ALSO, lambda result: record(result.assembly, _MIDDLEWARE)),
    ("memory", lambda result: None if result.assembly.controllers else result.assembly.memory),
    (
        "controllers",
        lambda result: {
            name: record(controller, (*_MIDDLEWARE, "memory")) for name, controller in result.assembly.controllers.items()
        },
    ),
    "findings",
)
declare(
    Initialisation,
    ("entities", list_of("entities", "kind", "name")),
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
    ("handles", list_of("handles", ("handle", "name"), "kind", "interval_ps", "runnable", "depth")),
)
declare(
    MemoryDemand,
    ("parts", list_of("uses", "name", ("bytes", "size"), "formula")),
    (
        "stacks",
        group(
            *(("shared", "stacks.shared"), ("bytes", "stacks.size")),
            ("of", list_of("stacks.users", ("process", "name"), ("bytes", "size"))),
            ("unknown", "stacks.unknown"),
        ),
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
