"""Names that callers give, looked up in what exists."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from amalthea_uros._internal.similar import did_you_mean
from amalthea_uros.errors import InvalidArgumentError

#: Longer lists of names are cut.
_MOST_NAMES = 20


def require(kind: str, names: Iterable[str], known: Iterable[str]) -> None:
    """Refuse a name that is not known.

    Raises
    ------
    InvalidArgumentError : says what the name may mean, or which names there are.
    """
    existing = list(known)
    for name in names:
        if name not in existing:
            raise InvalidArgumentError(f"unknown {kind} {name!r}; {_advice(kind, name, existing)}")


def listed(names: Sequence[str]) -> str:
    """Names as a list, which is cut if it is long."""
    rest = len(names) - _MOST_NAMES
    return ", ".join(names[:_MOST_NAMES]) + (f" and {rest} more" if rest > 0 else "")


def _advice(kind: str, name: str, existing: list[str]) -> str:
    if not existing:
        return f"the model has no {kind}"
    return did_you_mean(name, existing) or f"known: {listed(existing)}"
