"""The tables of docs/boards.md are computed from the files of the boards and operating systems."""

from pathlib import Path

from support import ROOT

from amalthea_uros._internal.resources import MEASURED, RTOSES, known_measured, known_platforms, known_rtoses
from amalthea_uros.spec.application import Application, NodeSection
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.executors import LoopSection
from amalthea_uros.spec.hardware import HardwareSection
from amalthea_uros.spec.measured import MeasuredProfile
from amalthea_uros.spec.platforms import Rtos, complete
from amalthea_uros.spec.read import read_section
from amalthea_uros.spec.transports import TransportSection
from amalthea_uros.units import data_size_text, frequency_text, time_text

PAGE = ROOT / "docs" / "boards.md"
LIMITS = ("NODES", "PUBLISHERS", "SUBSCRIPTIONS", "SERVICES", "CLIENTS")


def test_the_table_of_boards():
    assert rows_of("board") == [board(name) for name in known_platforms()]


def test_the_table_of_operating_systems():
    assert rows_of("system") == [system(name) for name in known_rtoses()]


def test_the_table_of_profiles():
    assert rows_of("profile") == [profile(name) for name in known_measured()]


def rows_of(heading):
    """The rows of the table whose first column has a heading."""
    lines = PAGE.read_text().partition(f"| {heading} |")[2].splitlines()[2:]
    rows = []
    for line in lines:
        if not line.startswith("|"):
            break
        rows.append(line)
    return rows


def row(*cells):
    return f"| {' | '.join(cell or '-' for cell in cells)} |"


def board(name):
    application = Application(nodes=[NodeSection(name="n")])
    description = Description(amuros=1, name="a", hardware=HardwareSection(platform=name), application=application)
    whole = complete(description, Path()).description
    hardware, os, middleware = whole.hardware, whole.os, whole.middleware
    memories = [memory for memory in hardware.memories or () if memory.kind == "SRAM"]
    limits, loop = middleware.limits, middleware.executor.loop
    return row(
        f"`{name}`",
        f"{len(hardware.cores)} x {hardware.core_type}, {frequency_text(hardware.frequency)}",
        data_size_text(sum(memory.size for memory in memories)) if memories else "",
        os.rtos,
        time_text(os.tick) if os.tick else "",
        looping(loop) if loop else "",
        next((key for key in TransportSection.model_fields if middleware.transport.states(key)), ""),
        "/".join(str(getattr(limits, f"RMW_UXRCE_MAX_{key}")) for key in LIMITS)
        if limits.states("RMW_UXRCE_MAX_NODES")
        else "",
    )


def looping(loop):
    return ", ".join(f"{key} {time_text(getattr(loop, key))}" for key in LoopSection.model_fields if loop.states(key))


def system(name):
    rtos = read_section(RTOSES / f"{name}.yaml", Rtos)
    os = rtos.os
    ticks = os.sleep_ticks
    return row(
        f"`{name}`",
        rtos.title,
        (os.priorities or "").partition("-")[0],
        f"{os.priority_range.lowest} to {os.priority_range.highest}" if os.priority_range else "",
        time_text(os.tick) if os.tick else "",
        "" if os.time_slice is None else f"take turns after {time_text(os.time_slice)}" if os.time_slice else "in order",
        f"{ago(-ticks.early)} to {ago(ticks.late)}" if ticks else "as asked" if os.tick is None else "",
        os.stack,
    )


def profile(name):
    found = read_section(MEASURED / f"{name}.yaml", MeasuredProfile)
    wire = next(key for key in TransportSection.model_fields if found.transport.states(key))
    times = [between(each) for each in (found.agent.to_controller, found.agent.to_host)]
    return row(f"`{name}`", found.title, found.basis, *times, wire)


def between(time):
    return f"mean {time_text(time.mean)}" if time.max is None else f"{time_text(time.min)} to {time_text(time.max)}"


def ago(ticks):
    return "n" if ticks == 0 else f"n {'+' if ticks > 0 else '-'} {abs(ticks)}"
