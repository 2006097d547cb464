"""What all objects with a name have in common."""

from __future__ import annotations

from dataclasses import dataclass, field

from amalthea_uros.diagnostics import Location


@dataclass(frozen=True, slots=True, kw_only=True)
class Named:
    """An object that others refer to by name.

    Attributes
    ----------
    name : unique among the objects of its kind
    origin : the place in a file that it comes from; two objects may be equal and come from different places
    """

    name: str
    origin: Location | None = field(default=None, compare=False, repr=False)
