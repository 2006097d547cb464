"""The entry of amuros as the importer of AMALTHEA models in the settings of chronSUITE.

On Linux these are a file of Qt's QSettings (am2inc, Options.cpp: organisation INCHRON, application ModelImporter): sections with keys
and values; a backslash separates the groups of a key.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from string import hexdigits

from amalthea_uros._internal.files import FileError, is_file, read_text
from amalthea_uros._internal.limits import SETTINGS_SIZE
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import InvalidArgumentError, WriteError
from amalthea_uros.inchron.facts import VERSION
from amalthea_uros.services.files import save_new

_SECTION, _GROUP = "[ModelImporter]", "AmaltheaImporter\\"
#: Files for output, the first input and the others are inserted there.
_ARGUMENTS = "export --importer -o %t %f %F"


def settings_file() -> Path:
    """Where chronSUITE has its importers.

    Raises
    ------
    InvalidArgumentError : the settings are no file here.
    """
    if sys.platform != "linux":
        what = f"the command line 'amuros' and the arguments '{_ARGUMENTS}'"
        raise InvalidArgumentError(
            f"the settings of chronSUITE are a file on Linux only; configure an importer there with {what}"
        )
    home = os.environ.get("XDG_CONFIG_HOME")
    return (Path(home) if home else Path.home() / ".config") / "INCHRON" / "ModelImporter.conf"


def register(command: Path) -> Path:
    """Make amuros the importer of AMALTHEA models, in place of any other one; returns the file of the settings.

    Parameters
    ----------
    command : the file of the program

    Raises
    ------
    InvalidArgumentError : the settings are no file here.
    WriteError : the file cannot be read or written.
    """
    path = settings_file()
    try:
        before = read_text(path, SETTINGS_SIZE).splitlines() if is_file(path) else []
    except FileError as error:
        message = f"the settings cannot be changed: {error.reason}"
        raise WriteError([Finding("XMI101", Severity.ERROR, message, Location(path), error.advice)]) from None
    save_new({path: "\n".join([*_with_entry(before, _entry(command)), ""])}, force=True)
    return path


def _entry(command: Path) -> list[str]:
    values = {
        "commandline": str(command),
        "arguments": _ARGUMENTS,
        "filter": "AMALTHEA Model (*.amxmi)",
        "CurrentVersion": f"{VERSION}000",
    }
    if command.name == "__main__.py":  # python -m amalthea_uros
        values |= {"commandline": sys.executable, "arguments": f"-m amalthea_uros {_ARGUMENTS}"}
    return [f"{_GROUP}{key}={_quoted(value)}" for key, value in values.items()]


def _quoted(value: str) -> str:
    """A text as QSettings writes it: characters beyond ASCII as their numbers, which end before what is no hexadecimal digit."""
    result = ""
    is_after_number = False
    for each in value:
        is_after_number = not " " <= each <= "~" or (is_after_number and each in hexdigits)
        result += f"\\x{ord(each):x}" if is_after_number else f"\\{each}" if each in '\\"' else each
    return f'"{result}"'


def _with_entry(lines: list[str], entry: list[str]) -> list[str]:
    """The lines with an entry in its section, in place of the one of the same group."""
    result: list[str] = []
    section = ""
    for line in lines:
        section = line.strip() if line.startswith("[") else section
        if section != _SECTION or not line.startswith(_GROUP):
            result.append(line)
    if _SECTION not in result:
        result += [_SECTION]
    place = result.index(_SECTION) + 1
    return [*result[:place], *entry, *result[place:]]
