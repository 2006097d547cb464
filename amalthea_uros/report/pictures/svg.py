"""Elements of SVG as text, and how wide text is at most: a picture has to know without asking for the fonts of who looks at it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NewType
from xml.sax.saxutils import escape, quoteattr

from amalthea_uros.report.basics.escape import visible

#: Pixels.
TITLE_SIZE, TEXT_SIZE, SMALL_SIZE = 16, 12, 11
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
    return Markup("\n".join(filter(None, parts)))


def tooltip(content: str) -> Markup:
    """What is shown where the pointer rests on the element around it."""
    return element("title", text(content))


def number(value: float) -> str:
    """A coordinate, to a hundredth of a pixel."""
    # Adding zero makes a zero of a negative zero.
    return f"{round(value, 2) + 0.0:.2f}".rstrip("0").rstrip(".")


def text_at(
    content: str, x: float, y: float, look: str = "", *, anchor: str = "", room: float | None = None, **attributes: str | float
) -> Markup:
    """A text at a point.

    Parameters
    ----------
    look : classes of the style sheet: "small", "header" (bold), "muted" ...
    anchor : "middle" or "end": what of the text is at `x`; by default its start
    room : pixels for it; without its middle if it takes more
    """
    if room is not None:
        content = elided(content, SMALL_SIZE if "small" in look else TEXT_SIZE, room, is_bold="header" in look)
    styled: dict[str, str | float] = {"class_": look} if look else {}
    anchored: dict[str, str | float] = {"text_anchor": anchor} if anchor else {}
    return element("text", text(content), **styled, x=x, y=y, **anchored, **attributes)


def path_of(look: str, d: str, **attributes: str | float) -> Markup:
    """A path in a class of the style sheet; nothing without data."""
    return element("path", class_=look, **attributes, d=d) if d else Markup("")


def rect_at(look: str, x: float, y: float, width: float, height: float, *children: Markup, **attributes: str | float) -> Markup:
    """A rectangle in a class of the style sheet."""
    return element("rect", *children, class_=look, x=x, y=y, width=width, height=height, **attributes)


def tipped(tip: str, *parts: Markup) -> Markup:
    """Parts with a text that is shown where the pointer rests on them."""
    return element("g", tooltip(tip), *parts)


def vertical(x: float, top: float, bottom: float) -> str:
    """The data of a vertical line."""
    return f"M{number(x)} {number(top)}V{number(bottom)}"


def horizontal(left: float, right: float, y: float) -> str:
    """The data of a horizontal line."""
    return f"M{number(left)} {number(y)}H{number(right)}"


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
