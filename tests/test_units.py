"""Quantities as text and as exact numbers."""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros import units


@pytest.mark.parametrize(
    ("text", "picoseconds"),
    [
        ("10 ms", 10 * 10**9),
        ("250us", 250 * 10**6),
        ("1.5 us", 1_500_000),
        ("0.001 ns", 1),
        ("2e-3 s", 2 * 10**9),
        ("5 min", 300 * 10**12),
        ("1 h", 3600 * 10**12),
        ("3 µs", 3 * 10**6),
    ],
)
def test_times(text, picoseconds):
    assert units.parse_time(text) == picoseconds


@pytest.mark.parametrize(
    ("text", "bits"), [("4 B", 32), ("1 kB", 8000), ("1 KiB", 8192), ("10 MB", 80_000_000), ("3 bit", 3), ("2 Kibit", 2048)]
)
def test_data_sizes(text, bits):
    assert units.parse_data_size(text) == bits


def test_rates():
    assert units.parse_bit_rate("250 kbit/s") == 250_000
    assert units.parse_bit_rate("1 MB/s") == 8_000_000
    assert units.parse_frequency("33.333 MHz") == Fraction(33_333_000)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("10", "has no unit"),
        ("", "is not a time"),
        ("ms", "is not a time"),
        ("10 mss", "did you mean 'ms'"),
        ("10 MS", "did you mean 'ms'"),
        ("10 V", "known units: ps, ns"),
        ("0.5 ps", "not a whole number of picoseconds"),
        ("1e999 s", "out of range"),
        ("9" * 50 + " s", "is not a time"),
        ("-1e7 s", "out of range"),
        ("nan s", "is not a time"),
    ],
)
def test_what_is_no_time(text, reason):
    with pytest.raises(ValueError, match=reason):
        units.parse_time(text)


@pytest.mark.parametrize("text", ["1e-400 Hz", "0.0000001 Hz", "-1e-8 Hz", "1e10 GHz"])
def test_the_period_of_a_frequency_is_a_time(text):
    with pytest.raises(ValueError, match="out of range"):
        units.parse_frequency(text)
    assert units.parse_frequency("0.00000011 Hz") == Fraction(11, 10**8)


@pytest.mark.parametrize(
    ("picoseconds", "text"),
    [
        (0, "0 s"),
        (Fraction(1, 2), "0.5 ps"),
        (1, "1 ps"),
        (999, "999 ps"),
        (1000, "1 ns"),
        (12_000_000, "12 us"),
        (16_650_000, "16.65 us"),
        (Fraction(10**9, 3), "333.333333333 us"),
        (-2 * 10**9, "-2 ms"),
        (90 * 10**12, "90 s"),
    ],
)
def test_times_as_text(picoseconds, text):
    assert units.time_text(picoseconds) == text


def test_a_time_beyond_the_range_of_float():
    assert units.time_text(10**5000) == "1e+4988 s"


@pytest.mark.parametrize(
    ("bits", "text"),
    [
        (0, "0 B"),
        (1, "1 bit"),
        (8, "1 B"),
        (8192, "1 KiB"),
        (8000, "1 kB"),
        (12_000, "1500 B"),
        (8 * 1024 * 240, "240 KiB"),
        (2**33, "1 GiB"),
    ],
)
def test_data_sizes_as_text(bits, text):
    assert units.data_size_text(bits) == text


@given(st.fractions())
def test_a_number_as_text_is_right_to_twelve_digits(number):
    assert abs(Fraction(units.number_text(number)) - number) <= abs(number) / 10**11


def test_frequencies_as_text():
    assert units.frequency_text(Fraction(300 * 10**6)) == "300 MHz"


@given(st.integers(0, 10**11))
def test_a_time_with_few_digits_is_what_its_text_says(picoseconds):
    assert units.parse_time(units.time_text(picoseconds)) == picoseconds


@given(st.integers(0, 10**9), st.integers(1, 4000))
def test_ticks_and_times_are_exact(ticks, megahertz):
    frequency = Fraction(megahertz * 10**6)
    exact = units.time_of_ticks(ticks, frequency)
    assert exact * frequency == ticks * units.SECOND
    assert units.ticks_of_time(units.up(exact), frequency) >= ticks >= units.ticks_of_time(units.down(exact), frequency)


