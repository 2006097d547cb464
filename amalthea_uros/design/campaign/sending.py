"""Systems as bytes, to be sent to other processes."""

from __future__ import annotations

import pickle
from dataclasses import replace
from functools import partial
from io import BytesIO
from typing import Any

from amalthea_uros.perf.system import System


def system_bytes(system: System) -> bytes:
    """A system without the way back to the objects and files that it was extracted from; those stay here."""
    return compact_bytes(replace(system))  # a replaced system has no tables of names yet


def compact_bytes(value: object) -> bytes:
    """Something with systems, without their way back to objects and files."""
    stream = BytesIO()
    _Pickler(stream, pickle.HIGHEST_PROTOCOL).dump(value)
    return stream.getvalue()


def system_from(data: bytes) -> System:
    """The system of some bytes."""
    system: System = pickle.loads(data)
    return system


class _Pickler(pickle.Pickler):
    def reducer_override(self, obj: Any) -> Any:
        """Leave out what finds the place of an activity in a file: it holds the whole AMALTHEA model."""
        return (_nowhere, ()) if isinstance(obj, partial) else NotImplemented


def _nowhere() -> None:
    """The place of an activity that was sent."""
