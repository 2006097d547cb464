r"""Text from files as it is shown: what could act on a terminal, or on the log of a CI system, becomes an escape such as `\n`.

A name may contain anything: line ends that make up lines of our output, escape sequences of terminals, marks that reverse the direction
of the text (Boucher and Anderson, "Trojan Source", 2021), and bytes of a file name that are no text.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

#: Control and format characters, surrogates, and what XML 1.0 does not allow (section 2.2), none of which is printable.
_HIDDEN = (
    "[\x00-\x1f\x7f-\x9f\u061c\u200b\u200e\u200f\u2028-\u202e\u2060-\u2069\ud800-\udfff\ufeff\ufff9-\ufffb\ufffe\uffff"
    "\U000e0000-\U000e007f]"
)
_SHORT = {"\t": r"\t", "\n": r"\n", "\r": r"\r"}
#: The bytes of file names that are no text, as Python has them (PEP 383).
_BYTES = range(0xDC80, 0xDD00)

#: Paths of deep folders are words of some hundred characters.
_LONG_WORD = re.compile(r"[^\s'\",;]{500,}")
_SHOWN = 100

#: What a runner takes for a command: of GitHub at the start of a line, or of GitHub's first form and Azure Pipelines anywhere.
_COMMAND = re.compile(r"^(\s*):(?=:)|#(?=#(?:\[|vso\[))")


def visible(text: str) -> str:
    r"""A text in one line without hidden characters.

    >>> visible("a\nb\x1b[31m\u202e")
    'a\\nb\\x1b[31m\\u202e'
    """
    return text if text.isprintable() else re.sub(_HIDDEN, _escape, text)


def visible_cells(cells: Iterable[str]) -> list[str]:
    """The visible texts of a row; most rows have nothing to hide, which is sooner known of all their cells together."""
    row = list(cells)
    return row if "".join(row).isprintable() else list(map(visible, row))


def message_line(text: str) -> str:
    r"""A message in one line; words that a user or a file has given are cut where they are so long that they hide it.

    >>> message_line("unknown chain '" + "x" * 5000 + "'").endswith("xxx... (5,000 characters)'")
    True
    """
    return _LONG_WORD.sub(lambda word: f"{word[0][:_SHOWN]}... ({len(word[0]):,} characters)", visible(text))


def output_line(text: str) -> str:
    """A line of output: visible text that no CI system takes for a command."""
    shown = visible(text)
    return _COMMAND.sub(_harmless, shown) if "::" in shown or "##" in shown else shown


def visible_json(text: str) -> str:
    """JSON of several lines without hidden characters: they are escapes of JSON."""
    if text.isascii() and "\x7f" not in text:  # the other ones of ASCII are escapes already
        return text
    return "\n".join(re.sub(_HIDDEN, _json_escape, line) for line in text.split("\n"))


def _escape(match: re.Match[str]) -> str:
    character = match[0]
    code = ord(character)
    if code in _BYTES:
        code -= 0xDC00
    return _SHORT.get(character) or (
        f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"
    )


def _json_escape(match: re.Match[str]) -> str:
    units = match[0].encode("utf-16-be", "surrogatepass").hex()
    return "".join(f"\\u{units[i : i + 4]}" for i in range(0, len(units), 4))


def _harmless(match: re.Match[str]) -> str:
    return rf"{match[1]}\x3a" if match[1] is not None else r"\x23"
