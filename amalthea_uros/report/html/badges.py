"""Verdicts and severities as badges."""

from __future__ import annotations

from amalthea_uros.analyze.results.processes import ProcessResult
from amalthea_uros.analyze.results.requirements import RequirementResult
from amalthea_uros.diagnostics import Severity
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.judge.verdict import ObservedVerdict, Verdict
from amalthea_uros.report.html.blocks import Badge, Tone

_TONES = {
    Verdict.MET: Tone.GOOD,
    Verdict.MISSED: Tone.BAD,
    Verdict.UNBOUNDED: Tone.BAD,
    Verdict.UNKNOWN: Tone.UNKNOWN,
    ObservedVerdict.OK: Tone.GOOD,
    ObservedVerdict.MISSED: Tone.BAD,
    ObservedVerdict.NOT_OBSERVED: Tone.UNKNOWN,
    Schedulable.YES: Tone.GOOD,
    Schedulable.NO: Tone.BAD,
    Schedulable.UNKNOWN: Tone.UNKNOWN,
    Severity.ERROR: Tone.BAD,
    Severity.WARNING: Tone.UNKNOWN,
    Severity.INFO: Tone.NEUTRAL,
}


def badge(value: Verdict | ObservedVerdict | Severity | None, word: str = "") -> Badge:
    """A verdict or a severity; without one, there was nothing to judge."""
    if value is None:
        return Badge("no limit", Tone.NEUTRAL)
    return Badge(word or value.replace("_", " "), _TONES[value])


def verdict_badge(item: ProcessResult | RequirementResult) -> Badge:
    """The verdict on a process or a requirement, with what is wrong."""
    return badge(item.verdict, str(item.failure or "") if isinstance(item, ProcessResult) else "")


def tone_of(schedulable: Schedulable) -> Tone:
    """That of the verdict on a system."""
    return _TONES[schedulable]
