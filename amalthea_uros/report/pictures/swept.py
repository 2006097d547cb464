"""A quantity over one or two swept values: as a line, or as a map of cells."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.report.pictures.axes import multiples, nice_step, unit_of
from amalthea_uros.report.pictures.svg import (
    MARGIN,
    PALETTE,
    SMALL_SIZE,
    TOP,
    UNKNOWN,
    WIDTH,
    LegendEntry,
    Markup,
    document,
    draw_legend,
    draw_verdict,
    element,
    elided,
    joined,
    number,
    text,
    text_width,
    tooltip,
    verdict_entries,
)
from amalthea_uros.units import number_text, time_text

#: Pixels.
_PLOT, _GAP, _ROW, _NARROWEST, _LABELS = 260, 10, 34, 34, 60
_PARTS = 6
#: Numbers that are no times are drawn in parts of a millionth.
_MILLION = 10**6
#: Above so many cells in a row, the numbers in them could not be read.
_MOST_COLUMNS, _MOST_ROWS = 26, 40
#: The lightest and the darkest cell differ that much in opacity.
_PALE, _DARK = 0.12, 0.75


#: The pixel of a value.
_Height: TypeAlias = Callable[[Fraction], float]


@dataclass(frozen=True, slots=True, kw_only=True)
class SweptPicture:
    """What is drawn.

    Attributes
    ----------
    quantity : such as "factor-to-output.max_reduced_reaction_time"
    is_time : whether the values are picoseconds
    targets : of one or two sweeps
    axes : the values of each of them, as text
    values : by the texts of the values; None: not known
    verdicts : of the variants
    """

    quantity: str
    is_time: bool
    targets: tuple[str, ...]
    axes: tuple[tuple[str, ...], ...]
    values: Mapping[tuple[str, ...], Fraction | None]
    verdicts: Mapping[tuple[str, ...], Verdict]

    def label(self, value: Fraction) -> str:
        """A value with its unit."""
        return time_text(value) if self.is_time else number_text(value)


def draw_swept(picture: SweptPicture) -> str:
    """The picture as SVG.

    Raises
    ------
    InvalidArgumentError : more than two values are swept, or there are too many cells.
    """
    if not 1 <= len(picture.targets) <= 2:
        raise InvalidArgumentError(f"a picture shows one or two swept values, not {len(picture.targets)}; use --table")
    return _line(picture) if len(picture.targets) == 1 else _map(picture)


# One swept value


def _line(picture: SweptPicture) -> Markup:
    """Points that are evenly spaced, whatever their values; unknown ones leave a gap."""
    keys = [(value,) for value in picture.axes[0]]
    known = [value for key in keys if (value := picture.values.get(key)) is not None]
    scale = 1 if picture.is_time else _MILLION
    highest = max((int(value * scale) for value in known), default=1) or 1
    step = nice_step(highest, _PARTS)
    ticks = multiples(step, 0, -(-highest // step) * step)
    unit, size = unit_of(ticks[-1]) if picture.is_time else ("", _MILLION)
    labels = [number_text(Fraction(tick, size)) for tick in ticks]
    left = MARGIN + SMALL_SIZE + 2 * _GAP + max(text_width(label, SMALL_SIZE) for label in labels)
    right, bottom = WIDTH - 2 * MARGIN, TOP + _PLOT

    def y(value: Fraction) -> float:
        return bottom - float(value * scale / ticks[-1]) * _PLOT

    xs = _places(len(keys), left, right)
    grid = [
        joined(
            (
                element("path", class_="grid", d=f"M{number(left)} {number(y(Fraction(tick, scale)))}H{number(right)}"),
                element(
                    "text",
                    text(label),
                    class_="small",
                    x=left - 8,
                    y=y(Fraction(tick, scale)) + 4,
                    text_anchor="end",
                ),
            )
        )
        for tick, label in zip(ticks, labels, strict=True)
    ]
    turned = f"translate({MARGIN + SMALL_SIZE} {number((TOP + bottom) / 2)}) rotate(-90)"
    legend, height = _legend(picture, bottom + 4 * SMALL_SIZE + _GAP)
    body = (
        *grid,
        element("text", text(unit and f"in {unit}"), class_="small muted", transform=turned, text_anchor="middle"),
        element("path", class_="t0 steps", d=_way(picture, keys, xs, y)),
        *(_point(picture, key, x, y, bottom) for key, x in zip(keys, xs, strict=True)),
        _labels(picture.axes[0], xs, bottom),
        _caption(picture.targets[0], (left + right) / 2, bottom + 3 * SMALL_SIZE),
        legend,
    )
    return document(picture.quantity, f"for {len(keys)} values of {picture.targets[0]}", body, height + MARGIN)


def _places(count: int, left: float, right: float) -> list[float]:
    width = (right - left) / count
    return [left + (index + 0.5) * width for index in range(count)]


def _way(picture: SweptPicture, keys: Sequence[tuple[str, ...]], xs: Sequence[float], y: _Height) -> str:
    parts, pen = [], "M"
    for key, x in zip(keys, xs, strict=True):
        value = picture.values.get(key)
        if value is None:
            pen = "M"
            continue
        parts.append(f"{pen}{number(x)} {number(y(value))}")
        pen = "L"
    return "".join(parts)


def _point(picture: SweptPicture, key: tuple[str, ...], x: float, y: _Height, bottom: float) -> Markup:
    value = picture.values.get(key)
    verdict = picture.verdicts.get(key)
    height = bottom - _GAP if value is None else y(value)
    dot = element("circle", class_="c0", cx=x, cy=height, r=3.5) if value is not None else Markup("")
    return element("g", tooltip(_told(picture, key)), dot, draw_verdict(verdict, x, max(height - 12, TOP - 8)))


def _labels(texts: Sequence[str], xs: Sequence[float], bottom: float) -> Markup:
    """As many of the values as have room."""
    widest = max(text_width(each, SMALL_SIZE) for each in texts) + _GAP
    every = 1 if len(xs) < 2 else int(widest // (xs[1] - xs[0])) + 1
    return joined(
        element("text", text(each), class_="small", x=x, y=bottom + 16, text_anchor="middle")
        for index, (each, x) in enumerate(zip(texts, xs, strict=True))
        if index % every == 0
    )


def _caption(content: str, x: float, y: float) -> Markup:
    return element("text", text(content), class_="small muted", x=x, y=y, text_anchor="middle")


# Two swept values


def _map(picture: SweptPicture) -> Markup:
    """The first value downwards, the second one across; the darker a cell, the greater the quantity."""
    rows, columns = picture.axes
    if len(rows) > _MOST_ROWS or len(columns) > _MOST_COLUMNS:
        limit = f"{_MOST_ROWS} by {_MOST_COLUMNS}"
        raise InvalidArgumentError(
            f"a map has at most {limit} cells, not {len(rows)} by {len(columns)}; use --table, or larger steps"
        )
    left = MARGIN + SMALL_SIZE + 2 * _GAP + min(max(text_width(each, SMALL_SIZE) for each in rows), _LABELS * 2)
    width = min((WIDTH - MARGIN - left) / len(columns), 4 * _NARROWEST)
    bottom = TOP + _ROW * len(rows)
    right = left + width * len(columns)
    turned = f"translate({MARGIN + SMALL_SIZE} {number((TOP + bottom) / 2)}) rotate(-90)"
    shown = elided(picture.targets[0], SMALL_SIZE, max(bottom - TOP, 2 * _LABELS))
    names = joined(
        element("text", text(each), class_="small", x=left - 8, y=TOP + _ROW * (index + 0.5) + 4, text_anchor="end")
        for index, each in enumerate(rows)
    )
    legend, height = _legend(picture, bottom + 4 * SMALL_SIZE + _GAP)
    known = [value for value in picture.values.values() if value is not None]
    ends = (min(known), max(known)) if known else (Fraction(0), Fraction(1))
    cells = (
        _cell(picture, (row, column), ends, left + width * across, TOP + _ROW * down, width)
        for down, row in enumerate(rows)
        for across, column in enumerate(columns)
    )
    body = (
        element("text", text(shown), class_="small muted", transform=turned, text_anchor="middle"),
        names,
        *cells,
        _labels(columns, _places(len(columns), left, right), bottom),
        _caption(picture.targets[1], (left + right) / 2, bottom + 3 * SMALL_SIZE),
        legend,
    )
    subtitle = f"for {len(rows)} values of {picture.targets[0]} and {len(columns)} of {picture.targets[1]}"
    return document(picture.quantity, subtitle, body, height + MARGIN)


def _cell(
    picture: SweptPicture, key: tuple[str, ...], ends: tuple[Fraction, Fraction], x: float, y: float, width: float
) -> Markup:
    tip = tooltip(_told(picture, key))
    if key not in picture.values:
        return element("g", tip, element("rect", class_="frame", x=x, y=y, width=width - 1, height=_ROW - 1))
    value = picture.values[key]
    low, high = ends
    if value is None:
        box = element("rect", x=x, y=y, width=width - 1, height=_ROW - 1, fill=UNKNOWN)
    else:
        share = float((value - low) / (high - low)) if high > low else 0.0
        opacity = _PALE + share * (_DARK - _PALE)
        box = element("rect", x=x, y=y, width=width - 1, height=_ROW - 1, fill=PALETTE[3][0], fill_opacity=round(opacity, 3))
    shown = "" if value is None else elided(picture.label(value), SMALL_SIZE, width - 4)
    label = element("text", text(shown), class_="small", x=x + width / 2, y=y + _ROW - 7, text_anchor="middle")
    return element("g", tip, box, label, draw_verdict(picture.verdicts.get(key), x + width / 2, y + 11))


# Both


def _told(picture: SweptPicture, key: tuple[str, ...]) -> str:
    where = ", ".join(f"{target} {value}" for target, value in zip(picture.targets, key, strict=True))
    if key not in picture.values:
        return f"{where}: not tried"
    value = picture.values[key]
    return f"{where}: {'unknown' if value is None else picture.label(value)}"


def _legend(picture: SweptPicture, y: float) -> tuple[Markup, float]:
    entries = verdict_entries(set(picture.verdicts.values()))
    notes = ["The marks say whether everything is met for certain with these values."] if entries else []
    if any(value is None for value in picture.values.values()):
        entries.append(LegendEntry(element("rect", x=-9, y=-6, width=18, height=12, fill=UNKNOWN), "no value"))
    return draw_legend(entries, notes, y)
