"""Values and sections are checked against their types, with all errors and their places."""

from __future__ import annotations

from typing import Annotated

import pytest

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.spec.fields import After, Before, Limits, entry, examines
from amalthea_uros.spec.section import DescriptionSection
from amalthea_uros.spec.type_checks import WrongValueError


def no_seven(value):
    if value == 7:
        raise WrongValueError("value", "not seven")
    return value


LENGTHS = Limits(min_length=1, max_length=2)


class InnerSection(DescriptionSection):
    """A section."""

    low: Annotated[int, Limits(ge=0)]
    """The lower value."""
    high: Annotated[int, Before(abs), Limits(le=9), After(no_seven)] = 5
    """The higher value."""

    @examines
    def _is_ordered(self):
        no_seven(self.low)


class OuterSection(DescriptionSection):
    """A section with others."""

    first: InnerSection | None = None
    """One of them."""
    rows: Annotated[list[InnerSection], LENGTHS] = entry(default_factory=list, alias="lines")
    """Several of them."""
    named: dict[str, InnerSection] = entry(default_factory=dict)
    """Some by their names."""
    does: bool = False
    """A truth value."""


@pytest.mark.parametrize(
    ("content", "errors"),
    [
        ({}, []),
        ({"first": {"low": 1, "high": -3}, "x-mine": 1, "does": "yes"}, []),
        ({"first": None, "does": 2}, [("empty", "first"), ("bool_type", "does")]),
        ({"first": 3, "rows": []}, [("model_type", "first"), ("extra_forbidden", "rows")]),
        ({"lines": []}, [("too_short", "lines")]),
        ({"lines": [{"low": 1}] * 3}, [("too_long", "lines")]),
        ({"lines": [{"low": -1}, {"high": 10}]}, [
            ("greater_than_equal", "lines.0.low"), ("missing", "lines.1.low"), ("less_than_equal", "lines.1.high"),
        ]),
        ({"named": {"a": {"low": 0, "high": 7}, "b": {"low": True}}}, [("value", "named.a.high"), ("int_type", "named.b.low")]),
        # The section as a whole is examined when its keys are right.
        ({"first": {"low": 7}}, [("value", "first")]),
        ({"first": {"low": 7, "high": "x"}}, None),
    ],
)  # fmt: skip
def test_all_errors_have_their_places(content, errors):
    if errors is None:  # a mistake of a function that converts is one of the program
        with pytest.raises(TypeError):
            OuterSection.model_validate(content)
        return
    found = []
    section = OuterSection.checked(content, (), found)
    assert [(each["type"], ".".join(map(str, each["loc"]))) for each in found] == errors
    assert isinstance(section, OuterSection) is not bool(errors)


def test_a_section_that_is_made_of_wrong_values_says_all_that_is_wrong():
    with pytest.raises(InvalidArgumentError) as raised:
        OuterSection(first={"low": -1}, does=2)
    assert str(raised.value) == "2 error(s) in OuterSection\n  first.low: too small\n  does: expected true or false"


def test_sections_know_what_is_stated_and_do_not_change():
    section = OuterSection.model_validate({"first": {"low": 1}})
    assert section.model_fields_set == {"first"}
    assert section.first == InnerSection(low=1, high=-5)
    assert section.first.model_copy({"high": 6}) == InnerSection(low=1, high=6)
    assert section.first.model_copy({"high": 6}).model_fields_set == {"low", "high"}
    assert InnerSection.model_construct(low=7).high == 5  # nothing is checked
    with pytest.raises(AttributeError, match="do not change"):
        section.does = True
    assert [*OuterSection.model_fields] == ["first", "rows", "named", "does"]
