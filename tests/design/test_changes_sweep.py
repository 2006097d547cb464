"""Sweeps: several values of a property, and the combinations of several sweeps."""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.design.changes.change import MAX_VARIANTS, Change, Sweep, parse_sweep, variants
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.units import TIME, parse, parse_frequency, parse_time

VALUES = {
    "1ms..3ms/1ms": ["1 ms", "2 ms", "3 ms"],
    "1ms..3.9ms/1ms": ["1 ms", "2 ms", "3 ms"],
    "500us..1ms/0.25ms": ["500 us", "750 us", "1000 us"],
    "1s..2min/1min": ["1 s", "61 s"],
    "0.1ms..0.3ms/0.1ms": ["0.1 ms", "0.2 ms", "0.3 ms"],
    "100 MHz .. 1 GHz / 450 MHz": ["100 MHz", "550 MHz", "1000 MHz"],
    "-1..1/1": ["-1", "0", "1"],
    "10ticks..20ticks/5ticks": ["10 ticks", "15 ticks", "20 ticks"],
    "4us..4us/1us": ["4 us"],
    "a, b,c": ["a", "b", "c"],
    "2us..4us,3us..5us": ["2us..4us", "3us..5us"],
    "preemptive": ["preemptive"],
}


@pytest.mark.parametrize("text", VALUES)
def test_the_values_of_a_range_or_a_list(text):
    assert parse_sweep(f"a.name.key={text}") == Sweep("a.name", "key", tuple(VALUES[text]))


WRONG = {
    "1ms..3ms": "has no step",
    "1ms..3ms/0ms": "not greater than zero",
    "3ms..1ms/1ms": "the range ends before it starts",
    "1ms..3/1ms": "not of the same kind",
    "1..3/1ms": "not of the same kind",
    "1ms..3kHz/1ms": "not of the same kind",
    "1..3/1ticks": "not of the same kind",
    "x..3/1": "'x' is not a time",
    "1.5..3/1": "has no unit",
    "a,,b": "an empty value",
    "1ps..1h/1ps": f"at most {MAX_VARIANTS:,}",
}


@pytest.mark.parametrize("text", WRONG)
def test_wrong_sweeps_say_what_was_expected(text):
    with pytest.raises(InvalidArgumentError, match=WRONG[text]):
        parse_sweep(f"T.period={text}")


@given(
    st.integers(0, 10**6),
    st.integers(0, 300),
    st.integers(1, 10**6),
    st.integers(0, 999),
    st.sampled_from(["ps", "ns", "us", "ms"]),
)
def test_a_range_has_exactly_the_multiples_of_its_step(start, steps, width, rest, unit):
    end = start + steps * width + rest % width
    values = parse_sweep(f"T.period={start}{unit}..{end}{unit}/{width}{unit}").values
    assert [parse(value, TIME) for value in values] == [
        Fraction(start + i * width) * TIME.units[unit] for i in range(steps + 1)
    ]


@given(st.decimals(1, 9, places=3), st.integers(1, 9), *[st.sampled_from(["ns", "us", "ms", "s", "min", "h"])] * 2)
def test_mixed_units_are_exact(start, width, unit, other):
    first, step = parse_time(f"{start}{unit}"), parse_time(f"{width}{other}")
    values = parse_sweep(f"T.period={start}{unit}..{first + 3 * step}ps/{width}{other}").values
    assert [parse_time(value) for value in values] == [first + i * step for i in range(4)]


def test_the_last_of_several_sweeps_changes_fastest():
    found = list(variants([parse_sweep("A.x=1,2"), parse_sweep("B.y=3,4")]))
    assert found == [
        (Change("A", "x", first), Change("B", "y", second))
        for first, second in (("1", "3"), ("1", "4"), ("2", "3"), ("2", "4"))
    ]
    assert list(variants([])) == [()]


def test_the_number_of_variants_is_limited():
    thousand = [parse_sweep(f"{name}.x=1..1000/1") for name in "AB"]
    assert sum(1 for _ in variants(thousand)) == MAX_VARIANTS
    with pytest.raises(InvalidArgumentError, match="the sweeps have 2,000,000 variants"):
        variants([*thousand, parse_sweep("C.x=1,2")])


def test_a_property_is_swept_once():
    with pytest.raises(InvalidArgumentError, match=r"'A\.x' is swept more than once"):
        variants([parse_sweep("A.x=1"), parse_sweep("A.x=2")])


def test_frequencies_keep_all_digits():
    values = parse_sweep("C.frequency=33.333333MHz..33.333335MHz/1Hz").values
    assert [parse_frequency(value) for value in values] == [33_333_333, 33_333_334, 33_333_335]
