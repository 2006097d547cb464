"""A changed system as an AMALTHEA model: of a model that was read, only the changed values differ."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from amalthea_uros._internal.paths import StrPath, is_description
from amalthea_uros._internal.plural import counted
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.changes.changed_model import changed_system, update_model
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.services.subject import Subject, paths_of, system_of
from amalthea_uros.timing.basics.settings import Settings

if TYPE_CHECKING:
    from amalthea_uros.metamodel.model import Model


def write_changed(subject: Subject, changes: Sequence[Change], settings: Settings, path: StrPath) -> None:
    """Write the model of a changed system.

    Parameters
    ----------
    subject : files, a model or a system, without the changes
    settings : without the changes; the model does not state them

    Raises
    ------
    InvalidArgumentError : the model has several files, the path is not that of a model, or a change cannot be written.
    WriteError : the file cannot be written.
    """
    from amalthea_uros.bridge.build import build_model
    from amalthea_uros.xmi.save import save

    if is_description(path):
        advice = "give a file with the suffix .amxmi, or change the values in the description itself"
        raise InvalidArgumentError(f"{path}: a changed system is written as an AMALTHEA model, not as a description; {advice}")
    model = _read(subject)
    if model is None:
        model = build_model(changed_system(system_of(subject), changes, settings))
    else:
        update_model(model, changes, settings)
    save(model, path)


def _read(subject: Subject) -> Model | None:
    """The AMALTHEA model of a subject, which may be changed; None for descriptions and systems."""
    from amalthea_uros.metamodel.model import Model
    from amalthea_uros.xmi.load import load
    from amalthea_uros.xmi.save import save

    if isinstance(subject, Model):
        _refuse_several(subject)
        # The caller keeps the model without the changes.
        with TemporaryDirectory() as folder:
            copy = Path(folder, "model.amxmi")
            save(subject, copy)
            return load(copy)
    paths = paths_of(subject)
    if paths is None or (len(paths) == 1 and is_description(paths[0])):
        return None
    model = load(*paths)
    _refuse_several(model)
    _refuse_migrated(model)
    return model


def _refuse_several(model: Model) -> None:
    if len(model.documents) > 1:
        number = counted(len(model.documents), "file")
        raise InvalidArgumentError(
            f"the model has {number}, but the changed model is written to one file; change the values in the files"
        )


def _refuse_migrated(model: Model) -> None:
    """Refuse a model that was converted while it was read: more than the changed values would differ."""
    from amalthea_uros.metamodel.versions import spelled

    for document in model.documents:
        if document.migrated_from is not None:
            raise InvalidArgumentError(
                f"{document.path}: a model of {spelled(document.migrated_from)} is not written with other values; "
                f"migrate it first: amuros migrate {document.path}"
            )
