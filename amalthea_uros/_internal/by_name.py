"""Results in their order that are also found by their names."""

from __future__ import annotations

from typing import Protocol, SupportsIndex, TypeVar, overload

from amalthea_uros._internal.shown import Shown
from amalthea_uros._internal.similar import did_you_mean


class HasName(Protocol):
    """An object with a name."""

    @property
    def name(self) -> str:
        """The name."""


N = TypeVar("N", bound=HasName)

#: So many names are listed.
_NAMES = 10


class Results(tuple[N, ...], Shown):
    """Results in their order, also found by name: `results["Task_5ms"]`."""

    __slots__ = ()

    @overload
    def __getitem__(self, key: SupportsIndex | str) -> N: ...
    @overload
    def __getitem__(self, key: slice) -> tuple[N, ...]: ...
    def __getitem__(self, key: SupportsIndex | str | slice) -> N | tuple[N, ...]:
        """The result with a name, or at an index.

        Raises
        ------
        KeyError : there is no such result; the text lists similar names.
        """
        if not isinstance(key, str):
            return super().__getitem__(key)
        found = next((result for result in self if result.name == key), None)
        if found is None:
            advice = did_you_mean(key, self.names) or f"known: {', '.join(self.names) or 'none'}"
            raise KeyError(f"no result named {key!r}; {advice}")
        return found

    def __repr__(self) -> str:
        names = ", ".join(self.names[:_NAMES])
        more = f", and {len(self) - _NAMES} more" if len(self) > _NAMES else ""
        return f"<Results: {names or 'none'}{more}>"

    @property
    def names(self) -> tuple[str, ...]:
        """The names, in order."""
        return tuple(result.name for result in self)
