"""The kernel as machine code, where numba is installed (`pip install amuros[fast]`)."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from hashlib import blake2b
from importlib.util import find_spec
from inspect import getsource
from types import FunctionType, ModuleType
from typing import Any, TypeAlias

from amalthea_uros.simulate import layout, operations
from amalthea_uros.simulate.kernel import accounts, activation, budgets, conditions, cores, following, jobs, loop, waiting
from amalthea_uros.simulate.memory import Memory

#: Plays until something needs the driver, as `kernel.loop.play` does.
Play: TypeAlias = Callable[[Memory], int]

_MODULES = (accounts, activation, budgets, conditions, cores, following, jobs, loop, waiting)


def is_available() -> bool:
    """Whether numba is installed."""
    return find_spec("numba") is not None


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
    play.__qualname__ = f"play_{_digest()}"
    signature = "int64(int64[::1])"
    try:
        return _as_play(njit(signature, cache=True)(play))
    except RuntimeError:  # there is no folder in which numba could keep the machine code
        return _as_play(njit(signature)(play))


def _functions(module: ModuleType) -> list[FunctionType]:
    """The functions that a module defines."""
    values = vars(module).values()
    return [value for value in values if isinstance(value, FunctionType) and value.__module__ == module.__name__]


def _is_in(value: object, machine: dict[FunctionType, Any]) -> bool:
    return isinstance(value, FunctionType) and value in machine


def _digest() -> str:
    """Changes with every change of the kernel."""
    sources = "".join(getsource(module) for module in (*_MODULES, layout, operations))
    return blake2b(sources.encode(), digest_size=8).hexdigest()


def _as_play(function: Play) -> Play:
    return function
