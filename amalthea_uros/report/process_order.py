"""The order of processes in tables."""

from __future__ import annotations

from math import inf


def by_core_and_priority(core: str | None, is_isr: bool, priority: int | None) -> tuple[bool, str, bool, float]:
    """Sorts by core, and there by priority: what preempts others comes before them; unknown cores and priorities come last."""
    return (core is None, core or "", not is_isr, inf if priority is None else -priority)
