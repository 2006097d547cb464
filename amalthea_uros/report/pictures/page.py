"""What all pictures have in common: style, title, legend, marks of verdicts, and several of them in one page."""

from __future__ import annotations

import re
from collections.abc import Container, Iterable, Iterator, Sequence
from typing import TypeAlias

from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.report.pictures.jobs import State
from amalthea_uros.report.pictures.svg import (
    SMALL_SIZE,
    TEXT_SIZE,
    TITLE_SIZE,
    Markup,
    element,
    elided,
    horizontal,
    joined,
    number,
    path_of,
    rect_at,
    text,
    text_at,
    text_width,
    tooltip,
    vertical,
)

#: Fill, outline, and text on the fill. The colours can be told apart with all kinds of colour vision: M. Okabe and K. Ito, "Color
#: universal design", 2008. Their vermilion is kept for missed deadlines and limits, their black is that of the text.
PALETTE = (
    ("#0072b2", "#0072b2", "#fff"),
    ("#e69f00", "#d18f00", "#111"),
    ("#009e73", "#009e73", "#111"),
    ("#56b4e9", "#3aa2de", "#111"),
    ("#cc79a7", "#cc79a7", "#111"),
    ("#f0e442", "#c9bc00", "#111"),
)
_ALERT = "#d55e00"

#: Outlines tell the process of a box that is too narrow for its filling.
_TASKS = "\n".join(
    f".amuros-picture .c{number}{{fill:{fill};stroke:{outline}}}\n.amuros-picture .t{number}{{stroke:{outline}}}\n"
    f".amuros-picture text.on{number}{{fill:{on_fill}}}"
    for number, (fill, outline, on_fill) in enumerate(PALETTE)
)
_FONTS = 'system-ui,-apple-system,"Segoe UI",Roboto,Arial,sans-serif'
_SHEET = f"""
.amuros-picture{{color:#1f2328;max-width:100%;height:auto;font:{TEXT_SIZE}px {_FONTS}}}
.amuros-picture text{{fill:currentColor;font-variant-numeric:tabular-nums}}
.amuros-picture .paper{{fill:#fff}}
.amuros-picture .title{{font-size:{TITLE_SIZE}px;font-weight:600}}
.amuros-picture .header{{font-weight:600}}
.amuros-picture .small{{font-size:{SMALL_SIZE}px}}
.amuros-picture text.muted{{fill-opacity:.72}}
.amuros-picture .gap{{stroke:#fff;stroke-width:1.5;fill:none}}
.amuros-picture .instant{{stroke:currentColor;stroke-opacity:.45;stroke-width:.7;fill:none}}
.amuros-picture .halo{{stroke:#fff;stroke-opacity:.8;stroke-width:3.5;stroke-linejoin:round;fill:none}}
.amuros-picture text.halo{{paint-order:stroke;fill:currentColor}}
.amuros-picture .label{{fill:#fff;fill-opacity:.86;stroke:none}}
.amuros-picture .band{{fill:currentColor;fill-opacity:.04}}
.amuros-picture .grid{{stroke:currentColor;stroke-opacity:.13;fill:none}}
.amuros-picture .rule{{stroke:currentColor;stroke-opacity:.55;fill:none}}
.amuros-picture .line{{stroke:currentColor;stroke-width:1.5;fill:none}}
.amuros-picture .mark{{stroke:currentColor;stroke-width:1.2;fill:none}}
.amuros-picture .head{{fill:currentColor}}
.amuros-picture .alert{{stroke:{_ALERT};stroke-width:2;fill:none}}
.amuros-picture .late{{fill:{_ALERT};fill-opacity:.3;stroke:{_ALERT}}}
.amuros-picture .bound{{stroke:#0072b2;stroke-width:2;fill:none}}
.amuros-picture .empty{{fill:none}}
.amuros-picture .good{{stroke:#009e73;stroke-width:2;fill:none}}
.amuros-picture .unsure{{stroke:currentColor;stroke-opacity:.6;stroke-width:2;fill:none}}
.amuros-picture .frame{{fill:currentColor;fill-opacity:.03;stroke:currentColor;stroke-opacity:.35}}
.amuros-picture .box{{fill:#fff;stroke:currentColor;stroke-width:1.2}}
.amuros-picture .flow{{stroke:currentColor;stroke-opacity:.7;stroke-width:1.2;stroke-linejoin:round;fill:none}}
.amuros-picture .way{{stroke-width:4;stroke-opacity:.75;stroke-linejoin:round;fill:none}}
{_TASKS}
.amuros-picture .bars{{stroke:#fff;stroke-width:.5}}
.amuros-picture .steps{{fill:none;stroke-width:2}}
@media screen and (prefers-color-scheme:dark){{
.amuros-picture{{color:#e6e8eb}}
.amuros-picture .paper,.amuros-picture .box{{fill:#15181d}}
.amuros-picture .halo,.amuros-picture .gap,.amuros-picture .bars{{stroke:#15181d}}
.amuros-picture .label{{fill:#15181d}}
.amuros-picture .bound{{stroke:#56b4e9}}
}}
"""

