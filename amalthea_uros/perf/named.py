"""What objects have in common: a name that others refer to them by, and the place in a file that they come from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any, TypeAlias

from amalthea_uros.diagnostics import Location

#: Finds the place in a file that an activity comes from; there are too many activities to find it for each.
Locate: TypeAlias = Callable[[], Location | None]


@dataclass(frozen=True, slots=True, kw_only=True)
class Located:
    """An object that may come from a file.

    Attributes
    ----------
    origin : the place in a file that it comes from; two objects may be equal and come from different places. When an object is made,
        a `partial` may be given that finds it
    """

    origin: Location | None = field(default=None, compare=False, repr=False)


_origin: Any = Located.__dict__["origin"]


class _LazyOrigin:
    """The origin of an object, for which a function may be given that finds it when it is first asked for."""

    __set__ = _origin.__set__

    def __get__(self, item: Located | None, _owner: type) -> Any:
        if item is None:
            return self
        found = _origin.__get__(item)
        if isinstance(found, partial):
            found = found()
            _origin.__set__(item, found)
        return found


# Most origins are never asked for, and a large model has thousands of objects.
Located.origin = _LazyOrigin()  # type: ignore[assignment, misc]


@dataclass(frozen=True, slots=True, kw_only=True)
class Named(Located):
    """An object that others refer to by name.

    Attributes
    ----------
    name : unique among the objects of its kind
    """

    name: str
