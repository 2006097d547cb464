"""Dataclasses of which everything is made when it is first needed.

`dataclasses.dataclass` compiles up to six functions for each class and examines its fields, which takes ten times as long as everything
else about it, and a short command imports five hundred classes. Here a class has its slots at once; its methods, and what the module
`dataclasses` knows of it, are made when somebody asks for them. Otherwise these are dataclasses like others: with `fields`, `replace`,
`copy`, `pickle` and `inspect.signature`; only a class without a docstring has none.
"""

from __future__ import annotations

import dataclasses
import operator
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import MISSING, Field
from functools import cache, partial
from operator import attrgetter
from reprlib import recursive_repr
from types import CodeType, FunctionType
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from dataclasses import dataclass as dataclass
    from dataclasses import field as field
    from dataclasses import fields as fields
    from dataclasses import replace as replace
else:
    field, fields = dataclasses.field, dataclasses.fields

    def replace(one: Any, /, **changes: Any) -> Any:
        """As `dataclasses.replace`, which examines all fields for each object anew."""
        names, values = _parameters_of(type(one))
        return type(one)(**(dict(zip(names, values(one), strict=True)) | changes))

    def dataclass(cls: Any = None, /, **options: bool) -> Any:
        """As `dataclasses.dataclass`, with the options `frozen`, `slots`, `kw_only`, `eq`, `repr` and `order`."""
        return (lambda each: _record(each, **options)) if cls is None else _record(cls, **options)


def _record(cls: Any, *, frozen: bool = False, slots: bool = False, kw_only: bool = False, **shown: bool) -> Any:
    kinds = {name: kind for name, kind in cls.__annotations__.items() if not _is_of_class(kind)}
    given = {name: cls.__dict__[name] for name in kinds if name in cls.__dict__}
    blueprint = _Blueprint(kinds, given, kw_only, frozen, shown)
    makers = _makers(slots, frozen, **shown)
    members: dict[str, _Later | None] = {name: _Later(name, make, blueprint) for name, make in makers.items()}
    if shown.get("eq", True) and not frozen:
        members["__hash__"] = None
    blueprint.owner = (_with_slots if slots else _without_slots)(cls, blueprint, members)
    return blueprint.owner


def _is_of_class(kind: Any) -> bool:
    """Whether an annotation is that of a variable of the class, which is no field."""
    return str(kind).startswith(("ClassVar", "typing.ClassVar"))


#: By this mark `dataclasses` knows a field from a variable of the class.
_FIELD = dataclasses._FIELD  # type: ignore[attr-defined]


class _Blueprint:
    """What is known of a class before anything of it is made.

    Attributes
    ----------
    owner : the class
    kinds : annotations of its fields, without those that it inherits
    given : their defaults, and what `field` returned
    shown : the other options
    """

    __slots__ = ("frozen", "given", "kinds", "kw_only", "owner", "shown")

    def __init__(
        self, kinds: Mapping[str, Any], given: Mapping[str, Any], kw_only: bool, frozen: bool, shown: Mapping[str, bool]
    ) -> None:
        self.owner: Any = None
        self.kinds, self.given, self.kw_only, self.frozen, self.shown = kinds, given, kw_only, frozen, shown

    def in_order(self) -> dict[str, Field[Any]]:
        """All fields of the class: first those that it inherits."""
        every: dict[str, Field[Any]] = {}
        for base in self.owner.__mro__[-1:0:-1]:
            every |= getattr(base, "__dataclass_fields__", {})
        return every | {name: self._field(name) for name in self.kinds}

    def _field(self, name: str) -> Any:
        value = self.given.get(name, MISSING)
        made: Any = value if isinstance(value, Field) else field(default=value)
        made.name, made.type = name, self.kinds[name]
        made.kw_only = self.kw_only if made.kw_only is MISSING else made.kw_only
        made._field_type = _FIELD
        return made


def _with_slots(cls: Any, blueprint: _Blueprint, members: Mapping[str, _Later | None]) -> Any:
    """The class again, because slots cannot be added to one."""
    inherited = {name for base in cls.__mro__[1:-1] for name in base.__dict__.get("__slots__", ())}
    kept = {name: value for name, value in cls.__dict__.items() if name not in blueprint.kinds and name not in _OF_EACH_OBJECT}
    slots = tuple([name for name in blueprint.kinds if name not in inherited])
    made = type(cls)(cls.__name__, cls.__bases__, {**kept, **_open(members, cls), "__slots__": slots})
    made.__qualname__ = cls.__qualname__
    return made


#: What a class without slots has, and one with slots has not.
_OF_EACH_OBJECT = ("__dict__", "__weakref__")


def _without_slots(cls: Any, blueprint: _Blueprint, members: Mapping[str, _Later | None]) -> Any:
    """The class, which keeps the defaults as its attributes."""
    for name, value in blueprint.given.items():
        if isinstance(value, Field):
            if value.default is MISSING:
                delattr(cls, name)
            else:
                setattr(cls, name, value.default)
    for name, member in _open(members, cls).items():
        setattr(cls, name, member)
    return cls