_UNKNOWN_ID = "amuros-unknown"

_ARROW = "amuros-arrow"
#: The value of `marker_end` for an arrow.
ARROW_END = f"url(#{_ARROW})"
#: Lines within a tile of so many pixels; what is drawn behind them is as opaque as the second number says.
_HATCHES = {
    State.READY: ("M-1 7L7 -1M-1 1L1 -1M5 7L7 5", 6, 0.16, 1.3),
    State.POLLING: ("M2 0V4", 4, 0.3, 2),
    State.PARKING: ("M0 0L6 6M0 6L6 0", 6, 0.12, 0.9),
    State.WAITING: ("M1 1.5h1.4M4 4.5h1.4", 6, 0.08, 1.4),
}


def style_sheet() -> Markup:
    """The style of all pictures; several in a page may repeat it."""
    return element("style", Markup(_SHEET))


def _hatches(body: str) -> Markup:
    """The patterns that a body uses: of all states but those that have none, in all colours, and of what is unknown."""
    patterns = {_hatch_id(state, colour): _hatch(state, colour) for state in _HATCHES for colour in range(len(PALETTE))}
    patterns[_UNKNOWN_ID] = _unknown()
    return joined(pattern for name, pattern in patterns.items() if f"url(#{name})" in body)


def _unknown() -> Markup:
    lines = element("path", d="M-1 9L9 -1M-1 1L1 -1M7 9L9 7", class_="unsure", stroke_width=1)
    return element("pattern", lines, id=_UNKNOWN_ID, width=8, height=8, patternUnits="userSpaceOnUse")


def _arrow_tip() -> Markup:
    """The end of an arrow, as a marker."""
    tip = element("path", d="M0 0L7 3.5L0 7Z", class_="head")
    return element(
        "marker", tip, id=_ARROW, refX=7, refY=3.5, markerWidth=7, markerHeight=7, markerUnits="userSpaceOnUse", orient="auto"
    )


def _hatch(state: State, colour: int) -> Markup:
    lines, size, opacity, width = _HATCHES[state]
    ground = element("rect", width=size, height=size, fill=PALETTE[colour][0], fill_opacity=opacity)
    drawn = element("path", d=lines, stroke=PALETTE[colour][1], stroke_width=width, fill="none")
    return element(
        "pattern", ground, drawn, id=_hatch_id(state, colour), width=size, height=size, patternUnits="userSpaceOnUse"
    )


def _hatch_id(state: State, colour: int) -> str:
    return f"amuros-{state}-{colour}"


def state_look(state: State, colour: int) -> dict[str, str]:
    """The attributes of boxes in a state: filled, hatched, or empty, in the colour of the process."""
    number = colour % len(PALETTE)
    if state in _HATCHES:
        return {"class_": f"t{number}", "fill": f"url(#{_hatch_id(state, number)})"}
    return {"class_": f"c{number}"} if state is State.RUNNING else {"class_": f"t{number} empty"}


#: Pixels.
WIDTH, MARGIN = 960, 16
#: Where what is below the title begins.
TOP = 58
_KEY_WIDTH, _KEY_GAP, _LEGEND_LINE = 24, 20, 20


#: An entry of a legend: whether the picture shows such a thing, a key in a box of 18 by 12 pixels around (0, 0), and what it means.
Entry: TypeAlias = tuple[object, Markup, str]


def picture_of(
    title: str,
    subtitle: str,
    body: Iterable[Markup],
    bottom: float,
    entries: Iterable[Entry] = (),
    notes: Sequence[str] = (),
    width: float = WIDTH,
    **attributes: str,
) -> Markup:
    """A picture with attributes, and with its legend and notes from `bottom` on.

    The subtitle also describes it to those who do not see it.
    """
    legend, end = _legend([(key, meaning) for is_shown, key, meaning in entries if is_shown], notes, bottom, width)
    height = end + MARGIN
    content = joined((*body, legend))
    shown = elided(title, TITLE_SIZE, width - 2 * MARGIN, is_bold=True)
    parts = (
        tooltip(title),
        element("desc", text(subtitle)),
        style_sheet(),
        element("defs", _hatches(content), _arrow_tip()),
        element("rect", class_="paper", width=width, height=height),
        text_at(shown, MARGIN, 26, "title"),
        text_at(subtitle, MARGIN, 45, "muted", room=width - 2 * MARGIN),
        content,
    )
    return element(
        "svg",
        Markup("\n" + joined(parts) + "\n"),
        xmlns="http://www.w3.org/2000/svg",
        class_="amuros-picture",
        role="img",
        width=width,
        height=height,
        viewBox=f"0 0 {number(width)} {number(height)}",
        **attributes,
    )


