"""What is said about an error inside this package that must not end the whole run."""

from __future__ import annotations

from pathlib import Path
from traceback import extract_tb


def failure(error: Exception) -> str:
    """What went wrong, and where in the code."""
    frame = extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {error} ({Path(frame.filename).name}:{frame.lineno})"
