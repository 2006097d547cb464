"""Texts of descriptions, each understood once."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from amalthea_uros.uros.described import Described, describe_text


@lru_cache(maxsize=32)
def described(text: str, path: Path) -> Described:
    """The content of a text, as `describe_text`; searches and edits ask for the same ones again."""
    return describe_text(text, path)
