"""The controller that files for a build are generated for: that of a description, or one of the controllers of a robot."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from amalthea_uros._internal.files import reading_once
from amalthea_uros._internal.paths import folder_of
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.services.build import describe
from amalthea_uros.services.waiting_messages import waiting_messages
from amalthea_uros.spec.description import Description, RobotController
from amalthea_uros.spec.known_files import named_file
from amalthea_uros.spec.platforms import complete
from amalthea_uros.spec.read import read_description
from amalthea_uros.uros.assemble import Assembly, assemble
from amalthea_uros.uros.described import described_section
from amalthea_uros.uros.generated_options import WaitingMessages
from amalthea_uros.uros.middleware.options import OptionRole
from amalthea_uros.uros.profiles import profile_of
from amalthea_uros.uros.robot import assemble_robot

#: Findings about sizes, which the files set.
SOLVED = ("UR120", "UR127")


class GeneratedController(NamedTuple):
    """A controller that files are generated for, and the messages that can wait there; None if nothing limits these."""

    assembly: Assembly
    waiting: WaitingMessages | None


@reading_once()
def generated_controller(path: Path, platform: str | None, name: str | None) -> GeneratedController:
    """The controller of a description; of a robot, one of them, with the messages that the others send it.

    Parameters
    ----------
    platform : replaces the platform that the file names
    name : of one of the controllers of a robot; None if the description has one controller

    Raises
    ------
    ReadError : a file cannot be read, something in it is wrong, or it has several controllers, and the name is not that of one of them.
    """
    description, folder = read_description(path), folder_of(path)
    if name is None and not description.controllers:
        assembly = _with_free_pools(lambda: describe(path, platform), description, folder, platform)
        return GeneratedController(assembly, waiting_messages(assembly))
    _check_name(name, description, path)
    if platform is not None:
        describe(path, platform)  # which refuses it
    parts = {each.name: _part(each, folder) for each in description.controllers}
    robot, own = assemble_robot(description, parts), name or ""
    return GeneratedController(parts[own], waiting_messages(parts[own], analyze_system(robot.system), own))


def _part(section: RobotController, folder: Path) -> Assembly:
    description = Description.of_controller(section)
    if section.file is not None:
        path = named_file("file of a controller", section.file, folder, section.location("file"))
        description, folder = read_description(path), folder_of(path)
    return _with_free_pools(lambda: described_section(description, folder).assembly, description, folder, None)


def _with_free_pools(
    described: Callable[[], Assembly], description: Description, folder: Path, platform: str | None
) -> Assembly:
    """The system of a description; pools that are too small are no obstacle, as the files are to set others."""
    try:
        return described()
    except ReadError as error:
        if any(finding.severity is Severity.ERROR and finding.rule not in SOLVED for finding in error.findings):
            raise
    whole, name, *_ = complete(description, folder, platform)
    middleware = whole.middleware
    sizes = [row.name for row in profile_of(middleware).option_table.values() if row.role is not OptionRole.SETTING]
    limits = middleware.limits.model_copy(update=dict.fromkeys(name for name in sizes if middleware.limits.states(name)))
    whole = whole.model_copy(update={"middleware": middleware.model_copy(update={"limits": limits})})
    return assemble(whole, whole.hardware, name)


def _check_name(name: str | None, description: Description, path: Path) -> None:
    """Refuse a description of several controllers without the name of one of them, and a name that none has."""
    names = [each.name for each in description.controllers]
    if name in names:
        return
    what = "several controllers" if name is None else f"no controller {name!r}"
    advice = (
        f"Choose one with --controller: {', '.join(names)}."
        if names
        else "Leave --controller out: the file describes one controller."
    )
    raise ReadError([Finding("GEN012", Severity.ERROR, f"the description has {what}", Location(path), advice)])