def _open(members: Mapping[str, _Later | None], cls: Any) -> Mapping[str, _Later | None]:
    """Those that a class has not itself; one that has only an `__eq__` of its own has None as its `__hash__` by that."""
    own = cls.__dict__
    return {name: each for name, each in members.items() if own.get(name) is None}


class _Later:
    """In the place of an attribute of a class until somebody asks for it."""

    __slots__ = ("_blueprint", "_make", "_name")

    def __init__(self, name: str, make: _Maker, blueprint: _Blueprint) -> None:
        self._name, self._make, self._blueprint = name, make, blueprint

    def __get__(self, instance: object, kind: type | None = None) -> Any:
        owner, name = self._blueprint.owner, self._name
        # Another thread may have been faster.
        if owner.__dict__[name] is self:
            setattr(owner, name, self._make(self._blueprint))
        made = owner.__dict__[name]
        return made.__get__(instance, kind) if hasattr(made, "__get__") else made


#: Makes an attribute.
_Maker: TypeAlias = Callable[[_Blueprint], Any]


@cache
def _makers(slots: bool, frozen: bool, **shown: bool) -> Mapping[str, _Maker]:
    """The attributes of classes with some options, and what makes each of them."""
    makers: dict[str, _Maker] = {
        "__dataclass_fields__": _Blueprint.in_order,
        "__dataclass_params__": _parameters,
        "__match_args__": _positional,
        "__init__": _constructor,
    }
    if shown.get("repr", True):
        makers["__repr__"] = _text
    if shown.get("eq", True):
        makers |= {"__eq__": _equality} | ({"__hash__": _hash} if frozen else {})
    if shown.get("order"):
        makers |= {name: partial(_comparison, compare) for name, compare in _COMPARISONS.items()}
    if frozen:
        makers |= {method: partial(_refusal, method, refused) for method, refused in _REFUSALS.items()}
        makers |= {"__getstate__": _state, "__setstate__": _restoration} if slots else {}
    return makers


def _parameters(blueprint: _Blueprint) -> Any:
    """The options as `dataclasses` keeps them."""
    of_python: Any = dataclasses.dataclass(frozen=blueprint.frozen, **blueprint.shown)(type("_", (), {"__doc__": "_"}))
    return of_python.__dataclass_params__


def _positional(blueprint: _Blueprint) -> tuple[str, ...]:
    return tuple([each.name for each in dataclasses.fields(blueprint.owner) if each.init and not each.kw_only])


@cache
def _parameters_of(kind: Any) -> tuple[Sequence[str], Callable[[Any], tuple[Any, ...]]]:
    """The names of what a constructor takes, and a function that returns their values."""
    names = [each.name for each in dataclasses.fields(kind) if each.init]
    return names, _values(names)


def _constructor(blueprint: _Blueprint) -> Any:
    owner, frozen = blueprint.owner, blueprint.frozen
    every = [each for each in dataclasses.fields(owner) if each.init]
    given = [each for each in every if not each.kw_only]
    named = [each for each in every if each.kw_only]
    others = [each for each in dataclasses.fields(owner) if not each.init]
    places = {f"_{number}": each for number, each in enumerate([*given, *named, *others])}
    scope = {"__name__": owner.__module__, "_set": object.__setattr__, "_factory": _FACTORY}
    scope |= {f"_set{place}": _setter(each, owner) for place, each in places.items()} if frozen else {}
    lines = [_assignment(each, place, scope, frozen=frozen) for place, each in places.items() if _is_assigned(each, owner)]
    lines += ["self.__post_init__()"] if hasattr(owner, "__post_init__") else []
    head = ", ".join(["self", *[place for place, each in places.items() if each.init]])
    code = _template(f"def __init__({head}): {'; '.join(lines) or 'pass'}")
    names = {place: each.name for place, each in places.items()}
    function: Any = FunctionType(_adapted(code, names, len(given), len(named)), scope)
    function.__defaults__ = tuple(_defaults(given).values())
    function.__kwdefaults__ = _defaults(named)
    function.__qualname__ = f"{owner.__qualname__}.__init__"
    function.__annotations__ = {each.name: each.type for each in every} | {"return": None}
    return function


@cache
def _template(source: str) -> CodeType:
    """The code of a constructor with numbers for names: to compile one takes long, and many classes differ in their names only."""
    scope: dict[str, Any] = {}
    exec(source, scope)
    code: CodeType = scope["__init__"].__code__
    return code


def _adapted(code: CodeType, names: Mapping[str, str], given: int, named: int) -> CodeType:
    """The code with the names of its parameters and of the attributes that it sets, some of which are only given by name."""

    def own(words: tuple[Any, ...]) -> tuple[Any, ...]:
        return tuple([names.get(each, each) for each in words])

    return code.replace(
        co_argcount=1 + given,
        co_kwonlyargcount=named,
        co_varnames=own(code.co_varnames),
        co_names=own(code.co_names),
        co_consts=own(code.co_consts),
    )


