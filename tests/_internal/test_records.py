"""Dataclasses whose methods are made when they are needed are dataclasses like those of Python."""

import copy
import dataclasses
import inspect
import pickle
from dataclasses import FrozenInstanceError, field
from typing import ClassVar

import pytest

from amalthea_uros._internal.records import dataclass

FORMS = [
    {"frozen": True, "slots": True},
    {"slots": True},
    {"frozen": True},
    {},
    {"frozen": True, "slots": True, "kw_only": True},
    {"frozen": True, "slots": True, "order": True},
]


def _pair(**options):
    """The same class by Python and by amuros."""

    class Point:
        """A place."""

        x: int
        y: tuple[int, ...] = ()
        secret: int = field(default=3, repr=False, compare=False)
        made: list[int] = field(default_factory=list, init=False, hash=False)
        count: int = field(default=0, init=False)
        others: dict[str, int] = field(default_factory=dict, hash=False)

        def __post_init__(self):
            self.made.append(self.x)

    def again():
        return type("Point", (), {key: value for key, value in vars(Point).items() if key not in ("__dict__", "__weakref__")})

    return dataclasses.dataclass(**options)(again()), dataclass(**options)(again())


def test_objects_have_the_order_of_their_values():
    for kind in _pair(frozen=True, order=True):
        first, same, later = kind(x=1, y=(2,)), kind(x=1, y=(2,), secret=9), kind(x=2)
        assert (first < later, later < first, first < same) == (True, False, False)
        assert (first <= same, same >= first, first > same, later > first) == (True, True, False, True)
        with pytest.raises(TypeError, match="not supported between instances"):
            first < 1  # noqa: B015


@pytest.mark.parametrize("options", FORMS, ids=str)
def test_objects_look_compare_and_hash_as_those_of_python(options):
    for kind in (pair := _pair(**options)):
        first, same, other = kind(x=1, y=(2,)), kind(x=1, y=(2,), secret=9), kind(x=2)
        assert (first == same, first == other, first == 1) == (True, False, False)
        assert first.made == [1]
        assert repr(first).endswith("Point(x=1, y=(2,), made=[1], count=0, others={})")
        assert dataclasses.replace(first, x=5).made == [5]
        assert (kind.__hash__ is None) is not bool(options.get("frozen"))
        if options.get("frozen"):
            assert len({first, same, other}) == 2
            for change in (lambda one=first: setattr(one, "x", 2), lambda one=first: delattr(one, "x")):
                with pytest.raises(FrozenInstanceError, match="field 'x'"):
                    change()
        assert copy.deepcopy(first) == first
    ours, of_python = reversed(pair)
    assert str(inspect.signature(ours)) == str(inspect.signature(of_python))
    assert ours.__match_args__ == of_python.__match_args__
    assert [each.name for each in dataclasses.fields(ours)] == [each.name for each in dataclasses.fields(of_python)]
    for wrong in ({}, {"x": 1, "z": 2}):
        with pytest.raises(TypeError) as by_us:
            ours(**wrong)
        with pytest.raises(TypeError) as by_python:
            of_python(**wrong)
        assert str(by_us.value) == str(by_python.value)


@dataclass(frozen=True, slots=True)
class Base:
    a: int


@dataclass(frozen=True, slots=True)
class Derived(Base):
    b: int = 2

    def __eq__(self, other):
        return isinstance(other, Derived) and self.a == other.a

    def __hash__(self):
        return 7


@dataclasses.dataclass(frozen=True)
class OfAUser(Derived):
    c: int = 3


def test_classes_can_be_derived_also_by_the_decorator_of_python():
    assert repr(Derived(1)) == "Derived(a=1, b=2)"
    assert Derived(1) == Derived(1, 5)
    assert hash(Derived(1)) == 7
    assert Base(1) != Derived(1)
    assert (OfAUser(1).b, OfAUser(1).c) == (2, 3)
    assert pickle.loads(pickle.dumps(Derived(4))) == Derived(4)
    with pytest.raises(TypeError, match="cannot inherit"):
        dataclasses.dataclass(type("Changeable", (Base,), {"__annotations__": {"c": int}}))


def test_nothing_is_compiled_before_the_first_object():
    @dataclass(frozen=True)
    class Unused:
        a: int

    assert not inspect.isfunction(vars(Unused)["__init__"])
    assert Unused(1).a == 1
    assert inspect.isfunction(vars(Unused)["__init__"])


def test_fields_are_examined_when_somebody_asks_for_them():
    @dataclass(frozen=True, slots=True)
    class Unused:
        a: int
        kinds: ClassVar[tuple[str, ...]] = ("a",)

    class Plain(Unused):
        pass

    assert not isinstance(vars(Unused)["__dataclass_fields__"], dict)
    assert [each.name for each in dataclasses.fields(Plain)] == ["a"]
    assert isinstance(vars(Unused)["__dataclass_fields__"], dict)
    assert Unused.kinds == ("a",)
