"""The static pools of the micro-ROS middleware, the build options that set them, and the memory that micro-ROS takes."""

from __future__ import annotations

from amalthea_uros.report.html.blocks import Badge, Listing, Section, Tone, table
from amalthea_uros.report.memory_text import memory_rows
from amalthea_uros.services.generate import texts_of
from amalthea_uros.services.report import ReportContent
from amalthea_uros.uros.middleware.options import Option


def section(content: ReportContent) -> Section | None:
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
