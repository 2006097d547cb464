"""Which code processes of amuros import: never that of the working folder, which may have come from anybody.

Python looks for modules in the working folder first in a process that it starts with `-c` or `-m`, and `multiprocessing` starts all of
its processes with `-c`. `-P` prevents that, and so does an environment variable (docs.python.org, "Command line and environment").
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress

_VARIABLE = "PYTHONSAFEPATH"
#: Of a checkout, the package itself is in the working folder.
_HOME = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))  # noqa: PTH100, PTH120 - imported first of all


def forget_working_folder() -> None:
    """Import nothing from the working folder from now on; for programs, whose files are not there."""
    with suppress(OSError):  # the folder is gone, and so has no modules
        here = os.path.realpath(os.curdir)
        if here != os.path.realpath(_HOME):
            sys.path[:] = [folder for folder in sys.path if os.path.realpath(folder) != here]


def own_command(words: Sequence[str]) -> list[str]:
    """The command `amuros` with some words, as a process that imports from the same folders as this one."""
    program = (
        f"import sys; sys.path[:] = {sys.path!r}; sys.argv[0] = 'amuros'; from amalthea_uros.cli.process import run; run()"
    )
    return [sys.executable, "-P", "-c", program, *words]


@contextmanager
def safe_start() -> Iterator[None]:
    """Have processes that are started meanwhile import nothing from the working folder."""
    former = os.environ.get(_VARIABLE)
    os.environ[_VARIABLE] = "1"
    try:
        yield
    finally:
        if former is None:
            os.environ.pop(_VARIABLE, None)
        else:
            os.environ[_VARIABLE] = former


def can_start_safely() -> bool:
    """Whether processes of `multiprocessing` can be kept from the working folder: they ignore the environment as this one does."""
    return bool(sys.flags.safe_path or not sys.flags.ignore_environment)
