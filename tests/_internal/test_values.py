"""Dataclasses with methods that are compiled late behave like those of the standard library."""

import copy
import dataclasses
import inspect
import pickle
from typing import get_type_hints

import pytest
from hypothesis import given
from hypothesis.strategies import builds

from amalthea_uros._internal import values
from amalthea_uros.timing.settings import Settings


@values.dataclass(frozen=True, slots=True)
class Point:
    """A value with types that are text here, as everywhere in the package."""

    x: "int"
    settings: "Settings" = Settings()


def classes(dataclass):
    @dataclass(frozen=True, slots=True, kw_only=True)
    class Base:
        """A base."""

        name: str
        tags: list[str] = dataclasses.field(default_factory=list, hash=False)

    @dataclass(frozen=True, slots=True)
    class Derived(Base):
        """With positional parameters, and fields of all kinds."""

        first: int
        second: float = 2.5
        hidden: int = dataclasses.field(default=7, repr=False, compare=False)
        computed: dict[str, int] = dataclasses.field(init=False, default_factory=dict, hash=False)
        constant: int = dataclasses.field(init=False, default=3)
        twice: int = dataclasses.field(init=False)

        def __post_init__(self):
            object.__setattr__(self, "twice", 2 * self.first)

    @dataclass(frozen=True)
    class Empty:
        """Without fields."""

    return Derived, Empty


STANDARD, OURS = classes(dataclasses.dataclass), classes(values.dataclass)


def objects(derived, empty):
    return [derived(1, name="a"), derived(1, 2.5, 8, name="a"), derived(2, name="b", tags=["x"]), empty(), empty()]


def test_objects_print_compare_and_hash_alike():
    standard, ours = objects(*STANDARD), objects(*OURS)
    assert list(map(repr, ours)) == list(map(repr, standard))
    assert list(map(hash, ours)) == list(map(hash, standard))
    assert [[a == b for b in ours] for a in ours] == [[a == b for b in standard] for a in standard]
    assert ours[0] != standard[0]
    assert list(map(dataclasses.asdict, ours)) == list(map(dataclasses.asdict, standard))


def test_signatures_and_patterns_are_alike():
    for standard, ours in zip(STANDARD, OURS, strict=True):
        assert str(inspect.signature(ours)) == str(inspect.signature(standard))
        assert ours.__match_args__ == standard.__match_args__
        assert ours.__init__.__qualname__ == standard.__init__.__qualname__


@pytest.mark.parametrize("arguments", [(), (1,), (1, 2, 3, 4)])
def test_wrong_calls_have_the_same_message(arguments):
    messages = []
    for derived, _ in (STANDARD, OURS):
        with pytest.raises(TypeError) as error:
            derived(*arguments)
        messages.append(str(error.value))
    assert messages[0] == messages[1]


def test_objects_are_immutable_replaced_and_copied():
    one = OURS[0](1, name="a")
    with pytest.raises(dataclasses.FrozenInstanceError):
        one.first = 2
    assert dataclasses.replace(one, first=2).twice == 4
    assert copy.deepcopy(one) == one


def test_methods_of_the_class_and_of_the_standard_library_go_together():
    @values.dataclass(frozen=True)
    class Own:
        """With a text of its own."""

        name: str

        def __repr__(self):
            return "own"

    @dataclasses.dataclass(frozen=True)
    class More(Own):
        """A subclass of a user."""

        number: int = 0

    assert [repr(Own("a")), Own("a") == Own("a"), Own("a") == Own("b")] == ["own", True, False]
    assert More("a", 1) == More("a", 1) != More("a", 2)


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_values_can_be_pickled(protocol):
    one = Point(1)
    assert pickle.loads(pickle.dumps(one, protocol)) == one


def test_a_plain_subclass_may_have_attributes_of_its_own_but_changes_no_field():
    class Named(Point):
        pass

    named = Named(1)
    named.name = "p"
    del named.name
    with pytest.raises(dataclasses.FrozenInstanceError, match="cannot assign to field 'x'"):
        named.x = 2
    with pytest.raises(dataclasses.FrozenInstanceError, match="cannot delete field 'x'"):
        del named.x
    with pytest.raises(dataclasses.FrozenInstanceError):
        Point(1).name = "p"


def test_the_standard_library_sees_frozen_classes():
    with pytest.raises(TypeError, match="non-frozen"):

        @dataclasses.dataclass
        class Changeable(Point):
            pass


def test_the_types_of_parameters_are_those_of_the_module():
    assert get_type_hints(Point.__init__) == {"x": int, "settings": Settings, "return": type(None)}


@given(builds(Point))
def test_arbitrary_values_are_made_from_the_types_of_their_fields(point):
    assert isinstance(point.x, int)
    assert dataclasses.replace(point) == point


def test_nothing_is_compiled_before_it_is_used():
    made, _ = classes(values.dataclass)
    assert not inspect.isfunction(vars(made)["__init__"])
    made(1, name="a")
    assert inspect.isfunction(vars(made)["__init__"])
    assert not inspect.isfunction(vars(made)["__eq__"])
