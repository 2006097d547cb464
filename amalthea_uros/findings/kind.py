"""Kinds of findings, and the files with their texts."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from string import Template
from typing import Any

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros._internal.resources import parsed_yaml
from amalthea_uros.diagnostics import Severity, ToolEffect

#: An entry of a file: its key, and all that follows up to the next key.
_ENTRY = re.compile(r"^([A-Za-z][\w./-]*):\n(?:(?:[ ].*)?\n)*", re.MULTILINE)

#: The entry with texts that the examples of several entries share.
_SNIPPETS = "snippets"


@dataclass(frozen=True, kw_only=True)
class FindingKind:
    """What all findings of one id have in common.

    Attributes
    ----------
    id : unique; the findings carry it
    title : what is wrong, in a few words
    severity : that of the worst findings of the id
    effect : of the findings that are not errors, if they are about what a tool does; errors are about what makes it fail
    rationale : why it matters, or what follows from it
    remedy : what to do about it
    fails : content of a file for which the finding is reported, "" if none is useful
    edits : what to change in this content so that the finding is not reported: texts that occur once, with their replacements
    passes : the content after these edits; given as a whole where little of the failing content is left
    example_version : AMALTHEA version of the failing content
    beside : content of a second file, of AMALTHEA 3.3.0, that is loaded together with each of them
    """

    id: str
    title: str
    severity: Severity
    rationale: str
    remedy: str
    effect: ToolEffect | None = None
    fails: str = ""
    edits: Mapping[str, str] = field(default_factory=dict, hash=False)
    passes: str = ""
    example_version: str = "3.3.0"
    beside: str | None = None

    def __post_init__(self) -> None:
        if self.edits:
            object.__setattr__(self, "passes", _edited(self.fails, self.edits))


def _edited(text: str, edits: Mapping[str, str]) -> str:
    for old, new in edits.items():
        if text.count(old) != 1:
            raise ValueError(f"{old!r} occurs {text.count(old)} times in the example, instead of once")
        text = text.replace(old, new)
    return text


@cache
def _texts(file: Path) -> Mapping[str, str]:
    """The texts of the entries of a file, of which each is parsed when it is needed."""
    return {entry[1]: entry[0] for entry in _ENTRY.finditer(file.read_text(encoding="utf-8"))}


@cache
def ids_in(file: Path) -> tuple[str, ...]:
    """The ids of the kinds of findings that a file describes."""
    return tuple(identifier for identifier in _texts(file) if identifier != _SNIPPETS)


@cache
def kind_in(file: Path, identifier: str) -> FindingKind:
    """The kind of findings that an entry of a file describes; `$name` in its example is a text of the entry `snippets`."""
    texts = _texts(file)
    content: dict[str, Any] = parsed_yaml(texts[identifier])[identifier]
    if "$" in content.get("fails", ""):
        content["fails"] = Template(content["fails"]).substitute(parsed_yaml(texts[_SNIPPETS])[_SNIPPETS])
    effect = ToolEffect(content["effect"]) if "effect" in content else None
    return FindingKind(**{**content, "id": identifier, "severity": Severity(content["severity"]), "effect": effect})
