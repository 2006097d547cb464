"""What callers of the library give: paths, a model, or a system."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, TypeAlias

from amalthea_uros.perf.system import System
from amalthea_uros.services.inputs import open_system
from amalthea_uros.services.paths import StrPath, as_paths

if TYPE_CHECKING:
    from amalthea_uros.metamodel.model import Model

Subject: TypeAlias = "StrPath | Iterable[StrPath] | Model | System"


def system_of(subject: Subject) -> System:
    """The system of files, of an AMALTHEA model, or the given one.

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    """
    if isinstance(subject, System):
        return subject
    from amalthea_uros.metamodel.model import Model

    if isinstance(subject, Model):
        from amalthea_uros.bridge.extract import extract

        return extract(subject).system
    return open_system(as_paths(subject)).system
