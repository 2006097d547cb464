"""The messages on the CAN bus."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros.report.html.blocks import Section, table
from amalthea_uros.report.load_text import load_text
from amalthea_uros.services.report import ReportContent
from amalthea_uros.units import Rounding, time_text


def section(content: ReportContent) -> Section | None:
    """What an `app.yaml` sends and receives."""
    if content.assembly is None or not content.assembly.messages:
        return None
    rows = [
        (
            each.message.topic,
            "received" if each.incoming else "sent",
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
