"""What the script of a page, `templates/report/zoom.js`, needs to zoom into the times of a picture.

Without the script, the picture looks the same.
"""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.report.pictures.svg import Markup, element, joined, number
from amalthea_uros.report.pictures.time_axis import TimeAxis, draw_time_axis

_CLIP = "amuros-plot"
#: Pixels around the plot in which lines and numbers at its ends are seen.
_EDGE = 6


def zoom_attributes(axis: TimeAxis, bottom: float) -> dict[str, str]:
    """The attributes of a picture: left and right end of the axis in pixels, start and end in picoseconds, and where the axis is."""
    ends = f"{number(axis.left)} {number(axis.right)} {axis.start} {axis.end}"
    return {"data_zoom": ends, "data_axis": number(bottom)}


def drawn_times(axis: TimeAxis, bottom: float, parts: Iterable[Markup]) -> tuple[Markup, ...]:
    """What is at its time, clipped to the axis, and the axis."""
    clip = element("rect", x=axis.left - _EDGE, y=0, width=axis.width + 2 * _EDGE, height=bottom + 2)
    return (
        element("clipPath", clip, id=_CLIP),
        element("g", joined(parts), data_plot="", clip_path=f"url(#{_CLIP})"),
        element("g", draw_time_axis(axis, bottom, "time"), data_axis=""),
    )
