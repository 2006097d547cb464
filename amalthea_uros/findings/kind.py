"""One kind of finding."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from amalthea_uros.diagnostics import Severity


@dataclass(frozen=True, slots=True, kw_only=True)
class FindingKind:
    """What all findings of one id have in common.

    Attributes
    ----------
    id : unique; the findings carry it
    title : what is wrong, in a few words
    severity : that of the worst findings of the id
    rationale : why it matters, or what follows from it
    remedy : what to do about it
    fails : content of a file for which the finding is reported, "" if none is useful
    edits : what to change in this content so that the finding is not reported: texts that occur once, with their replacements
    passes : the content after these edits; given as a whole where little of the failing content is left
    """

    id: str
    title: str
    severity: Severity
    rationale: str
    remedy: str
    fails: str = ""
    edits: Mapping[str, str] = field(default_factory=dict, hash=False)
    passes: str = ""

    def __post_init__(self) -> None:
        if self.edits:
            object.__setattr__(self, "passes", _edited(self.fails, self.edits))


def _edited(text: str, edits: Mapping[str, str]) -> str:
    for old, new in edits.items():
        if text.count(old) != 1:
            raise ValueError(f"{old!r} occurs {text.count(old)} times in the example, instead of once")
        text = text.replace(old, new)
    return text