def _legend(entries: Sequence[tuple[Markup, str]], notes: Sequence[str], y: float, page_width: float) -> tuple[Markup, float]:
    """The legend from `y` on, and where it ends; each note has a line of its own."""
    parts: list[Markup] = []
    x, middle = float(MARGIN), y + _LEGEND_LINE / 2
    for key, meaning in entries:
        width = _KEY_WIDTH + text_width(meaning, SMALL_SIZE)
        if x > MARGIN and x + width > page_width - MARGIN:
            x, middle = float(MARGIN), middle + _LEGEND_LINE
        parts.append(element("g", key, transform=f"translate({number(x + 9)} {number(middle)})"))
        parts.append(text_at(meaning, x + _KEY_WIDTH, middle + 4, "small"))
        x += width + _KEY_GAP
    bottom = middle + _LEGEND_LINE / 2 if entries else y
    for note in notes:
        parts.append(text_at(note, MARGIN, bottom + 14, "small muted", room=page_width - 2 * MARGIN))
        bottom += _LEGEND_LINE
    return joined(parts), bottom


def swatch(look: str, height: float = 12, **attributes: str | float) -> Markup:
    """The key of boxes in a legend."""
    return rect_at(look, -9, -height / 2, 18, height, **attributes)


def limit_line(d: str) -> Markup:
    """A line at a limit."""
    return path_of("alert", d, stroke_dasharray="6 3")


#: The key of limits in a legend.
LIMIT = limit_line("M-9 0H9")


def unknown(left: float, top: float, width: float, height: float) -> Markup:
    """A part of a bar that is unknown."""
    return element("rect", x=left, y=top, width=width, height=height, fill=f"url(#{_UNKNOWN_ID})")


def nothing(sentence: str, y: float = TOP + 20) -> Markup:
    """Why a picture shows nothing."""
    return text_at(sentence, MARGIN, y, "muted")


def turned(content: str, top: float, bottom: float, room: float | None = None) -> Markup:
    """What a vertical axis is, at the left margin."""
    place = f"translate({MARGIN + SMALL_SIZE} {number((top + bottom) / 2)}) rotate(-90)"
    shown = content if room is None else elided(content, SMALL_SIZE, room)
    return element("text", text(shown), class_="small muted", transform=place, text_anchor="middle")


def columns(ticks: Iterable[tuple[float, str]], top: float, bottom: float) -> Iterator[Markup]:
    """Vertical lines at ticks, and their labels below."""
    for x, content in ticks:
        yield path_of("grid", vertical(x, top, bottom))
        yield text_at(content, x, bottom + 17, "small", anchor="middle")


def levels(ticks: Iterable[tuple[float, str]], left: float, right: float) -> Iterator[Markup]:
    """Horizontal lines at ticks, and their labels at the left."""
    for y, content in ticks:
        yield path_of("grid", horizontal(left, right, y))
        yield text_at(content, left - 8, y + 4, "small", anchor="end")


_MISSED = ("alert", "M-4 -4L4 4M4 -4L-4 4")
_SHAPES = {
    Verdict.MET: ("good", "M-5 0L-1.5 4L5 -4"),
    Verdict.MISSED: _MISSED,
    Verdict.UNBOUNDED: _MISSED,
    Verdict.UNKNOWN: ("unsure", "M-3 -2.5A3 3 0 1 1 1.2 0.2Q0 .8 0 2M0 4V5.5"),
}
#: Pixels that a mark takes.
MARK = 12


def draw_verdict(verdict: Verdict | None, x: float, y: float) -> Markup:
    """The mark of a verdict around (x, y); nothing for no verdict."""
    if verdict is None:
        return Markup("")
    style, shape = _SHAPES[verdict]
    return element("g", tooltip(str(verdict)), path_of(style, shape), transform=f"translate({round(x, 2):g} {round(y, 2):g})")


def verdict_entries(shown: Container[Verdict | None]) -> Iterator[Entry]:
    """Entries of the legend for the verdicts that a picture shows."""
    return ((verdict in shown, draw_verdict(verdict, 0, 0), str(verdict)) for verdict in Verdict)


# Text has no angle brackets: they are escaped.
_TAG = re.compile(r"<[^>]*>")
_STYLE = re.compile(r"<style>.*?</style>\n?", re.DOTALL)


def embedded(picture: str, prefix: str) -> Markup:
    """A picture for a page that has other ones and, once, `style.style_sheet`.

    Parameters
    ----------
    prefix : of the ids of the picture, another one for each picture of the page; ASCII letters, digits and hyphens
    """

    def with_prefix(tag: re.Match[str]) -> str:
        return tag[0].replace(' id="amuros-', f' id="{prefix}-').replace("url(#amuros-", f"url(#{prefix}-")

    return Markup(_TAG.sub(with_prefix, _STYLE.sub("", picture)))
