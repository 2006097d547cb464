"""The text from which a document was read, and the positions of its objects in it.

The text is kept as long as the document: it gives line and column of every object and attribute, and saving compares the document
with it, so that everything that was not modified is written as it was.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.tags import XmlContent, attributes_of_tag

#: Most parts of a text of so many characters have only ASCII, which is found out faster than where others are.
_CHUNK = 256
_BEYOND_ASCII = re.compile(r"[^\x00-\x7f]+")


class FileText:
    """The characters of a file and how they were stored.

    Most files are ASCII and are read from their bytes alone; the characters are made when they are asked for.

    Parameters
    ----------
    text : the characters, or the bytes if these are characters in UTF-8
    encoding : a Python codec name ("utf-8-sig" with a byte order mark)
    zip_entry : name of the entry if the file was a ZIP, else None
    """

    __slots__ = ("_text", "encoding", "zip_entry")

    def __init__(self, text: str | bytes, encoding: str = "utf-8", zip_entry: str | None = None) -> None:
        self._text = text
        self.encoding = encoding
        self.zip_entry = zip_entry

    @property
    def text(self) -> str:
        """The characters."""
        if isinstance(self._text, bytes):
            # Instead of the bytes, since both would take twice the memory as long as the model is open.
            self._text = self._text.decode()
        return self._text

    @property
    def utf8(self) -> bytes:
        """The characters in UTF-8. To encode them takes long and, since Python keeps the result, as much memory as the text."""
        return self._text if isinstance(self._text, bytes) else self._text.encode()

    @property
    def is_ascii(self) -> bool:
        """Whether each character is one byte."""
        return self._text.isascii()


class Position(NamedTuple):
    """Line and column, both counted from 1; columns count characters."""

    line: int
    column: int


class Prefixes(NamedTuple):
    """How a document names the special attributes; only the namespaces are fixed, the prefixes are not."""

    xmi_id: str = "xmi:id"
    xsi_type: str = "xsi:type"
    type_prefix: str = "am:"


@dataclass(frozen=True)
class SourceText:
    """Text and layout of one file.

    Attributes
    ----------
    file : its characters and how they were stored
    version : AMALTHEA version that it declares
    prefixes : names of the special attributes
    elements : every object read from the text, in its order
    other_tags : of each start tag that gave no object, the number of objects before it
    byte_starts : offsets of the start tags of the objects in bytes of UTF-8; None if they are those of the text, without the others
    """

    file: FileText
    version: str = ""
    prefixes: Prefixes = field(default=Prefixes())
    elements: Sequence[Element] = ()
    other_tags: Sequence[int] = ()
    byte_starts: Sequence[int] | None = None

    @cached_property
    def text(self) -> str:
        """The characters of the file."""
        return self.file.text

    @cached_property
    def content(self) -> XmlContent:
        """The elements of the text."""
        return XmlContent(self.text)

    @cached_property
    def starts(self) -> Sequence[int]:
        """Offsets in `text` of the start tags of all objects. Found again when they are asked for, since to note them takes longer."""
        if self.byte_starts is not None:
            return [self.character_offset(offset) for offset in self.byte_starts]
        others = {number + before for number, before in enumerate(self.other_tags)}
        starts = self.content.starts
        return [start for number, start in enumerate(starts) if number not in others] if others else starts

    @cached_property
    def by_start(self) -> dict[int, int]:
        """Offset of a start tag -> place of its object in `elements`."""
        return {start: place for place, start in enumerate(self.starts)}

    @cached_property
    def _is_ascii(self) -> bool:
        return self.file.is_ascii

    @cached_property
    def _shifts(self) -> tuple[list[int], list[int]]:
        """After each run of characters outside ASCII: the offset in bytes, and the difference to the offset in characters."""
        offsets, shifts = [0], [0]
        chunks = range(0, len(self.text), _CHUNK)
        beyond = (at for at in chunks if not self.text[at : at + _CHUNK].isascii())
        for run in (run for at in beyond for run in _BEYOND_ASCII.finditer(self.text, at, at + _CHUNK)):
            shift = shifts[-1] + len(run[0].encode()) - len(run[0])
            offsets.append(run.end() + shift)
            shifts.append(shift)
        return offsets, shifts

    def character_offset(self, byte_offset: int) -> int:
        """An offset in bytes of UTF-8, at the start or end of a tag, as an offset in characters."""
        if self._is_ascii:
            return byte_offset
        offsets, shifts = self._shifts
        return byte_offset - shifts[bisect_right(offsets, byte_offset) - 1]

    @cached_property
    def index(self) -> dict[Element, int]:
        """The index of each object in `elements`."""
        return {element: i for i, element in enumerate(self.elements)}

    @cached_property
    def _lines(self) -> dict[int, str]:
        return {}

    @cached_property
    def _line_starts(self) -> list[int]:
        return [0, *(end.end() for end in re.finditer("\n", self.text))]

    def position_of(self, element: Element, attribute: str = "") -> Position:
        """Line and column of an object or of one of its attributes (by its XML name).

        Raises
        ------
        KeyError : the object was not read from this text.
        """
        start = self.starts[self.index[element]]
        return self.position(self.attribute_offset(start, attribute) if attribute else start)

    def place_of(self, element: Element, attribute: str = "") -> tuple[int, int, str] | None:
        """Line and column of an object or one of its attributes, and the text of the line; None if it was not read from this text."""
        if element not in self.index:
            return None
        line, column = self.position_of(element, attribute)
        return line, column, self.line(line)

    def position(self, offset: int) -> Position:
        """Line and column of an offset."""
        line = bisect_right(self._line_starts, offset)
        return Position(line, offset - self._line_starts[line - 1] + 1)

    def line(self, number: int) -> str:
        """The text of one line, counted from 1, without its end."""
        # Cached, because a file may consist of one line, which is then part of the location of every object.
        if number not in self._lines:
            starts = self._line_starts
            end = starts[number] if number < len(starts) else len(self.text)
            self._lines[number] = self.text[starts[number - 1] : end].rstrip("\r\n")
        return self._lines[number]

    @cached_property
    def _attribute_offsets(self) -> dict[int, dict[str, int]]:
        return {}

    def attribute_offset(self, start: int, name: str) -> int:
        """Offset of an attribute of the tag that starts at `start`; of the tag itself if it has no such attribute."""
        # A tag is read once, because it may have thousands of attributes with findings.
        offsets = self._attribute_offsets.get(start)
        if offsets is None:
            found = {attribute["name"]: attribute.start("name") for attribute in attributes_of_tag(self.text, start)}
            offsets = self._attribute_offsets[start] = found
        return offsets.get(name, start)

    @property
    def newline(self) -> str:
        """The line end that the file uses."""
        first = self.text.find("\n")
        return "\r\n" if first > 0 and self.text[first - 1] == "\r" else "\n"
