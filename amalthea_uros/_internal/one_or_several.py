"""Texts and paths that callers give alone or several of."""

from __future__ import annotations

from collections.abc import Iterable
from os import PathLike
from typing import TypeVar, cast

T = TypeVar("T")


def one_or_several(given: str | PathLike[str] | Iterable[T]) -> tuple[T, ...]:
    """What was given, as a tuple; a text is one object, not its letters."""
    return (cast("T", given),) if isinstance(given, str | PathLike) else tuple(given)
