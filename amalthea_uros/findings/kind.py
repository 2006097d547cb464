"""One kind of finding."""

from __future__ import annotations

from dataclasses import dataclass

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
    """

    id: str
    title: str
    severity: Severity
    rationale: str
    remedy: str
    fails: str = ""
