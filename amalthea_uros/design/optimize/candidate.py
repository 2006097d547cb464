"""A design, as the values in which it differs from the present one."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TypeAlias

from amalthea_uros.design.changes.change import Change

#: The changed values, ordered by their targets, without those that are as they were: equal designs are equal candidates.
Candidate: TypeAlias = tuple[Change, ...]

#: The design as it is.
UNCHANGED: Candidate = ()


def candidate(changes: Iterable[Change], present: Mapping[str, str]) -> Candidate:
    """The candidate of some changes.

    Parameters
    ----------
    present : target -> the value as it is, written as in the changes
    """
    last = {change.target: change for change in changes}
    return tuple(change for target, change in sorted(last.items()) if present.get(target) != change.value)
