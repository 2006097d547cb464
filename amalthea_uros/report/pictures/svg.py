"""Elements of SVG as text, and what all pictures have in common: style, widths of text, title, legend, marks of verdicts."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NewType
from xml.sax.saxutils import escape, quoteattr

from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.report.basics.escape import visible
from amalthea_uros.report.pictures.jobs import State

#: Text that is well-formed SVG.
Markup = NewType("Markup", str)


def text(content: str) -> Markup:
    """Characters, with those escaped that XML gives a meaning."""
    return Markup(escape(visible(content)))


def element(tag: str, *children: Markup, **attributes: str | float) -> Markup:
    """An element; an underscore at the end of an attribute's name is dropped, others become hyphens.

    >>> element("text", text("a < b"), class_="small", text_anchor="end", x=1.50)
    '<text class="small" text-anchor="end" x="1.5">a &lt; b</text>'
    """
    written = "".join(f" {name.rstrip('_').replace('_', '-')}={_attribute(value)}" for name, value in attributes.items())
    content = "".join(children)
    return Markup(f"<{tag}{written}>{content}</{tag}>" if content else f"<{tag}{written}/>")


def joined(parts: Iterable[Markup]) -> Markup:
    """One element after the other, each in a line of its own."""
    return Markup("\n".join(parts))


def tooltip(content: str) -> Markup:
    """What is shown where the pointer rests on the element around it."""
    return element("title", text(content))


def number(value: float) -> str:
    """A coordinate, to a hundredth of a pixel."""
    # Adding zero makes a zero of a negative zero.
    return f"{round(value, 2) + 0.0:.2f}".rstrip("0").rstrip(".")


def _attribute(value: str | float) -> str:
    return quoteattr(visible(value)) if isinstance(value, str) else f'"{number(value)}"'


#: Advance widths in parts of the font size, for characters up to that width. They are those of DejaVu Sans, rounded up: it is the
#: widest of the fonts that are usual on screens.
_CLASSES = {
    0.36: " ',-./:;IJ\\fijl|",
    0.5: '!"()*[]_`rt',
    0.64: "$0123456789?EFLPSTYabcdeghknopqsuvxyz{}",
    0.7: "ABCKRVXZ",
    0.8: "&DGHNOQU",
    0.86: "#+<=>M^w~",
}
_WIDEST_CHARACTER, _BOLD = 1.0, 1.13
_WIDTHS = {character: width for width, characters in _CLASSES.items() for character in characters}
ELLIPSIS = "\N{HORIZONTAL ELLIPSIS}"


def text_width(content: str, size: float, *, is_bold: bool = False) -> float:
    """The most pixels that a text takes in a font of a size."""
    return sum(_WIDTHS.get(character, _WIDEST_CHARACTER) for character in visible(content)) * size * (_BOLD if is_bold else 1)


def elided(content: str, size: float, room: float, *, is_bold: bool = False) -> str:
    """The text, without its middle if it does not fit: names often differ at their ends only."""
    content = visible(content)
    if text_width(content, size, is_bold=is_bold) <= room:
        return content
    for kept in range(len(content) - 1, 0, -1):
        shorter = content[: (kept + 1) // 2] + ELLIPSIS + content[len(content) - kept // 2 :]
        if text_width(shorter, size, is_bold=is_bold) <= room:
            return shorter
    return ""


#: Pixels.
TITLE_SIZE, TEXT_SIZE, SMALL_SIZE = 16, 12, 11

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
#: The fill of what is unknown.
UNKNOWN = f"url(#{_UNKNOWN_ID})"

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


def hatches(body: str) -> Markup:
    """The patterns that a body uses: of all states but those that have none, in all colours, and of what is unknown."""
    patterns = {_hatch_id(state, colour): _hatch(state, colour) for state in _HATCHES for colour in range(len(PALETTE))}
    patterns[_UNKNOWN_ID] = _unknown()
    return joined(pattern for name, pattern in patterns.items() if f"url(#{name})" in body)


def _unknown() -> Markup:
    lines = element("path", d="M-1 9L9 -1M-1 1L1 -1M7 9L9 7", class_="unsure", stroke_width=1)
    return element("pattern", lines, id=_UNKNOWN_ID, width=8, height=8, patternUnits="userSpaceOnUse")


def arrow_tip() -> Markup:
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


@dataclass(frozen=True, slots=True)
class LegendEntry:
    """A key, drawn in a box of 18 by 12 pixels around (0, 0), and what it means."""

    key: Markup
    meaning: str


def document(
    title: str, subtitle: str, body: Iterable[Markup], height: float, width: float = WIDTH, **attributes: str
) -> Markup:
    """A picture with attributes; the subtitle also describes it to those who do not see it."""
    paper = element("rect", class_="paper", width=width, height=height)
    shown = elided(title, TITLE_SIZE, width - 2 * MARGIN, is_bold=True)
    content = joined(body)
    parts = (
        tooltip(title),
        element("desc", text(subtitle)),
        style_sheet(),
        element("defs", hatches(content), arrow_tip()),
        paper,
        element("text", text(shown), class_="title", x=MARGIN, y=26),
        element("text", text(elided(subtitle, TEXT_SIZE, width - 2 * MARGIN)), class_="muted", x=MARGIN, y=45),
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


def draw_legend(
    entries: Sequence[LegendEntry], notes: Sequence[str], y: float, page_width: float = WIDTH
) -> tuple[Markup, float]:
    """The legend from `y` on, and where it ends; each note has a line of its own."""
    parts: list[Markup] = []
    x, middle = float(MARGIN), y + _LEGEND_LINE / 2
    for entry in entries:
        width = _KEY_WIDTH + text_width(entry.meaning, SMALL_SIZE)
        if x > MARGIN and x + width > page_width - MARGIN:
            x, middle = float(MARGIN), middle + _LEGEND_LINE
        parts.append(element("g", entry.key, transform=f"translate({number(x + 9)} {number(middle)})"))
        parts.append(element("text", text(entry.meaning), class_="small", x=x + _KEY_WIDTH, y=middle + 4))
        x += width + _KEY_GAP
    bottom = middle + _LEGEND_LINE / 2 if entries else y
    for note in notes:
        shown = elided(note, SMALL_SIZE, page_width - 2 * MARGIN)
        parts.append(element("text", text(shown), class_="small muted", x=MARGIN, y=bottom + 14))
        bottom += _LEGEND_LINE
    return joined(parts), bottom


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
    mark = element("path", class_=style, d=shape)
    return element("g", tooltip(str(verdict)), mark, transform=f"translate({round(x, 2):g} {round(y, 2):g})")


def verdict_entries(shown: set[Verdict | None]) -> list[LegendEntry]:
    """Entries of the legend for the verdicts that a picture shows."""
    return [LegendEntry(draw_verdict(verdict, 0, 0), str(verdict)) for verdict in Verdict if verdict in shown]


# Text has no angle brackets: they are escaped.
_TAG = re.compile(r"<[^>]*>")
_STYLE = re.compile(r"<style>.*?</style>\n?", re.DOTALL)


def embedded(picture: str, prefix: str) -> Markup:
    """A picture for a page that has other ones and, once, `style.style_sheet`.

    Parameters
    ----------
    prefix : of the ids of the picture, another one for each picture of the page; ASCII letters, digits and hyphens
    """
    return Markup(_TAG.sub(lambda tag: _with_prefix(tag[0], prefix), _STYLE.sub("", picture)))


def _with_prefix(tag: str, prefix: str) -> str:
    return tag.replace(' id="amuros-', f' id="{prefix}-').replace("url(#amuros-", f"url(#{prefix}-")
