"""Functions that only machine code calls: they become machine code where they are linked.

By itself, numba optimises each function together with all that it calls, and makes machine code of it, whoever calls it. That takes
more than half of the time for the kernel of the simulation, which consists of almost two hundred functions.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import njit, version_info
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.types import unliteral

#: The newest version of numba whose libraries are known here; functions of newer ones are compiled as usual.
_NEWEST = (0, 68)


def linked_part(function: Callable[..., Any]) -> Any:
    """A function for other compiled functions only; it is compiled once, whatever constants it is given."""
    # The types of numba do not know these options, which it uses for its own functions.
    options: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    if version_info.short <= _NEWEST:
        options["pipeline_class"] = _PartCompiler
    part: Any = njit(**options)(function)
    compile_for = part.compile
    part.compile = lambda signature: compile_for(tuple(map(unliteral, signature)))
    return part


class _PartCompiler(CompilerBase):
    """The usual compiler, which fills another library."""

    def define_pipelines(self) -> list[Any]:
        state = self.state
        state.library = _PartLibrary(state.targetctx.codegen(), state.func_id.func_qualname)  # type: ignore[no-untyped-call]
        return [DefaultPassBuilder.define_nopython_pipeline(state)]  # type: ignore[no-untyped-call]


class _PartLibrary(JITCodeLibrary):
    """The code of a function before it is optimised."""

    def finalize(self) -> None:
        """Neither link nor optimise: who calls it does that."""
        self._finalized = True

    @property
    def codegen(self) -> _PartLibrary:
        """Who sets its environment; without code for calls from Python, it has none."""
        return self

    def set_env(self, name: str, environment: object) -> None:
        """Set no environment."""

    def _get_module_for_linking(self) -> Any:
        """Its code with that of all functions it calls, each of them once."""
        if self._shared_module is None:
            for library in self._called({}):
                if library is not self:
                    is_part = isinstance(library, _PartLibrary)
                    code = library._final_module if is_part else library._get_module_for_linking()
                    self._final_module.link_in(code, preserve=True)
        return super()._get_module_for_linking()  # type: ignore[no-untyped-call]

    def _called(self, known: dict[Any, None]) -> dict[Any, None]:
        """The libraries of all functions that it calls, those of their calls included."""
        if self not in known:
            known[self] = None
            for library in self._linking_libraries:
                if isinstance(library, _PartLibrary):
                    library._called(known)
                else:
                    known[library] = None
        return known