UP, DOWN, NEAREST = units.Rounding.UP, units.Rounding.DOWN, units.Rounding.NEAREST


@pytest.mark.parametrize(
    ("time", "rounding", "text"),
    [
        ("50.2821 ms", UP, "50.29 ms"),
        ("50.2821 ms", DOWN, "50.28 ms"),
        ("50.2821 ms", NEAREST, "50.28 ms"),
        ("-50.2821 ms", DOWN, "-50.29 ms"),
        ("999.999 us", UP, "1 ms"),
        ("1.016 ms", UP, "1.016 ms"),
        # Whole numbers of the unit are exact, however many digits they have.
        ("12345 s", DOWN, "12345 s"),
        ("12345.5 s", DOWN, "12345 s"),
        ("0 s", UP, "0 s"),
    ],
)
def test_times_in_tables_have_four_digits(time, rounding, text):
    assert units.rounded_time_text(units.parse_time(time), rounding) == text


@given(st.integers(-(10**18), 10**18))
def test_bounds_in_tables_remain_bounds(time):
    down, up = (units.parse_time(units.rounded_time_text(time, rounding)) for rounding in (DOWN, UP))
    assert down <= time <= up
    # The last of four digits is at most a thousandth.
    assert up - down <= abs(time) / 1000


@pytest.mark.parametrize(
    ("time", "rounding", "limit", "text"),
    [
        ("12.3449 ms", UP, "12.345 ms", "12.3449 ms"),
        ("12.34501 ms", DOWN, "12.345 ms", "12.34501 ms"),
        ("12.345 ms", UP, "12.345 ms", "12.345 ms"),
        ("9.99999 ms", UP, "10 ms", "9.99999 ms"),
        ("50.2821 ms", UP, "60 ms", "50.29 ms"),
    ],
)
def test_rounding_does_not_contradict_a_verdict(time, rounding, limit, text):
    assert units.rounded_time_text(units.parse_time(time), rounding, units.parse_time(limit)) == text


@given(st.integers(0, 10**10), st.integers(-10, 10) | st.integers(-(10**7), 10**7), st.sampled_from(units.Rounding))
def test_a_rounded_time_is_on_the_same_side_of_its_limit(limit, distance, rounding):
    time = limit + distance
    shown = units.parse_time(units.rounded_time_text(time, rounding, limit))
    assert (shown < limit, shown > limit) == (time < limit, time > limit)


@pytest.mark.parametrize(
    "text", ["9" * 200_000, "9" * 100_000 + " ms", " " * 100_000 + "1 ms" + " " * 100_000, "1" + "m" * 200_000]
)
def test_very_long_texts_are_refused_at_once(text):
    # To match them with the expression took a time that grows with the square of their length.
    with pytest.raises(ValueError, match="is not a time such as") as error:
        units.parse_time(text)
    assert len(str(error.value)) < 100


@pytest.mark.parametrize(
    ("share", "decimals", "rounding", "text"),
    [
        (Fraction(11, 10), 1, units.Rounding.NEAREST, "110.0"),
        (Fraction(10_001, 10_000), 1, units.Rounding.NEAREST, "100.01"),
        (Fraction(99_999, 100_000), 1, units.Rounding.UP, "99.999"),
        (1, 1, units.Rounding.NEAREST, "100.0"),
        (Fraction(1, 3), 3, units.Rounding.DOWN, "33.333"),
        (Fraction(1, 3), 3, units.Rounding.UP, "33.334"),
    ],
)
def test_a_percentage_is_on_its_side_of_all(share, decimals, rounding, text):
    assert units.percent_text(share, decimals, rounding) == text


def test_the_bounds_of_a_value():
    bounds = units.Interval(units.MILLISECOND, 2 * units.MILLISECOND)
    assert (bounds.lower, bounds.upper) == (units.MILLISECOND, 2 * units.MILLISECOND)
    assert isinstance(bounds, units.OpenInterval)
    assert units.OpenInterval(3, None) == units.OpenInterval(lower=3, upper=None)
