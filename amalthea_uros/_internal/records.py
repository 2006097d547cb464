"""Dataclasses whose methods are made when they are first needed.

`dataclasses.dataclass` compiles up to six functions for each class, which takes ten times as long as everything else about it, and a
short command imports five hundred classes. Here `__init__` is compiled when the first object is made, and the other methods are
closures. Otherwise these are dataclasses like others: with `fields`, `replace`, `copy`, `pickle` and `inspect.signature`.
"""

from __future__ import annotations

import dataclasses
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import MISSING, Field
from operator import attrgetter
from reprlib import recursive_repr
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dataclasses import dataclass as dataclass
    from dataclasses import field as field
    from dataclasses import fields as fields
    from dataclasses import replace as replace
else:
    field, fields, replace = dataclasses.field, dataclasses.fields, dataclasses.replace

    def dataclass(cls: Any = None, /, **options: bool) -> Any:
        """As `dataclasses.dataclass`, with the options `frozen`, `slots`, `kw_only`, `eq`, `repr` and `order`."""
        if cls is None:
            return lambda each: dataclass(each, **options)
        # Classes whose objects have an order are few.
        return dataclasses.dataclass(**options)(cls) if options.get("order") else _record(cls, **options)


def _record(cls: Any, *, frozen: bool = False, slots: bool = False, kw_only: bool = False, **shown: bool) -> Any:
    with _thawed(cls):
        made: Any = dataclasses.dataclass(init=False, repr=False, eq=False, slots=slots, kw_only=kw_only)(cls)
    kept = {"init": True, "repr": True, "eq": True, "frozen": frozen} | shown
    for name, method in _methods(made, **kept).items():
        if name not in made.__dict__:
            setattr(made, name, method)
    for name, value in kept.items():
        setattr(made.__dataclass_params__, name, value)
    return made


def _methods(made: Any, **kept: bool) -> dict[str, Any]:
    """The methods of a class, which it gets unless it has its own."""
    every = dataclasses.fields(made)
    names = [each.name for each in every]
    methods: dict[str, Any] = {"__init__": _Constructor(made, frozen=kept["frozen"])}
    if kept["repr"]:
        methods["__repr__"] = _text_of([each.name for each in every if each.repr])
    if kept["eq"]:
        methods["__eq__"] = _equality_of(_values([each.name for each in every if each.compare]))
        if made.__dict__.get("__hash__") is None:
            # Not a method that it has: a class that has only an __eq__ of its own has None as its __hash__ by that.
            hashed = [each.name for each in every if (each.compare if each.hash is None else each.hash)]
            made.__hash__ = _hash_of(_values(hashed)) if kept["frozen"] else None
    if kept["frozen"]:
        methods |= _frozen(made, names)
        methods |= _state(names) if "__slots__" in made.__dict__ else {}
    return methods


@contextmanager
def _thawed(cls: Any) -> Iterator[None]:
    """Have the dataclasses that a class is derived from look as if they were not frozen, for `dataclasses` to accept both together."""
    every = [base.__dict__["__dataclass_params__"] for base in cls.__mro__[1:] if "__dataclass_params__" in base.__dict__]
    former = [each.frozen for each in every]
    for each in every:
        each.frozen = False
    try:
        yield
    finally:
        for each, frozen in zip(every, former, strict=True):
            each.frozen = frozen


