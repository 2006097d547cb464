"""Objects that installed packages bring by entry points, such as rules and methods."""

from __future__ import annotations

from collections.abc import Iterator
from types import ModuleType
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

T = TypeVar("T")


def installed(group: str) -> list[EntryPoint]:
    """The entry points of a group, in the order of their names."""
    from importlib.metadata import entry_points

    return sorted(entry_points(group=group))


def package_of(entry: EntryPoint) -> str:
    """The name of the package that has an entry point."""
    return entry.dist.name if entry.dist is not None else entry.value


def instances_in(source: object, kind: type[T], listed: str) -> Iterator[T]:
    """The instances of a class in a module, in a list, or a single one.

    Parameters
    ----------
    listed : the name of the list in a module that has the instances; without it, those of the whole module

    Raises
    ------
    TypeError : there is none, or something else is in the list.
    """
    if isinstance(source, kind):
        yield source
        return
    if isinstance(source, ModuleType):
        named = (value for value in vars(source).values() if isinstance(value, kind))
        source = getattr(source, listed, None) or list(dict.fromkeys(named))
    if not isinstance(source, list | tuple) or not source:
        raise TypeError(f"there is no {kind.__name__}, and no list {listed} of some")
    for each in source:
        if not isinstance(each, kind):
            raise TypeError(f"{listed} must contain instances of {kind.__name__}, not {type(each).__name__}")
        yield each
