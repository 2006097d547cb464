"""A system in the plain form as the product reads it from the text of a model."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from opponent.systems import PlainSystem
from opponent.to_text import to_text

from amalthea_uros.perf.system import System
from amalthea_uros.services.subject import open_system

MICROSECOND = 10**6


def read_system(text: str) -> System:
    """The system of a model."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "model.amxmi"
        path.write_text(text, encoding="utf-8")
        return open_system([path]).system


def to_perf(plain: PlainSystem) -> System:
    """The same system in the terms of the product."""
    return read_system(to_text(plain))
