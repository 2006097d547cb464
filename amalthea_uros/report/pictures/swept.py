"""A quantity over one or two swept values: as a line, or as a map of cells."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.report.pictures.axes import multiples, nice_step, unit_of
from amalthea_uros.report.pictures.page import (
    MARGIN,
    PALETTE,
    TOP,
    WIDTH,
    draw_verdict,
    levels,
    picture_of,
    turned,
    unknown,
    verdict_entries,
)
from amalthea_uros.report.pictures.svg import SMALL_SIZE, Markup, element, number, path_of, rect_at, text_at, text_width, tipped
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
    body = (
        *levels(((y(Fraction(tick, scale)), label) for tick, label in zip(ticks, labels, strict=True)), left, right),
        turned(unit and f"in {unit}", TOP, bottom),
        path_of("t0 steps", _way(picture, keys, xs, y)),
        *(_point(picture, key, x, y, bottom) for key, x in zip(keys, xs, strict=True)),
        *_labels(picture.axes[0], xs, bottom, picture.targets[0], (left + right) / 2),
    )
    return _drawn(picture, f"for {len(keys)} values of {picture.targets[0]}", body, bottom)


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
    return tipped(_description(picture, key), dot, draw_verdict(verdict, x, max(height - 12, TOP - 8)))


def _labels(texts: Sequence[str], xs: Sequence[float], bottom: float, target: str, middle: float) -> Iterator[Markup]:
    """As many of the values as have room, and what they are."""
    widest = max(text_width(each, SMALL_SIZE) for each in texts) + _GAP
    every = 1 if len(xs) < 2 else int(widest // (xs[1] - xs[0])) + 1
    for each, x in list(zip(texts, xs, strict=True))[::every]:
        yield text_at(each, x, bottom + 16, "small", anchor="middle")
    yield text_at(target, middle, bottom + 3 * SMALL_SIZE, "small muted", anchor="middle")


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
    known = [value for value in picture.values.values() if value is not None]
    ends = (min(known), max(known)) if known else (Fraction(0), Fraction(1))
    cells = (
        _cell(picture, (row, column), ends, left + width * across, TOP + _ROW * down, width)
        for down, row in enumerate(rows)
        for across, column in enumerate(columns)
    )
    body = (
        turned(picture.targets[0], TOP, bottom, max(bottom - TOP, 2 * _LABELS)),
        *(text_at(each, left - 8, TOP + _ROW * (index + 0.5) + 4, "small", anchor="end") for index, each in enumerate(rows)),
        *cells,
        *_labels(columns, _places(len(columns), left, right), bottom, picture.targets[1], (left + right) / 2),
    )
    subtitle = f"for {len(rows)} values of {picture.targets[0]} and {len(columns)} of {picture.targets[1]}"
    return _drawn(picture, subtitle, body, bottom)


def _cell(
    picture: SweptPicture, key: tuple[str, ...], ends: tuple[Fraction, Fraction], x: float, y: float, width: float
) -> Markup:
    tip = _description(picture, key)
    if key not in picture.values:
        return tipped(tip, rect_at("frame", x, y, width - 1, _ROW - 1))
    value = picture.values[key]
    low, high = ends
    if value is None:
        box = unknown(x, y, width - 1, _ROW - 1)
    else:
        share = float((value - low) / (high - low)) if high > low else 0.0
        opacity = _PALE + share * (_DARK - _PALE)
        box = element("rect", x=x, y=y, width=width - 1, height=_ROW - 1, fill=PALETTE[3][0], fill_opacity=round(opacity, 3))
    shown = "" if value is None else picture.label(value)
    label = text_at(shown, x + width / 2, y + _ROW - 7, "small", anchor="middle", room=width - 4)
    return tipped(tip, box, label, draw_verdict(picture.verdicts.get(key), x + width / 2, y + 11))


# Both


def _description(picture: SweptPicture, key: tuple[str, ...]) -> str:
    where = ", ".join(f"{target} {value}" for target, value in zip(picture.targets, key, strict=True))
    if key not in picture.values:
        return f"{where}: not tried"
    value = picture.values[key]
    return f"{where}: {'unknown' if value is None else picture.label(value)}"


def _drawn(picture: SweptPicture, subtitle: str, body: Iterable[Markup], bottom: float) -> Markup:
    notes = ["The marks say whether everything is met for certain with these values."] if picture.verdicts else []
    is_unknown = any(value is None for value in picture.values.values())
    entries = [*verdict_entries(set(picture.verdicts.values())), (is_unknown, unknown(-9, -6, 18, 12), "no value")]
    return picture_of(picture.quantity, subtitle, body, bottom + 4 * SMALL_SIZE + _GAP, entries, notes)
