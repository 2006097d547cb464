"""When machine code pays: numba takes a moment to be loaded, and long to compile a function, which it does once and keeps."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from importlib.util import find_spec
from os import environ
from os.path import expanduser
from pathlib import Path

from amalthea_uros._internal.records import dataclass

#: About how long it takes to load numba and what it has kept, in seconds.
LOADING = 0.5


#: What numba reads in the working folder (numba.core.config): it can name a folder with machine code, which would be executed.
_SETTINGS = ".numba_config.yaml"


def is_available() -> bool:
    """Whether numba is installed (`pip install amuros[fast]`), and no settings in the working folder say what it executes."""
    return find_spec("numba") is not None and not Path(_SETTINGS).exists()


@dataclass(slots=True)
class CompilationEffort:
    """What a function takes as Python, and what compiling it would take.

    Attributes
    ----------
    name : of the function, for people
    sources : the files with its code, the one that numba knows first
    function : the name under which numba keeps its machine code, as a pattern
    compiling : about how many seconds numba takes to compile it for the first time
    spent : seconds of processor time that it has taken as Python in this process
    reported : whether machine code was used when that was logged last
    """

    name: str
    sources: Sequence[Path]
    function: str
    compiling: float
    spent: float = 0.0
    reported: bool | None = None

    def pays_compiling(self, left: float = 0.0) -> bool:
        """Whether to go on with machine code.

        Parameters
        ----------
        left : seconds that are left as Python; what has taken some time is expected to take as much again
        """
        expected = max(self.spent, left)
        return expected > LOADING and is_available() and expected > (LOADING if self.is_kept() else self.compiling)

    def is_kept(self) -> bool:
        """Whether numba has kept the machine code, as far as that can be seen without loading numba."""
        newest = max(source.stat().st_mtime for source in self.sources)
        pattern = f"{self.sources[0].stem}.{self.function}-*.nbi"
        found = (path for folder in self._folders() for path in (*folder.glob(pattern), *folder.glob(f"*/{pattern}")))
        return any(path.stat().st_mtime >= newest for path in found)

    def _folders(self) -> Iterator[Path]:
        """Where numba keeps machine code: in a folder of choice, else beside the source, else in the cache of the user."""
        if chosen := environ.get("NUMBA_CACHE_DIR"):
            yield Path(chosen)
            return
        yield self.sources[0].parent / "__pycache__"
        for cache in (environ.get("XDG_CACHE_HOME") or "~/.cache", "~/Library/Caches"):
            yield Path(expanduser(cache), "numba")  # noqa: PTH111 - Path.expanduser fails for a user without a home

    def report(self, *, is_used: bool, left: float = 0.0) -> None:
        """Log whether machine code is used, and why; once, as long as it remains so."""
        # Nobody can listen before somebody has loaded it, which takes a few milliseconds.
        if "logging" not in sys.modules or self.reported == is_used:
            return
        self.reported = is_used
        import logging

        if Path(_SETTINGS).exists():
            why = f"numba would follow {_SETTINGS} in the working folder"
        elif not is_available():
            why = "numba is not installed (pip install amuros[fast])"
        elif self.is_kept():
            why = "compiled by an earlier run"
        else:
            why = f"compiling takes about {self.compiling:g} s"
        how = "used" if is_used else "not used"
        text = f"machine code of {self.name}: {how}, {max(self.spent, left):.1f} s as Python, {why}"
        logging.getLogger("amalthea_uros").info(text)
