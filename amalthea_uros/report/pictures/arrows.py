"""Arrows of activations and deadlines, as in the literature: an activation points up, a deadline points down."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from amalthea_uros.report.pictures.page import WIDTH
from amalthea_uros.report.pictures.style import SMALL_SIZE
from amalthea_uros.report.pictures.svg import Markup, element, joined, number, text
from amalthea_uros.report.pictures.text_widths import text_width
from amalthea_uros.report.pictures.time_axis import TimeAxis
from amalthea_uros.units import Time

#: Arrows that are nearer to each other, in pixels, are drawn as one.
NEAR = 3.0
_HEAD, _HALF = 6.5, 3.2


@dataclass(frozen=True, slots=True)
class Arrows:
    """Points in time of one kind in the window, in pixels, with how many there are at each.

    Attributes
    ----------
    are_merged : different points in time are drawn as one arrow
    """

    places: tuple[tuple[float, int], ...]
    are_merged: bool = False


def arrows_at(times: Iterable[Time | None], axis: TimeAxis) -> Arrows:
    """The arrows of those that are known and in the window."""
    places: list[tuple[float, int]] = []
    are_merged, last = False, None
    for time in sorted(time for time in times if time is not None and axis.has(time)):
        x = axis.x(time)
        if places and x - places[-1][0] < NEAR:
            places[-1] = places[-1][0], places[-1][1] + 1
            are_merged = are_merged or time != last
        else:
            places.append((x, 1))
        last = time
    return Arrows(tuple(places), are_merged)


def draw_instants(kinds: Iterable[Arrows], top: float, bottom: float) -> Markup:
    """Fine lines that lead arrows to the base line, if there are few enough to follow them."""
    places = [x for arrows in kinds if not arrows.are_merged for x, _ in arrows.places]
    path = "".join(f"M{number(x)} {number(top)}V{number(bottom)}" for x in places)
    return element("path", class_="instant", d=path) if path else Markup("")


def draw_activations(arrows: Arrows, top: float, bottom: float) -> Markup:
    """Arrows up from `bottom` to `top`; where several meet, their number if it has room."""
    if not arrows.places:
        return Markup("")
    stems = "".join(f"M{number(x)} {number(bottom)}V{number(top + _HEAD)}" for x, _ in arrows.places)
    heads = "".join(f"M{number(x)} {number(top)}l{_HALF} {_HEAD}h{-2 * _HALF}z" for x, _ in arrows.places)
    return joined((element("path", class_="mark", d=stems), element("path", class_="head", d=heads), _counts(arrows, top)))


def draw_deadlines(arrows: Arrows, top: float, bottom: float, *, are_missed: bool) -> Markup:
    """Arrows down from `top` to `bottom`, with empty heads if they are kept."""
    if not arrows.places:
        return Markup("")
    stems = "".join(f"M{number(x)} {number(top)}V{number(bottom - _HEAD)}" for x, _ in arrows.places)
    heads = "".join(f"M{number(x)} {number(bottom)}l{-_HALF} {-_HEAD}h{2 * _HALF}z" for x, _ in arrows.places)
    line, head = ("alert", "late") if are_missed else ("mark", "mark paper")
    return joined((element("path", class_=line, d=stems), element("path", class_=head, d=heads)))


def draw_lost(arrows: Arrows, top: float, bottom: float) -> Markup:
    """Crossed stems, for activations that have no job."""
    if not arrows.places:
        return Markup("")
    marks = "".join(
        f"M{number(x)} {number(bottom)}V{number(top + 4)}M{number(x - 4)} {number(top)}l8 8m0 -8l-8 8" for x, _ in arrows.places
    )
    return element("path", class_="alert", d=marks)


def _counts(arrows: Arrows, top: float) -> Markup:
    """The numbers at arrows that show several instants; none where some are merged for lack of room."""
    if arrows.are_merged:
        return Markup("")
    ends = [*(x for x, _ in arrows.places[1:]), WIDTH]
    parts = []
    for (x, count), following in zip(arrows.places, ends, strict=True):
        label = f"\N{MULTIPLICATION SIGN}{count}"
        if count > 1 and x + _HALF + 2 + text_width(label, SMALL_SIZE) < following - _HALF:
            parts.append(element("text", text(label), class_="small halo", x=x + _HALF + 2, y=top + 7))
    return joined(parts)
