"""A proposal as a file: the description with its comments and layout, or the model, with the proposed values."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from amalthea_uros._internal.paths import StrPath, is_description
from amalthea_uros.design.changes.change import Change
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.services.changed_model import write_changed
from amalthea_uros.services.optimize import Optimization


def write_proposal(result: Optimization, number: int, path: StrPath) -> None:
    """Write an app.yaml or the model of a proposal; only the changed values differ from what was read.

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
    proposal = result.proposals[number - 1]
    if is_description(path):
        _write_description(result.paths, proposal.changes, path)
    elif proposal.rebuilt is not None:
        write_changed(proposal.rebuilt, proposal.value_changes, result.settings, path)
    else:
        write_changed(result.subject, proposal.changes, result.settings, path)


def _write_description(paths: Sequence[Path], changes: Sequence[Change], path: StrPath) -> None:
    """Write the description that was read with changes."""
    from amalthea_uros._internal.files import read_text
    from amalthea_uros._internal.limits import DESCRIPTION_SIZE
    from amalthea_uros.design.description.edit import edit_description
    from amalthea_uros.xmi.emf.files import FileText, write_text

    if len(paths) != 1 or not is_description(paths[0]):
        raise InvalidArgumentError(
            f"{path}: only a proposal for an app.yaml is written as one; give a file with the suffix .amxmi"
        )
    text = read_text(paths[0], DESCRIPTION_SIZE)
    write_text(Path(path), FileText(edit_description(text, paths[0], changes).text))
