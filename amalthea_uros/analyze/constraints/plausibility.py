"""Limits that nobody can have meant: they decide a verdict, whatever the system does."""

from __future__ import annotations

from amalthea_uros.analyze.results.requirements import RequirementResult
from amalthea_uros.perf.constraints import TimeMetric
from amalthea_uros.perf.named import Named
from amalthea_uros.timing.basics.notes import AnalysisNotes
from amalthea_uros.units import HOUR, time_text

#: Longer limits are certainly mistakes in the unit: a year.
MAX_LIMIT = 365 * 24 * HOUR
#: Differences, which can be negative.
_SIGNED = (TimeMetric.LATENESS, TimeMetric.END_TO_START)


def note_implausible(result: RequirementResult, item: Named, notes: AnalysisNotes) -> None:
    """Report a limit that is negative or longer than a year."""
    if result.limit is None:
        return
    if result.limit < 0 and result.quantity not in _SIGNED:
        verdict = "can never be met" if result.is_upper else "is always met"
        limit = time_text(result.limit) if result.limit > -MAX_LIMIT else "of more than a year below zero"
        notes.warning("ANA010", f"the limit {limit} of {result.name!r} is negative, so it {verdict}", item)
    elif result.limit > MAX_LIMIT:
        notes.warning("ANA010", f"the limit of {result.name!r} is longer than a year", item)
