"""Missing parts in messages."""

from __future__ import annotations

from collections.abc import Mapping


def missing(parts: Mapping[str, object]) -> str:
    """The names of the parts that are None, such as "stimulus or response"."""
    return " or ".join(name for name, part in parts.items() if part is None)
