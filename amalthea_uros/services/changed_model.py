"""A changed system, or a proposal for one, as a file: of what was read, only the changed values differ."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from amalthea_uros._internal.files import reading_once
from amalthea_uros._internal.paths import StrPath, has_description_name
from amalthea_uros._internal.plural import counted
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.changes.changed_model import changed_system, update_model
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.description.other_folder import moved
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.services.changed import description_origin
from amalthea_uros.services.files import save_text
from amalthea_uros.services.subject import Subject, SystemInput, as_model, open_system
from amalthea_uros.timing.basics.settings import Settings

if TYPE_CHECKING:
    from amalthea_uros.metamodel.model import Model
    from amalthea_uros.services.optimize import Optimization


@reading_once()
def write_changed(subject: Subject, changes: Sequence[Change], settings: Settings, path: StrPath) -> None:
    """Write the model of a changed system, or an edited description.

    Parameters
    ----------
    subject : files, a model or a system, without the changes
    settings : without the changes; the model does not state them
    path : of a model; of an app.yaml also of a description, in which only the changed values differ

    Raises
    ------
    InvalidArgumentError : the model has several files, the path is not that of a model, or a change cannot be written.
    WriteError : the file cannot be written.
    """
    from amalthea_uros.bridge.extract import extract
    from amalthea_uros.design.model_attributes.editable import ModelSource, ModelTexts
    from amalthea_uros.design.model_attributes.origin import ModelOrigin
    from amalthea_uros.xmi.save import save

    given = as_model(subject)
    opened = None if given is not None else open_system(subject)
    if opened is not None and opened.assembly is not None:
        _write_edited(opened, changes, settings, path)
        return
    if has_description_name(path):
        raise InvalidArgumentError(
            f"{path}: a changed system is written as an AMALTHEA model, not as a description; give a file with the suffix .amxmi"
        )
    model = given if opened is None else opened.model
    if model is None:
        from amalthea_uros.bridge.build import build_model

        assert opened is not None
        save(build_model(changed_system(opened.system, changes, settings)), path)
        return
    if len(model.documents) > 1:
        number = counted(len(model.documents), "file")
        raise InvalidArgumentError(
            f"the model has {number}, but the changed model is written to one file; change the values in the files"
        )
    if given is None:
        _refuse_migrated(model)
    else:
        model = ModelTexts.of(model).read()  # the caller keeps the model without the changes
    origin = ModelOrigin(Configuration(extract(model).system, settings), ModelSource(model, is_own=True))
    divided = origin.divided(changes)
    with origin.editable.edited(divided.attributes):
        if divided.others or not changes:
            update_model(model, divided.others, settings)
        save(model, path)


def _write_edited(opened: SystemInput, changes: Sequence[Change], settings: Settings, path: StrPath) -> None:
    """Write an edited description, or the model that is built from it."""
    from amalthea_uros.bridge.build import build_model
    from amalthea_uros.xmi.save import save

    origin = description_origin(opened, settings)
    if has_description_name(path):
        save_text(path, moved(origin.edited(changes), origin.path, Path(path)))
        return
    edited, assumed = origin.rebuilt(changes)
    save(build_model(changed_system(edited, assumed, settings)), path)


def _refuse_migrated(model: Model) -> None:
    """Refuse a model that was converted while it was read: more than the changed values would differ."""
    from amalthea_uros.metamodel.versions import spelled

    for document in model.documents:
        if document.migrated_from is not None:
            raise InvalidArgumentError(
                f"{document.path}: a model of {spelled(document.migrated_from)} is not written with other values; "
                f"migrate it first: amuros migrate {document.path}"
            )


def write_proposal(result: Optimization, number: int, path: StrPath) -> None:
    """Write an app.yaml or the model of a proposal.

    Parameters
    ----------
    number : of the proposal, from 1

    Raises
    ------
    InvalidArgumentError : there is no such proposal, or a change cannot be written.
    WriteError : the file cannot be written.
    """
    if number > len(result.proposals):
        found = f"only {len(result.proposals)} were found" if result.proposals else "none was found"
        raise InvalidArgumentError(f"there is no proposal {number} to write to {path}: {found}")
    write_changed(result.subject, result.proposals[number - 1].changes, result.settings, path)
