"""Hot loops: the same functions as machine code, where numba is installed (`pip install amuros[fast]`).

Loading numba takes a few tenths of a second, which small models would not earn back. So a function runs as Python until it has been
called often.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import update_wrapper
from importlib.util import find_spec
from typing import Generic, ParamSpec, TypeVar, cast

P = ParamSpec("P")
R = TypeVar("R")

#: As many calls take about as long as loading numba.
CALLS_BEFORE = 10_000


class Compiled(Generic[P, R]):
    """A function in the subset of Python that numba knows."""

    def __init__(self, function: Callable[P, R]) -> None:
        update_wrapper(self, function)
        self._function = function
        self._left = CALLS_BEFORE if find_spec("numba") else -1

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        """Call it; the last call as Python compiles it."""
        if self._left >= 0:
            self._left -= 1
            if self._left < 0:
                self.compile()
        return self._function(*args, **kwargs)

    def keep_python(self) -> None:
        """Do not compile it, however often it is called."""
        self._left = -1

    def compile(self) -> None:
        """Make it machine code from now on, if numba is there."""
        if find_spec("numba"):
            from numba import njit

            self._left = -1
            try:
                self._function = cast("Callable[P, R]", njit(cache=True)(self._function))
            except RuntimeError:  # there is no folder in which numba could keep the machine code
                self._function = cast("Callable[P, R]", njit(self._function))


def compiled(function: Callable[P, R]) -> Compiled[P, R]:
    """Have a function compiled once it has been called often."""
    return Compiled(function)
