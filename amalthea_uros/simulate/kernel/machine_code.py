"""The kernel as machine code, where numba is installed (`pip install amuros[fast]`)."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import cache
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from types import FunctionType, ModuleType
from typing import Any, TypeAlias

from amalthea_uros._internal.compiled import machine_code
from amalthea_uros._internal.machine_code import LOADING, CompilationEffort
from amalthea_uros.simulate import kernel
from amalthea_uros.simulate.kernel import layout, loop
from amalthea_uros.simulate.kernel.layout import Memory
from amalthea_uros.simulate.kernel.loop import run_kernel

#: Runs until something needs the driver, as `kernel.loop.run_kernel` does.
CompiledKernel: TypeAlias = Callable[[Memory], int]

#: All modules of the kernel but the layout of its memory, which has no functions of it, and this one.
_MODULES = tuple(
    import_module(f"{kernel.__name__}.{module.name}")
    for module in iter_modules(kernel.__path__)
    if module.name not in ("layout", "machine_code")
)

#: Seconds after which the speed of a run is known, and about how long numba takes to compile the kernel.
_KNOWN, _COMPILING = 0.2, 9.0


@cache
def effort() -> CompilationEffort:
    """What the kernel has taken as Python in this process: the runs of a campaign count together."""
    sources = [Path(str(module.__file__)) for module in (sys.modules[__name__], *_MODULES, layout)]
    return CompilationEffort("the simulation", sources, "run_*", _COMPILING)


def is_worth_it(seconds: float, seconds_left: float) -> bool:
    """Whether to continue with machine code, after some seconds of a run as Python and with an estimated rest."""
    if compiled.cache_info().currsize:
        return True
    return seconds >= _KNOWN and seconds_left > LOADING and effort().pays_compiling(seconds_left)


@cache
def compiled() -> CompiledKernel:
    """The kernel as machine code, which numba keeps for the next time; its memory must be an array of int64."""
    from numba import int64

    from amalthea_uros._internal.linked_parts import linked_part

    namespaces = {module: dict(vars(module)) for module in _MODULES}
    machine = {
        function: linked_part(FunctionType(function.__code__, namespaces[module], function.__name__))
        for module in _MODULES
        for function in _functions(module)
    }
    for namespace in namespaces.values():
        namespace.update({name: machine[value] for name, value in namespace.items() if _is_in(value, machine)})
    names = {"__name__": __name__, "run_kernel": namespaces[loop]["run_kernel"], "_numbers_of": _address()}
    # numba knows the file of this function, by which it names what it keeps.
    run = FunctionType(_run.__code__, names, "run")
    return machine_code(run, (int64[::1],), effort().sources)


def _run(memory: Memory) -> int:
    return run_kernel(_numbers_of(memory))


def _numbers_of(memory: Memory) -> Memory:
    """The numbers of a memory; for machine code, `_address` stands for it."""
    return memory


def _address() -> Any:
    """The function that gives machine code the numbers of an array by their address.

    An array is seven arguments in each call, and each use of it looks whether a place counts from the end, which none does: with the
    address alone the kernel takes a quarter of the time.
    """
    from numba import types
    from numba.extending import intrinsic

    @intrinsic
    def address(_context: Any, memory: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return context.make_array(signature.args[0])(context, builder, arguments[0]).data

        return types.CPointer(memory.dtype)(memory), generate  # type: ignore[no-untyped-call]

    return address


def _functions(module: ModuleType) -> list[FunctionType]:
    """The functions that a module defines."""
    values = vars(module).values()
    return [value for value in values if isinstance(value, FunctionType) and value.__module__ == module.__name__]


def _is_in(value: object, machine: dict[FunctionType, Any]) -> bool:
    return isinstance(value, FunctionType) and value in machine
