"""The kernel as machine code, where numba is installed (`pip install amuros[fast]`)."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import cache
from hashlib import blake2b
from importlib.util import find_spec
from inspect import getsource
from os import environ
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any, TypeAlias

from amalthea_uros.simulate import layout, operations
from amalthea_uros.simulate.kernel import (
    accounts,
    activation,
    budgets,
    conditions,
    cores,
    following,
    jobs,
    loop,
    waiting,
    watching,
)
from amalthea_uros.simulate.memory import Memory

#: Plays until something needs the driver, as `kernel.loop.play` does.
Play: TypeAlias = Callable[[Memory], int]

_MODULES = (accounts, activation, budgets, conditions, cores, following, jobs, loop, waiting, watching)


#: Seconds after which the speed of a run is known; to load machine code, with numba itself; and of a run that is worth making it.
_KNOWN, _LOADING, _WORTH_MAKING = 0.2, 1.0, 5.0


def is_available() -> bool:
    """Whether numba is installed."""
    return find_spec("numba") is not None


def is_worth_it(seconds: float, seconds_left: float) -> bool:
    """Whether to go on with machine code, after some seconds interpreted and with an estimated rest.

    Making it takes about 20 seconds, but only once: numba keeps it.
    """
    if compiled.cache_info().currsize:
        return True
    if seconds < _KNOWN or seconds_left < _LOADING or not is_available():
        return False
    return seconds_left > _WORTH_MAKING or _is_kept()


def _is_kept() -> bool:
    """Whether numba has kept the machine code, as far as that can be seen without loading numba."""
    folders = [Path(loop.__file__).parent / "__pycache__"]
    if chosen := environ.get("NUMBA_CACHE_DIR"):
        folders.append(Path(chosen))
    return any(next(folder.glob(f"**/loop.{_name()}-*.nbi"), None) for folder in folders)


@cache
def compiled() -> Play:
    """The kernel as machine code, which numba keeps for the next time; its memory must be an array of int64."""
    from numba import njit

    namespaces = {module: dict(vars(module)) for module in _MODULES}
    machine = {
        function: njit(FunctionType(function.__code__, namespaces[module], function.__name__))
        for module in _MODULES
        for function in _functions(module)
        if function is not loop.play
    }
    for namespace in namespaces.values():
        namespace.update({name: machine[value] for name, value in namespace.items() if _is_in(value, machine)})
    play = FunctionType(loop.play.__code__, namespaces[loop], "play")
    # numba looks at the file of this function only, to see whether its machine code is out of date.
    play.__qualname__ = _name()
    signature = "int64(int64[::1])"
    try:
        return _as_play(njit(signature, cache=True, nogil=True)(play))
    except RuntimeError:  # there is no folder in which numba could keep the machine code
        return _as_play(njit(signature, nogil=True)(play))


def _functions(module: ModuleType) -> list[FunctionType]:
    """The functions that a module defines."""
    values = vars(module).values()
    return [value for value in values if isinstance(value, FunctionType) and value.__module__ == module.__name__]


def _is_in(value: object, machine: dict[FunctionType, Any]) -> bool:
    return isinstance(value, FunctionType) and value in machine


@cache
def _name() -> str:
    """A name that changes with every change of the kernel."""
    sources = "".join(getsource(module) for module in (*_MODULES, layout, operations, sys.modules[__name__]))
    return f"play_{blake2b(sources.encode(), digest_size=8).hexdigest()}"


def _as_play(function: Play) -> Play:
    return function
