"""Commands in this process, with the guarantees that all of them give."""

from __future__ import annotations

import re
import sys
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import NamedTuple
from unittest.mock import patch

from amalthea_uros.cli.main import main

#: What acts on a terminal (ECMA-48, sections 5.2 and 5.3), or on the order of the text (Unicode Standard Annex 9, section 2).
_HIDDEN = re.compile("[\x00-\x09\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")
#: What GitHub and Azure Pipelines take for a command.
_COMMAND = re.compile(r"^\s*::|##\[|##vso\[", re.MULTILINE)


class InvariantError(Exception):
    """Something that must hold does not."""


class Ended(NamedTuple):
    """How a command ended."""

    code: object
    out: str
    err: str


def require(holds: bool, message: str) -> None:
    """Fail unless something holds."""
    if not holds:
        raise InvariantError(message)


def run(*arguments: str | Path, is_raw: bool = False) -> Ended:
    """A command in this process; with the guarantees that all commands give.

    Parameters
    ----------
    is_raw : whether standard output has the characters of files as they are, for other programs
    """
    out, err = StringIO(), StringIO()
    code: object = 0
    with patch.object(sys, "argv", ["amuros", *map(str, arguments)]), redirect_stdout(out), redirect_stderr(err):
        try:
            main()
        except SystemExit as end:
            code = end.code or 0
    ended = Ended(code, out.getvalue(), err.getvalue())
    require(code in (0, 1, 2), f"exit code {code}")
    require(code != 2 or bool(ended.err.strip() or ended.out.strip()), "exit code 2 without a message")
    shown = ended.err if is_raw else ended.out + ended.err
    require_visible(shown)
    found = _COMMAND.search(shown)
    require(not found, f"a runner takes a line for a command: {found}")
    return ended


def require_visible(text: str) -> None:
    """Fail if a text has characters that act on a terminal."""
    found = _HIDDEN.search(text)
    require(not found, f"a hidden character in the output: {found}")
