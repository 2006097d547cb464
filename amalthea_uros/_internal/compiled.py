"""Hot loops: the same functions as machine code, where numba is installed (`pip install amuros[fast]`).

Loading numba takes a few tenths of a second, which small models would not earn back. So a function runs as Python until that has
taken about as long.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import update_wrapper
from importlib.util import find_spec
from typing import Generic, ParamSpec, TypeVar, cast

P = ParamSpec("P")
R = TypeVar("R")

#: About how long it takes to load numba, in microseconds.
LOADING = 400_000


class Compiled(Generic[P, R]):
    """A function in the subset of Python that numba knows.

    Attributes
    ----------
    is_compiled : whether it is machine code by now, which works on arrays; Python is faster on lists
    """

    def __init__(self, function: Callable[P, R], cost: int) -> None:
        update_wrapper(self, function)
        self._function = function
        self._cost = cost
        self._left = LOADING if find_spec("numba") else None
        self.is_compiled = False

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        """Call it."""
        if self._left is not None:
            self.expect(self._cost)
        return self._function(*args, **kwargs)

    def expect(self, microseconds: int) -> None:
        """Count work that is to be done as Python; when all of it together takes longer than loading numba, compile."""
        if self._left is not None:
            self._left -= microseconds
            if self._left < 0:
                self.compile()

    def keep_python(self) -> None:
        """Do not compile it, however much there is to do."""
        self._left = None

    def compile(self) -> None:
        """Make it machine code from now on, if numba is there."""
        self._left = None
        if find_spec("numba") and not self.is_compiled:
            from numba import njit

            try:
                self._function = cast("Callable[P, R]", njit(cache=True)(self._function))
            except RuntimeError:  # there is no folder in which numba could keep the machine code
                self._function = cast("Callable[P, R]", njit(self._function))
            self.is_compiled = True


def compiled(cost: int) -> Callable[[Callable[P, R]], Compiled[P, R]]:
    """Have a function compiled once it has been used enough.

    Parameters
    ----------
    cost : about how long a call takes as Python, in microseconds; 0 where callers tell by `Compiled.expect`
    """

    def wrap(function: Callable[P, R]) -> Compiled[P, R]:
        return Compiled(function, cost)

    return wrap