class _Constructor:
    """In the place of an `__init__` until somebody asks for it."""

    __slots__ = ("_frozen", "_owner")

    def __init__(self, owner: Any, *, frozen: bool) -> None:
        self._owner, self._frozen = owner, frozen

    def __get__(self, instance: object, kind: type | None = None) -> Any:
        # Another thread may have been faster.
        if self._owner.__dict__["__init__"] is self:
            self._owner.__init__ = self._made()
        return self._owner.__dict__["__init__"].__get__(instance, kind)

    def _made(self) -> Any:
        owner, every = self._owner, dataclasses.fields(self._owner)
        scope = {"_object": object, "_factory": _FACTORY}
        for each in every:
            scope |= {f"_default_{each.name}": each.default, f"_make_{each.name}": each.default_factory}
        given = [_parameter(each) for each in every if each.init and not each.kw_only]
        named = [_parameter(each) for each in every if each.init and each.kw_only]
        lines = [_assignment(each, frozen=self._frozen) for each in every if _is_assigned(each, owner)]
        lines += ["self.__post_init__()"] if hasattr(owner, "__post_init__") else []
        head = ", ".join(["self", *given, *(["*", *named] if named else [])])
        text = f"def make({', '.join(scope)}):\n def __init__({head}):\n  {'; '.join(lines) or 'pass'}\n return __init__"
        made: dict[str, Any] = {}
        exec(text, getattr(sys.modules.get(owner.__module__), "__dict__", {}), made)
        function = made["make"](**scope)
        function.__qualname__ = f"{owner.__qualname__}.__init__"
        function.__annotations__ = {each.name: each.type for each in every if each.init} | {"return": None}
        return function


class _Factory:
    """The default of a parameter whose value is made."""

    def __repr__(self) -> str:
        return "<factory>"


_FACTORY = _Factory()


def _parameter(one: Field[Any]) -> str:
    if one.default is not MISSING:
        return f"{one.name}=_default_{one.name}"
    return one.name if one.default_factory is MISSING else f"{one.name}=_factory"


def _is_assigned(one: Field[Any], owner: Any) -> bool:
    """Whether the constructor gives a value to a field; without slots, a default is in the class."""
    return one.init or one.default_factory is not MISSING or (one.default is not MISSING and "__slots__" in owner.__dict__)


def _assignment(one: Field[Any], *, frozen: bool) -> str:
    name = one.name
    made = f"_make_{name}()" if one.default_factory is not MISSING else f"_default_{name}"
    value = made if not one.init else name if one.default_factory is MISSING else f"{made} if {name} is _factory else {name}"
    return f'_object.__setattr__(self, "{name}", {value})' if frozen else f"self.{name} = {value}"


def _values(names: Sequence[str]) -> Callable[[Any], tuple[Any, ...]]:
    """A function that returns some attributes of an object."""
    if len(names) > 1:
        return attrgetter(*names)
    return lambda each: tuple([getattr(each, name) for name in names])


def _text_of(names: Sequence[str]) -> Callable[[Any], str]:
    @recursive_repr()
    def text(self: Any) -> str:
        return f"{type(self).__qualname__}({', '.join([f'{name}={getattr(self, name)!r}' for name in names])})"

    return text


def _equality_of(values: Callable[[Any], tuple[Any, ...]]) -> Callable[[Any, object], Any]:
    def is_equal(self: Any, other: object) -> Any:
        return values(self) == values(other) if other.__class__ is self.__class__ else NotImplemented

    return is_equal


def _hash_of(values: Callable[[Any], tuple[Any, ...]]) -> Callable[[Any], int]:
    def hashed(self: Any) -> int:
        return hash(values(self))

    return hashed


def _frozen(owner: Any, names: Sequence[str]) -> dict[str, Any]:
    """The methods of a class whose objects do not change."""

    def refuse(self: Any, name: str, value: object) -> None:
        if type(self) is owner or name in names:
            raise dataclasses.FrozenInstanceError(f"cannot assign to field {name!r}")
        super(owner, self).__setattr__(name, value)

    def refuse_to_delete(self: Any, name: str) -> None:
        if type(self) is owner or name in names:
            raise dataclasses.FrozenInstanceError(f"cannot delete field {name!r}")
        super(owner, self).__delattr__(name)

    return {"__setattr__": refuse, "__delattr__": refuse_to_delete}


def _state(names: Sequence[str]) -> dict[str, Any]:
    """The methods by which frozen objects with slots are copied and pickled, of which the attributes would be set otherwise."""

    def state(self: Any) -> list[Any]:
        return [getattr(self, name) for name in names]

    def restore(self: Any, state: Sequence[Any]) -> None:
        for name, value in zip(names, state, strict=True):
            object.__setattr__(self, name, value)

    return {"__getstate__": state, "__setstate__": restore}
