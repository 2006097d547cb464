"""Frozen dataclasses whose methods are compiled when they are first used.

The standard library compiles seven methods of a frozen dataclass, one by one, when its module is imported. For the few hundred classes
of values that takes a third of a short run, which makes objects of half of them, and compares or prints few. Everything else is the
work of the standard library: fields, slots, patterns, `replace`, `asdict`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from dataclasses import MISSING, Field, FrozenInstanceError, fields, is_dataclass
from dataclasses import dataclass as complete_dataclass
from reprlib import recursive_repr
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dataclasses import dataclass as dataclass
else:

    def dataclass(defined: type | None = None, /, *, frozen: bool = False, **options: bool) -> Any:
        """As in the standard library, with its options, except for `InitVar`."""
        if not frozen or not options.keys() <= {"slots", "kw_only"}:
            return complete_dataclass(defined, frozen=frozen, **options)
        return lambda defined: _frozen(defined, options)


def _frozen(defined: type, options: dict[str, bool]) -> Any:
    own = {name for name, value in vars(defined).items() if value is not None}  # __hash__ is None beside an own __eq__
    made = _without_methods(defined, options)
    for name in _SOURCES.keys() - own:
        setattr(made, name, _Method(made, name))
    made.__setattr__, made.__delattr__ = _refusing(made)
    if options.get("slots"):
        made.__getstate__, made.__setstate__ = _state, _set_state
    return made


def _without_methods(defined: type, options: dict[str, bool]) -> Any:
    """Have the standard library do all but the methods; it would compile some for a frozen class, and for that looks at its bases."""
    bases = [vars(base)["__dataclass_params__"] for base in defined.__mro__[1:] if is_dataclass(base)]
    for params in bases:
        params.frozen = False
    made: Any = complete_dataclass(init=False, repr=False, eq=False, **options)(defined)
    for params in (*bases, made.__dataclass_params__):
        params.frozen = True
    return made


def _refusing(owner: Any) -> tuple[Callable[[Any, str, object], None], Callable[[Any, str], None]]:
    """`__setattr__` and `__delattr__` of a frozen class; a subclass may have attributes of its own."""
    names = {field.name for field in fields(owner)}

    def __setattr__(self: Any, name: str, value: object) -> None:  # noqa: N807
        if type(self) is owner or name in names:
            raise FrozenInstanceError(f"cannot assign to field {name!r}")
        super(owner, self).__setattr__(name, value)

    def __delattr__(self: Any, name: str) -> None:  # noqa: N807
        if type(self) is owner or name in names:
            raise FrozenInstanceError(f"cannot delete field {name!r}")
        super(owner, self).__delattr__(name)

    return __setattr__, __delattr__


def _state(self: Any) -> list[Any]:
    """For pickles, which would set the attributes."""
    return [getattr(self, field.name) for field in fields(self)]


def _set_state(self: Any, state: Iterable[Any]) -> None:
    for field, value in zip(fields(self), state, strict=True):
        object.__setattr__(self, field.name, value)


class _Method:
    """Stands for a method of a class until it is looked up, which compiles it."""

    def __init__(self, owner: type, name: str) -> None:
        self.owner, self.name = owner, name

    def __get__(self, instance: object, of: type | None = None) -> Any:
        method = _compiled(self.owner, self.name)
        setattr(self.owner, self.name, method)
        return method.__get__(instance, of)


class _Factory:
    """The default of parameters whose value a factory makes."""

    def __repr__(self) -> str:
        return "<factory>"


_FACTORY = _Factory()


def _compiled(owner: type, name: str) -> Any:
    own = fields(owner)
    given: dict[str, Any] = {"_set": object.__setattr__, "_factory": _FACTORY}
    for field in own:
        given[f"_default_{field.name}"] = field.default if field.default is not MISSING else field.default_factory
    body = _SOURCES[name](own, hasattr(owner, "__post_init__")).replace("\n", "\n    ")
    made: dict[str, Any] = {}
    # Annotations are resolved in the module of the class.
    exec(f"def make({', '.join(given)}):\n    {body}\n    return {name}", vars(sys.modules[owner.__module__]), made)
    method = made["make"](**given)
    method.__qualname__, method.__module__ = f"{owner.__qualname__}.{name}", owner.__module__
    if name == "__init__":
        method.__annotations__ = {**{field.name: field.type for field in own if field.init}, "return": None}
    return recursive_repr()(method) if name == "__repr__" else method


def _init(own: Iterable[Field[Any]], has_post_init: bool) -> str:
    lines = [f"    _set(self, {field.name!r}, {value})" for field in own if (value := _initial(field))]
    if has_post_init:
        lines.append("    self.__post_init__()")
    anywhere = [_parameter(field) for field in own if field.init and not field.kw_only]
    by_name = [_parameter(field) for field in own if field.init and field.kw_only]
    parameters = ["self", *anywhere, *(["*", *by_name] if by_name else [])]
    return f"def __init__({', '.join(parameters)}):\n" + "\n".join(lines or ["    pass"])


def _parameter(field: Field[Any]) -> str:
    if field.default is not MISSING:
        return f"{field.name}=_default_{field.name}"
    return field.name if field.default_factory is MISSING else f"{field.name}=_factory"


def _initial(field: Field[Any]) -> str:
    """The value of a field in `__init__`, "" if something else gives it one."""
    default = f"_default_{field.name}"
    if field.default_factory is not MISSING:
        return f"{default}() if {field.name} is _factory else {field.name}" if field.init else f"{default}()"
    if field.init:
        return field.name
    return default if field.default is not MISSING else ""


def _repr(own: Iterable[Field[Any]], _has_post_init: bool) -> str:
    shown = ", ".join(f"{field.name}={{self.{field.name}!r}}" for field in own if field.repr)
    return f'def __repr__(self):\n    return f"{{self.__class__.__qualname__}}({shown})"'


def _eq(own: Iterable[Field[Any]], _has_post_init: bool) -> str:
    compared = [field.name for field in own if field.compare]
    return (
        "def __eq__(self, other):\n"
        "    if other.__class__ is not self.__class__:\n"
        "        return NotImplemented\n"
        f"    return {_values('self', compared)} == {_values('other', compared)}"
    )


def _hash(own: Iterable[Field[Any]], _has_post_init: bool) -> str:
    hashed = [field.name for field in own if (field.compare if field.hash is None else field.hash)]
    return f"def __hash__(self):\n    return hash({_values('self', hashed)})"


def _values(of: str, names: Iterable[str]) -> str:
    return f"({''.join(f'{of}.{name},' for name in names)})"


_SOURCES: dict[str, Callable[[Iterable[Field[Any]], bool], str]] = {
    "__init__": _init,
    "__repr__": _repr,
    "__eq__": _eq,
    "__hash__": _hash,
}
