"""What objects have in common: a name that others refer to them by, and the place in a file that they come from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeAlias

from amalthea_uros.diagnostics import Location

#: Finds the place in a file that an activity comes from; there are too many activities to find it for each.
Locate: TypeAlias = Callable[[], Location | None]


@dataclass(frozen=True, slots=True, kw_only=True)
class Located:
    """An object that may come from a file.

    Attributes
    ----------
    origin : the place in a file that it comes from; two objects may be equal and come from different places
    """

    origin: Location | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Named(Located):
    """An object that others refer to by name.

    Attributes
    ----------
    name : unique among the objects of its kind
    """

    name: str