def _defaults(parameters: Iterable[Field[Any]]) -> dict[str, Any]:
    """The defaults of those parameters that have one."""
    values = {each.name: each.default if each.default_factory is MISSING else _FACTORY for each in parameters}
    return {name: value for name, value in values.items() if value is not MISSING}


class _Factory:
    """The default of a parameter whose value is made."""

    def __repr__(self) -> str:
        return "<factory>"


_FACTORY = _Factory()


def _is_assigned(one: Field[Any], owner: Any) -> bool:
    """Whether the constructor gives a value to a field; without slots, a default is in the class."""
    return one.init or one.default_factory is not MISSING or (one.default is not MISSING and "__slots__" in owner.__dict__)


def _assignment(one: Field[Any], place: str, scope: dict[str, Any], *, frozen: bool) -> str:
    """A statement of a constructor, with a place instead of the name; what it refers to is added to its scope."""
    value = place
    if one.default_factory is not MISSING:
        scope[f"_make{place}"] = one.default_factory
        value = f"_make{place}() if {place} is _factory else {place}" if one.init else f"_make{place}()"
    elif not one.init:
        scope[f"_default{place}"] = one.default
        value = f"_default{place}"
    if not frozen:
        return f"self.{place} = {value}"
    return f'_set(self, "{place}", {value})' if scope[f"_set{place}"] is None else f"_set{place}(self, {value})"


def _setter(one: Field[Any], owner: Any) -> Any:
    """The setter of the slot of a field, which need not look for it by its name; None without a slot."""
    return getattr(getattr(owner, one.name, None), "__set__", None)


def _values(names: Sequence[str]) -> Callable[[Any], tuple[Any, ...]]:
    """A function that returns some attributes of an object."""
    if len(names) > 1:
        return attrgetter(*names)
    return lambda each: tuple([getattr(each, name) for name in names])


def _text(blueprint: _Blueprint) -> Callable[[Any], str]:
    names = [each.name for each in dataclasses.fields(blueprint.owner) if each.repr]

    @recursive_repr()
    def text(self: Any) -> str:
        return f"{type(self).__qualname__}({', '.join([f'{name}={getattr(self, name)!r}' for name in names])})"

    return text


def _equality(blueprint: _Blueprint) -> Callable[[Any, object], Any]:
    values = _values([each.name for each in dataclasses.fields(blueprint.owner) if each.compare])

    def is_equal(self: Any, other: object) -> Any:
        return values(self) == values(other) if other.__class__ is self.__class__ else NotImplemented

    return is_equal


_COMPARISONS = {"__lt__": operator.lt, "__le__": operator.le, "__gt__": operator.gt, "__ge__": operator.ge}


def _comparison(compare: Callable[[Any, Any], bool], blueprint: _Blueprint) -> Callable[[Any, object], Any]:
    """A method by which objects have the order of their values."""
    values = _values([each.name for each in dataclasses.fields(blueprint.owner) if each.compare])

    def compares(self: Any, other: object) -> Any:
        return compare(values(self), values(other)) if other.__class__ is self.__class__ else NotImplemented

    return compares


def _hash(blueprint: _Blueprint) -> Callable[[Any], int]:
    fields_of_owner = dataclasses.fields(blueprint.owner)
    values = _values([each.name for each in fields_of_owner if (each.compare if each.hash is None else each.hash)])

    def hashed(self: Any) -> int:
        return hash(values(self))

    return hashed


#: The methods by which objects cannot be changed, and what they refuse to do.
_REFUSALS = {"__setattr__": "assign to", "__delattr__": "delete"}


def _refusal(method: str, refused: str, blueprint: _Blueprint) -> Callable[..., None]:
    owner, names = blueprint.owner, [each.name for each in dataclasses.fields(blueprint.owner)]

    def refuse(self: Any, name: str, *value: object) -> None:
        if type(self) is owner or name in names:
            raise dataclasses.FrozenInstanceError(f"cannot {refused} field {name!r}")
        getattr(super(owner, self), method)(name, *value)

    return refuse


def _state(blueprint: _Blueprint) -> Callable[[Any], list[Any]]:
    """The method by which frozen objects with slots are copied and pickled, together with the next one."""
    names = [each.name for each in dataclasses.fields(blueprint.owner)]

    def state(self: Any) -> list[Any]:
        return [getattr(self, name) for name in names]

    return state


def _restoration(blueprint: _Blueprint) -> Callable[[Any, Sequence[Any]], None]:
    names = [each.name for each in dataclasses.fields(blueprint.owner)]

    def restore(self: Any, state: Sequence[Any]) -> None:
        for name, value in zip(names, state, strict=True):
            object.__setattr__(self, name, value)

    return restore
