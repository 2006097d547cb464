"""The static pools of the micro-ROS middleware, and the build options that set them."""

from __future__ import annotations

from amalthea_uros.report.html.blocks import Badge, Listing, Section, Tone, table
from amalthea_uros.services.report import ReportContent
from amalthea_uros.uros.colcon_meta import colcon_meta
from amalthea_uros.uros.pools import Pool


def section(content: ReportContent) -> Section | None:
    """The pools that the application needs, and a `colcon.meta` of the right sizes."""
    pools = [pool for pool in content.assembly.pools if pool.needed] if content.assembly is not None else []
    if not pools:
        return None
    rows = [(each.option, f"{each.needed}", f"{each.available}", _origin(each), _verdict(each)) for each in pools]
    sizes = table("Pools of rmw_microxrcedds", ("option", ">needed", ">available", "set by", "verdict"), rows)
    lead = "The middleware takes its objects from pools of fixed size; this file sets those that the application needs in the build."
    return Section("pools", "Static pools", lead, [sizes, Listing("colcon.meta", colcon_meta(pools).splitlines())])


def _origin(pool: Pool) -> str:
    return "app.yaml" if pool.configured else "default"


def _verdict(pool: Pool) -> Badge:
    return Badge("too small", Tone.BAD) if pool.is_exceeded else Badge("sufficient", Tone.GOOD)
