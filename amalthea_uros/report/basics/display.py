"""How the user wants results to be shown on the standard streams: in colour or not, and how much of them."""

from __future__ import annotations

import os
import sys
from contextvars import ContextVar
from enum import StrEnum
from typing import IO

from amalthea_uros._internal.records import dataclass


class Colours(StrEnum):
    """When text is coloured."""

    AUTO = "auto"
    ALWAYS = "always"
    NEVER = "never"


@dataclass(frozen=True, slots=True)
class Display:
    """What the options of the command line say.

    Attributes
    ----------
    is_quiet : only errors and the closing line of a result
    """

    colours: Colours = Colours.AUTO
    is_quiet: bool = False


DISPLAY: ContextVar[Display] = ContextVar("DISPLAY", default=Display())  # noqa: B039 - it is frozen


def is_coloured(stream: IO[str]) -> bool:
    """Whether text for a stream is coloured: as the option says, then the environment, then only on a terminal.

    `NO_COLOR` is that of no-color.org and `FORCE_COLOR` that of force-color.org: set to anything but the empty text. The first one
    has precedence, as in Python itself. Both, and the option, are about the standard streams only: no escapes get into files.
    """
    colours = DISPLAY.get().colours
    if colours is Colours.NEVER:
        return False
    if colours is Colours.ALWAYS:
        return is_standard(stream)
    if os.environ.get("NO_COLOR"):
        return False
    if os.environ.get("FORCE_COLOR") and is_standard(stream):
        return True
    return stream.isatty() and os.environ.get("TERM") != "dumb"


def is_brief(stream: IO[str]) -> bool:
    """Whether a stream gets the closing line of a result only; what is written to a file is always whole."""
    return DISPLAY.get().is_quiet and is_standard(stream)


def is_standard(stream: IO[str]) -> bool:
    """Whether a stream is standard output or standard error."""
    return stream in (sys.stdout, sys.stderr)
