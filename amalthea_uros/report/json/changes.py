"""Changed values of a system for programs."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.design.changes.apply import Difference


def content(differences: Iterable[Difference]) -> list[dict[str, str | bool]]:
    """The values before and after, as text; the keys are those of `--set`."""
    return [
        {"key": each.target, "from": each.before, "to": each.after, "consequence": each.is_consequence} for each in differences
    ]
