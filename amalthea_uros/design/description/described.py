"""The text of an `app.yaml` with all that it describes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from amalthea_uros._internal.paths import folder_of
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.platforms import complete
from amalthea_uros.spec.read import text_draft
from amalthea_uros.uros.assemble import Assembly, assemble


@dataclass(frozen=True, slots=True)
class Described:
    """A description, and what it means.

    Attributes
    ----------
    platform : the name of the hardware in execution times; None if it has none
    core_types : by core
    """

    description: Description
    assembly: Assembly
    platform: str | None
    core_types: Mapping[str, str]


def described(text: str, path: Path) -> Described:
    """What a text describes.

    Parameters
    ----------
    path : the file of the text, for findings, and for the files that it names

    Raises
    ------
    ReadError : something in it is wrong.
    """
    draft = text_draft(path, text, Description)
    if draft.section is None or draft.findings:
        raise ReadError(draft.findings)
    whole, platform, findings = complete(draft.section, folder_of(path))
    if findings:
        raise ReadError(findings)
    assembly = assemble(whole, whole.hardware, platform)
    types = {name: core.type or "" for name, core in assembly.system.cores.items()}
    return Described(draft.section, assembly, platform, types)
