"""The page of a picture: its title, its legend, and all of it as a document."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from amalthea_uros.report.pictures.style import SMALL_SIZE, TEXT_SIZE, TITLE_SIZE, arrow_tip, hatches, style_sheet
from amalthea_uros.report.pictures.svg import Markup, element, joined, number, text, tooltip
from amalthea_uros.report.pictures.text_widths import elided, text_width

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
