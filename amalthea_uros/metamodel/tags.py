"""The tags in well-formed XML text.

A `<` begins a tag wherever it is not part of a comment, a processing instruction or a CDATA section, because values of attributes
cannot have one.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

#: What has no end extends to the end of the text, so that none is looked for again from each `<!--` in it.
_START_TAG = re.compile(r"<(?:!--.*?(?:-->|\Z)|!\[CDATA\[.*?(?:\]\]>|\Z)|\?.*?(?:\?>|\Z)|([^!?/]))", re.DOTALL)
_TAG_NAME = re.compile(r"<[^\s/>]+")
_ATTRIBUTE = re.compile(r"""\s+(?P<name>[^\s=/>]+)\s*=\s*(?P<quoted>"[^"]*"|'[^']*')""")
#: A piece of the content of an element: white space, a comment or an instruction, text, or a tag.
_NODE = re.compile(
    r"(?P<space>\s+)|(?P<comment><!--.*?-->|<\?.*?\?>)|(?P<text>(?:<!\[CDATA\[.*?\]\]>|[^<])+)|(?P<close></[^>]*>)"
    r"|<(?P<open>[^\s/>]+)[^>\"']*+(?:(?:\"[^\"]*\"|'[^']*')[^>\"']*+)*+>",
    re.DOTALL,
)


def attributes_of_tag(text: str, start: int) -> Iterator[re.Match[str]]:
    """The attributes of the start tag at an offset, as matches with `name` and `quoted`."""
    tag = _TAG_NAME.match(text, start)
    at = tag.end() if tag else start
    while attribute := _ATTRIBUTE.match(text, at):
        yield attribute
        at = attribute.end()


class ElementEnd(NamedTuple):
    """Where an element ends.

    Attributes
    ----------
    content : the offset of the end tag; that after the element if it is an empty one
    element : the offset after the element
    """

    content: int
    element: int


class XmlContent:
    """The elements of a text, by the offsets of their start tags."""

    def __init__(self, text: str) -> None:
        self.text = text

    @cached_property
    def starts(self) -> list[int]:
        """The offsets of all start tags and empty elements; of a text that is not well-formed, those before its first error count."""
        return [tag.start() for tag in _START_TAG.finditer(self.text) if tag.lastindex]

    def node(self, at: int) -> re.Match[str]:
        """The piece of content at an offset, as a match with `space`, `comment`, `text`, `close` or `open`, the name of the tag."""
        node = _NODE.match(self.text, at)
        assert node
        return node

    def end(self, start: int) -> ElementEnd:
        """Where an element ends."""
        opening = self.node(start)
        if opening[0].endswith("/>"):
            return ElementEnd(opening.end(), opening.end())
        text, name, begin = self.text, opening["open"], opening.end()
        closing = text.find(f"</{name}", begin)
        after = closing + len(name) + len("</>")
        # The usual case, which needs no look at every tag.
        if (
            text.startswith(">", after - 1)
            and text.find(f"<{name}", begin, closing) < 0
            and not self._has_others(begin, closing)
        ):
            return ElementEnd(closing, after)
        return self._scanned_end(opening)

    def _has_others(self, begin: int, end: int) -> bool:
        """Whether there may be comments and the like between two offsets, in which tags do not count."""
        return not self.has_tags_only and any(self.text.find(mark, begin, end) >= 0 for mark in ("<!", "<?"))

    @cached_property
    def has_tags_only(self) -> bool:
        """Whether there is nothing but tags and text after the XML declaration."""
        # A search for one character is twenty times faster than for two.
        return ("!" not in self.text or "<!" not in self.text) and self.text.find("<?", 1) < 0

    def _scanned_end(self, opening: re.Match[str]) -> ElementEnd:
        depth, node = 1, opening
        while depth:
            node = self.node(node.end())
            if node["close"]:
                depth -= 1
            elif node["open"] and not node[0].endswith("/>"):
                depth += 1
        return ElementEnd(node.start(), node.end())
