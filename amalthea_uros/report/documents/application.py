"""What an `app.yaml` asks of its bus and of its middleware: messages, pools and memory."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros.report.basics.document import (
    Badge,
    Listing,
    Section,
    Tone,
    table,
)
from amalthea_uros.report.memory_text import memory_rows
from amalthea_uros.report.wording.cells import load_text
from amalthea_uros.services.generate import texts_of
from amalthea_uros.services.report import ReportContent
from amalthea_uros.units import Rounding, time_text
from amalthea_uros.uros.middleware.options import Option


def bus_section(content: ReportContent) -> Section | None:
    """What an `app.yaml` sends and receives."""
    if content.assembly is None or not content.assembly.messages:
        return None
    rows = [
        (
            each.message.topic,
            "received" if each.message.is_incoming else "sent",
            time_text(each.message.interval),
            f"{each.length} B",
            f"{each.frames}",
            "common" if each.identifier is None else f"0x{each.identifier:X}",
            time_text(each.transmission_time),
            load_text(each.bus_load, Rounding.UP),
        )
        for each in content.assembly.messages
    ]
    titles = ("topic", "direction", ">interval", ">with headers", ">frames", ">identifier", ">transmission", ">bus load")
    total = load_text(sum((each.bus_load for each in content.assembly.messages), Fraction(0)), Rounding.UP)
    lead = f"Each message with its headers and maximum bit stuffing; together they need at most {total} of the bus."
    return Section("messages", "Messages on the CAN bus", lead, [table("Messages of the application", titles, rows)])


def pools_section(content: ReportContent) -> Section | None:
    """The pools that the application needs, the files for a build with the right sizes, and the memory."""
    assembly = content.assembly
    if assembly is None or not assembly.description.application.nodes:
        return None
    rows = [
        (each.name, f"{each.needed}", f"{each.available}", _origin(each), _verdict(each))
        for each in assembly.pools
        if each.needed
    ]
    sizes = table("Pools of the middleware", ("option", ">needed", ">available", "set by", "verdict"), rows)
    memory = table("Memory", ("part", ">size", "how it is computed"), memory_rows(assembly.memory))
    lead = "The middleware takes its objects from pools of fixed size; these files set those that the application needs in the build."
    files = [Listing(name, text.splitlines()) for name, text in texts_of(assembly).items() if not name.endswith(".h")]
    return Section("pools", "Static pools", lead, [sizes, memory, *files])


def _origin(option: Option) -> str:
    return "app.yaml" if option.is_stated else "default"


def _verdict(option: Option) -> Badge:
    return Badge("too small", Tone.BAD) if option.is_exceeded else Badge("sufficient", Tone.GOOD)
