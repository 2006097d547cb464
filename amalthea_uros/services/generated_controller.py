"""The controller that files for a build are generated for: that of a description, or one of the controllers of a robot."""

from __future__ import annotations

from pathlib import Path

from amalthea_uros._internal.paths import folder_of
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.services.build import describe
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.platforms import complete
from amalthea_uros.spec.read import read_description
from amalthea_uros.uros.assemble import Assembly, assemble
from amalthea_uros.uros.described import described_section
from amalthea_uros.uros.middleware.options import OptionRole
from amalthea_uros.uros.profiles import profile_of

#: Findings about sizes, which the files set.
SOLVED = ("UR120", "UR127")


def described_controller(path: Path, platform: str | None, controller: str | None) -> Assembly:
    """The system of a controller; pools that are too small are no obstacle, as the files are to set others."""
    description, folder = _controller(path, controller)
    try:
        return describe(path, platform) if controller is None else described_section(description, folder, platform).assembly
    except ReadError as error:
        if any(finding.severity is Severity.ERROR and finding.rule not in SOLVED for finding in error.findings):
            raise
    whole, name, *_ = complete(description, folder, platform)
    middleware = whole.middleware
    sizes = [row.name for row in profile_of(middleware).option_table.values() if row.role is not OptionRole.SETTING]
    limits = middleware.limits.model_copy(update=dict.fromkeys(name for name in sizes if middleware.limits.states(name)))
    whole = whole.model_copy(update={"middleware": middleware.model_copy(update={"limits": limits})})
    return assemble(whole, whole.hardware, name)


def _controller(path: Path, name: str | None) -> tuple[Description, Path]:
    """The description of the controller of a file, or of one of several ones, and the folder that its files are relative to.

    Raises
    ------
    ReadError : the file cannot be read, or it has several controllers, and the name is not that of one of them.
    """
    description = read_description(path)
    section = next((each for each in description.controllers if each.name == name), None)
    if section is None and not description.controllers and name is None:
        return description, folder_of(path)
    if section is None:
        names = ", ".join(each.name for each in description.controllers)
        what = "several controllers" if name is None else f"no controller {name!r}"
        advice = (
            f"Choose one with --controller: {names}." if names else "Leave --controller out: the file describes one controller."
        )
        raise ReadError([Finding("GEN012", Severity.ERROR, f"the description has {what}", Location(path), advice)])
    if section.file is not None:
        return _controller(folder_of(path) / section.file, None)
    return Description.of_controller(section), folder_of(path)
