"""A description with all that it describes."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from amalthea_uros._internal.paths import TEXT, folder_of
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.description import Description, RobotController
from amalthea_uros.spec.known_files import named_file
from amalthea_uros.spec.platforms import complete
from amalthea_uros.spec.read import Draft, content_draft, description_text, text_draft
from amalthea_uros.uros.assemble import Assembly, assemble
from amalthea_uros.uros.transports.can import ForeignFrame


@dataclass(frozen=True, slots=True)
class Described:
    """A description, and what it means.

    Attributes
    ----------
    platform : the name of the hardware in execution times; None if it has none
    core_types : by core
    whole : the description, completed by its platform and its operating system
    controllers : of a robot, by name
    """

    description: Description
    assembly: Assembly
    platform: str | None
    core_types: Mapping[str, str]
    whole: Description
    controllers: Mapping[str, Described] = field(default_factory=dict)


def describe_file(file: Path, platform: str | None = None) -> Described:
    """What the description in a file describes.

    Parameters
    ----------
    platform : replaces the platform that the file names

    Raises
    ------
    ReadError : the file cannot be read, or something in it is wrong; carries a finding for each mistake.
    """
    text = description_text(file)
    # Files that the text names, such as that of a platform, can have changed since the same text was read.
    describe_text.cache_clear()
    if platform is None:
        return describe_text(text, file)
    return _described(text_draft(file, text, Description), folder_of(file), platform)


@lru_cache(maxsize=32)
def describe_text(text: str, path: Path = TEXT) -> Described:
    """What the text of a description describes; searches and edits ask for the same texts again.

    Parameters
    ----------
    path : the file of the text, for findings, and for the files that it names; without it, these are relative to the current folder

    Raises
    ------
    ReadError : something in it is wrong; carries a finding for each mistake.
    """
    return _described(text_draft(path, text, Description), folder_of(path))


def describe_content(content: Mapping[str, Any]) -> Described:
    """What the content of a description describes, which may come from any program; raises as `describe_text`."""
    return _described(content_draft(content, Description), Path())


def _described(draft: Draft[Description], folder: Path, platform: str | None = None, *, is_part: bool = False) -> Described:
    """What a draft describes, unless something in it is wrong."""
    try:
        if draft.section is None:
            raise ReadError(draft.findings)
        found = described_section(draft.section, folder, platform, is_part=is_part)
    except ReadError as error:
        raise ReadError(draft.with_more(error.findings)) from None
    if draft.findings:
        raise ReadError(draft.findings)
    return found


def described_section(
    description: Description, folder: Path, platform: str | None = None, *, is_part: bool = False
) -> Described:
    """The meaning of a description that was read before.

    Parameters
    ----------
    folder : what the files that it names are relative to
    platform : replaces the platform that it names
    is_part : whether it describes a controller of a robot, to which others send messages

    Raises
    ------
    ReadError : something in it is wrong; carries a finding for each mistake.
    """
    if description.controllers and platform is not None:
        message, advice = (
            "the robot has several controllers, each with a platform of its own",
            "Change 'hardware' of one of them.",
        )
        raise ReadError([Finding("APP003", Severity.ERROR, message, description.location("controllers"), advice)])
    if description.controllers:
        return _robot(description, folder)
    whole, name, findings, assumptions = complete(description, folder, platform)
    try:
        assembly = assemble(whole, whole.hardware, name, database_frames(whole, folder), assumptions, is_part=is_part)
    except ReadError as error:
        raise ReadError([*findings, *error.findings]) from None
    if findings:
        raise ReadError(findings)
    types = {core: each.type or "" for core, each in assembly.system.cores.items()}
    return Described(description, assembly, name, types, whole)


def _robot(description: Description, folder: Path) -> Described:
    """A robot with several controllers."""
    from amalthea_uros.uros.robot import assemble_robot

    controllers = {each.name: _controller(each, folder) for each in description.controllers}
    assembly = assemble_robot(description, {name: each.assembly for name, each in controllers.items()})
    types = {core: each.type or "" for core, each in assembly.system.cores.items()}
    sections = [
        each
        if each.file is not None
        else each.model_copy({key: getattr(controllers[each.name].whole, key) for key in _COMPLETED})
        for each in description.controllers
    ]
    whole = description.model_copy({"controllers": sections})
    return Described(description, assembly, None, types, whole, controllers)


#: The sections that a platform and an operating system complete.
_COMPLETED = ("hardware", "os", "middleware")


def _controller(section: RobotController, folder: Path) -> Described:
    """A controller of a robot, described in its file or in that of the robot."""
    if section.file is None:
        return described_section(Description.of_controller(section), folder, is_part=True)
    place = section.location("file")
    path = named_file("file of a controller", section.file, folder, place)
    draft = text_draft(path, description_text(path), Description)
    if draft.section is not None and draft.section.controllers:
        message = f"{str(path)!r} describes a robot of several controllers, not one of them"
        raise ReadError([Finding("APP003", Severity.ERROR, message, place, "Name the files of its controllers instead.")])
    return _described(draft, folder_of(path), is_part=True)


def database_frames(description: Description, folder: Path) -> tuple[ForeignFrame, ...]:
    """The foreign frames of the DBC file that a description names; none without one.

    Parameters
    ----------
    folder : what the path of the file is relative to

    Raises
    ------
    ReadError : there is no such file, or it is not a DBC file.
    InvalidArgumentError : cantools is not installed.
    """
    transport = description.middleware.transport
    bus = transport.can or transport.can_fd
    if bus is None or bus.dbc is None:
        return ()
    stated = bus.location("dbc")
    path = named_file("DBC file", bus.dbc, folder, stated)
    from amalthea_uros.uros.transports.database import frames_of

    return frames_of(path, stated)
