"""Hot loops: the same functions as machine code, where numba is installed (`pip install amuros[fast]`).

A function runs as Python until that has taken about as long as machine code of it takes to get.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import update_wrapper
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Generic, ParamSpec, TypeVar, cast

from amalthea_uros._internal.machine_code import LOADING, CompilationEffort, is_available

if TYPE_CHECKING:
    from numba.core.types import Type

P = ParamSpec("P")
R = TypeVar("R")

#: About how long numba takes to compile a function of such loops, with what it does before the first one, in seconds.
COMPILING = 2.5


class Compiled(Generic[P, R]):
    """A function in the subset of Python that numba knows.

    Attributes
    ----------
    effort : what it has taken as Python
    is_compiled : whether it is machine code by now, which works on arrays; Python is faster on lists
    """

    def __init__(self, function: Callable[P, R], cost: int) -> None:
        update_wrapper(self, function)
        self._python = self._function = function
        self._cost = cost
        name = function.__name__
        self.effort = CompilationEffort(name, [Path(function.__code__.co_filename)], f"{name}_*", COMPILING)
        #: Seconds as Python after which machine code is considered.
        self._limit = LOADING
        self.is_compiled = False

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        """Call it."""
        if self._limit < inf:
            self.expect(self._cost)
        return self._function(*args, **kwargs)

    def expect(self, microseconds: int) -> None:
        """Count work that is to be done as Python; when all of it together takes longer than compiling, compile."""
        self.effort.spent += microseconds * 1e-6
        if self.effort.spent > self._limit:
            if self.effort.pays_compiling():
                self.effort.report(is_used=True)
                self.compile()
            else:
                self._limit = self.effort.compiling if self._limit < self.effort.compiling else inf

    def compile(self) -> None:
        """Make it machine code from now on, if numba is there."""
        self._limit = inf
        if is_available() and not self.is_compiled:
            self.is_compiled = True
            self._function = self._compiled_call

    def _compiled_call(self, *args: P.args, **kwargs: P.kwargs) -> R:
        """The first call of the machine code, which shows the types of the parameters."""
        from numba import typeof

        self._function = machine_code(self._python, tuple(map(typeof, args)), self.effort.sources)
        return self._function(*args, **kwargs)


def machine_code(function: Callable[P, R], signature: tuple[Type, ...], sources: Sequence[Path]) -> Callable[P, R]:
    """A function as machine code, which numba keeps for the next time where it can.

    Where it cannot, as on a full disk, the machine code is used all the same. What it has kept may be damaged, as after a loss of
    power, or of other types, where two processes kept something at the same time; that is removed, so that it is kept again the next
    time.

    Parameters
    ----------
    signature : the types of the parameters, as numba has them
    sources : the files with its code; a change of one of them is another function
    """
    from hashlib import blake2b

    from numba import njit

    # numba names the new code in its index before the file with it appears, which may be that of the former code until then, or for
    # good (numba.core.caching, IndexDataCacheFile.save). So code of other sources has files of other names.
    digest = blake2b(b"".join(source.read_bytes() for source in sources), digest_size=8).hexdigest()
    function.__qualname__ = f"{function.__name__}_{digest}"
    try:
        machine = njit(cache=True, nogil=True)(function)
    except RuntimeError:  # there is no folder in which numba could keep it
        return cast("Callable[P, R]", njit(nogil=True)(function))
    with suppress(
        Exception
    ):  # damaged files end in any exception; a function that cannot be compiled fails in its first call again
        machine.compile(signature)
    if signature in machine.signatures:
        return cast("Callable[P, R]", machine)
    for index in Path(str(machine.stats.cache_path)).glob(f"*.{function.__qualname__}-*.nbi"):
        with suppress(OSError):
            index.unlink()
    return cast("Callable[P, R]", njit(nogil=True)(function))


def compiled(cost: int) -> Callable[[Callable[P, R]], Compiled[P, R]]:
    """Have a function compiled once it has been used enough.

    Parameters
    ----------
    cost : about how long a call takes as Python, in microseconds; 0 where callers tell by `Compiled.expect`
    """

    def wrap(function: Callable[P, R]) -> Compiled[P, R]:
        return Compiled(function, cost)

    return wrap
