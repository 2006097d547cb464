"""Two models compared by meaning."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from amalthea_uros.difference.comparison import Change, difference
from amalthea_uros.metamodel.model import Model
from amalthea_uros.services.paths import StrPath
from amalthea_uros.xmi.load import load


@dataclass(frozen=True, slots=True, kw_only=True)
class DiffResult:
    """The differences of two models.

    Attributes
    ----------
    old, new : the paths that were compared, or those of the documents of a model
    """

    old: str
    new: str
    changes: tuple[Change, ...]


def diff(old: Model | StrPath, new: Model | StrPath) -> DiffResult:
    """Compare two models, or the files or folders that hold them.

    Raises
    ------
    ReadError : a file cannot be read.
    """
    changes = difference(*(one if isinstance(one, Model) else load(one) for one in (old, new)))
    return DiffResult(old=_name(old), new=_name(new), changes=tuple(changes))


def _name(model: Model | StrPath) -> str:
    if isinstance(model, Model):
        return " ".join(str(document.path or "unsaved") for document in model.documents)
    return str(Path(model))
