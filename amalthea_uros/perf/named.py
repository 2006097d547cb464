"""What objects have in common: a name that others refer to them by, and the place in a file that they come from."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from reprlib import Repr
from typing import Any, TypeAlias

from amalthea_uros._internal.records import dataclass, field, fields
from amalthea_uros.diagnostics import Location

#: Finds the place in a file that an activity comes from; there are too many activities to find it for each.
Locate: TypeAlias = Callable[[], Location | None]


_SHORT = Repr()
_SHORT.maxlevel, _SHORT.maxtuple, _SHORT.maxstring, _SHORT.maxother = 2, 3, 60, 60


class Brief:
    """An object with a short text for debuggers and notebooks: its name, and the beginnings of the values that are not defaults."""

    __slots__ = ()

    def __init_subclass__(cls, **arguments: Any) -> None:
        super().__init_subclass__(**arguments)
        # Otherwise each dataclass gets a text of everything in it, which for a system are thousands of lines.
        cls.__repr__ = Brief.__repr__  # type: ignore[method-assign]

    def __repr__(self) -> str:
        own: Any = self
        values = ((each, getattr(self, each.name)) for each in fields(own) if each.repr and each.name != "name")
        stated = [f"{each.name}={_SHORT.repr(value)}" for each, value in values if value != each.default and value != ()]
        name = f"{type(self).__name__} {getattr(self, 'name', '')}".rstrip()
        return f"<{', '.join((name, *stated))}>"


@dataclass(frozen=True, slots=True, kw_only=True)
class Located(Brief):
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
