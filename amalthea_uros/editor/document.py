"""A text in the editor: its lines as the protocol counts them, and its path."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path

from lsprotocol import types
from pygls.workspace import PositionCodec

from amalthea_uros._internal.paths import is_description, is_other_yaml
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.services.files_of_model import files_of_model

#: The ends of lines of the protocol; `str.splitlines` knows more.
_LINE_END = re.compile(r"\r\n|\n|\r")
#: What a finding without an end is about: the start tag, the quoted text or the word at its place.
_TOKEN = re.compile(r'"[^"]*"|\'[^\']*\'|</?[^\s<>/]+|[^\s,:=<>{}"\'\[\]]+')


@dataclass(frozen=True)
class TextDocument:
    """One version of a text.

    Attributes
    ----------
    path : where the text will be saved
    codec : counts characters as the editor does, usually in units of UTF-16
    """

    uri: str
    path: Path
    text: str
    version: int | None
    codec: PositionCodec = field(default_factory=PositionCodec)

    @cached_property
    def lines(self) -> list[str]:
        """The lines without their ends."""
        return _LINE_END.split(self.text)

    @property
    def contents(self) -> Mapping[Path, bytes]:
        """The content of the file if the text were saved."""
        return {self.path: self.text.encode("utf-8", "surrogatepass")}

    @cached_property
    def is_description(self) -> bool:
        """Whether the text is an `app.yaml`, rather than a model."""
        return is_description(self.path)

    @property
    def is_ours(self) -> bool:
        """Whether the text is an `app.yaml` or a model; needs its contents to be overlaid."""
        return not is_other_yaml(self.path)

    @property
    def files(self) -> tuple[Path, ...]:
        """The files of the model that the text is part of; needs its contents to be overlaid."""
        return (self.path,) if self.is_description else files_of_model(self.path)

    def position(self, line: int, column: int) -> types.Position:
        """A place, counted from 0 in characters, as the editor counts it."""
        text = self.lines[line] if line < len(self.lines) else ""
        return types.Position(line, self.codec.client_num_units(text[:column]))

    def column(self, position: types.Position) -> int:
        """The number of characters before a position in its line."""
        line = self.lines[position.line] if position.line < len(self.lines) else ""
        units = 0
        for column, character in enumerate(line):
            if units >= position.character:
                return column
            units += self.codec.client_num_units(character)
        return len(line)

    def token(self, line: int, column: int) -> types.Range:
        """The word that starts at a place, or only the place."""
        text = self.lines[line] if line < len(self.lines) else ""
        column = min(column, len(text))
        found = _TOKEN.match(text, column)
        return types.Range(self.position(line, column), self.position(line, found.end() if found else column + 1))
