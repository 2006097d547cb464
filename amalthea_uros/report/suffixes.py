"""The formats of reports by the suffixes of their files."""

from __future__ import annotations

from pathlib import Path

from amalthea_uros.errors import InvalidArgumentError

FORMATS = {".html": "html", ".md": "markdown", ".mmd": "mermaid", ".dot": "dot"}


def format_of(path: Path) -> str:
    """The format of a file.

    Raises
    ------
    InvalidArgumentError : another suffix.
    """
    if path.suffix.lower() not in FORMATS:
        raise InvalidArgumentError(f"the suffix of {str(path)!r} says no format; expected one of {', '.join(FORMATS)}")
    return FORMATS[path.suffix.lower()]
