"""A proposal as a file."""

from __future__ import annotations

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.services.changed_model import write_changed
from amalthea_uros.services.optimize import Optimization
from amalthea_uros.services.paths import StrPath


def write_proposal(result: Optimization, number: int, path: StrPath) -> None:
    """Write the model of a proposal; of a model that was read, only the changed values differ.

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
