"""How wide text is at most: a picture has to know without asking for the fonts of who looks at it."""

from __future__ import annotations

from amalthea_uros.report.escape import visible

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
_WIDEST, _BOLD = 1.0, 1.13
_WIDTHS = {character: width for width, characters in _CLASSES.items() for character in characters}
ELLIPSIS = "\N{HORIZONTAL ELLIPSIS}"


def text_width(content: str, size: float, *, is_bold: bool = False) -> float:
    """The most pixels that a text takes in a font of a size."""
    return sum(_WIDTHS.get(character, _WIDEST) for character in visible(content)) * size * (_BOLD if is_bold else 1)


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
