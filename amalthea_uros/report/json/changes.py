"""Changes of a system for programs."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.services.changes.apply import Difference


def content(differences: Iterable[Difference]) -> list[dict[str, str | bool]]:
    """The values before and after, as text."""
    return [
        {
            "object": each.object,
            "key": each.key,
            "before": each.before,
            "after": each.after,
            "consequence": each.is_consequence,
        }
        for each in differences
    ]
