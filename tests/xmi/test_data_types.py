"""Numbers and truth values as Java writes and reads them."""

import math
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.xmi.emf.data_types import (
    format_double,
    format_float,
    parse_address,
    parse_boolean,
    parse_float,
    parse_integer,
)
from amalthea_uros.xmi.emf.escape import escape, impossible_character, unescape


@pytest.mark.parametrize(
    ("value", "text"),
    [
        # The examples of the class documentation of java.lang.Double, and of files written by EMF.
        (1.0, "1.0"),
        (0.05, "0.05"),
        (5e-4, "5.0E-4"),
        (0.001, "0.001"),
        (2.034807e7, "2.034807E7"),
        (1e7, "1.0E7"),
        (9999999.0, "9999999.0"),
        (1e8, "1.0E8"),
        (-123.456, "-123.456"),
        (-0.0, "-0.0"),
        (math.inf, "Infinity"),
        (-math.inf, "-Infinity"),
        (1.7976931348623157e308, "1.7976931348623157E308"),
    ],
)
def test_a_double(value, text):
    assert format_double(value) == text
    assert parse_float(text) == value


def test_not_a_number():
    assert format_double(math.nan) == "NaN"
    assert math.isnan(parse_float("NaN"))


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.1, "0.1"), (3.4028235e38, "3.4028235E38"), (16777216, "1.6777216E7"), (1e39, "Infinity"), (-math.inf, "-Infinity")],
)
def test_a_float_has_the_digits_of_32_bits(value, text):
    assert format_float(value) == text


@given(st.floats(allow_nan=False))
def test_a_double_is_read_as_it_was_written(value):
    assert parse_float(format_double(value)) == value


@given(st.floats(width=32, allow_nan=False))
def test_a_float_is_read_as_it_was_written(value):
    read = parse_float(format_float(value))
    assert struct.pack("f", read) == struct.pack("f", value)


@pytest.mark.parametrize(
    ("text", "value"), [("0x1a", 26), ("0X1A", 26), ("#1a", 26), ("017", 15), ("26", 26), ("0", 0), ("0x200000", 2097152)]
)
def test_an_address(text, value):
    assert parse_address(text) == value


@pytest.mark.parametrize("text", ["-1", "+0x1", "0x", "08", "1a", "", "0x1_0"])
def test_no_address(text):
    with pytest.raises(ValueError, match="not an address"):
        parse_address(text)


@pytest.mark.parametrize(
    ("text", "value"), [("5", 5), ("-5", -5), ("+5", 5), (" 7 ", 7), ("123456789012345678901", 123456789012345678901)]
)
def test_a_whole_number(text, value):
    assert parse_integer(text) == value


@pytest.mark.parametrize("text", ["", "1.0", "1_000", "٣", "0x10", "ten", "--1"])
def test_no_whole_number(text):
    with pytest.raises(ValueError, match="not a whole number"):
        parse_integer(text)


@pytest.mark.parametrize("text", ["", "1,5", "1_0.0", "nan", "inf", "0x1p3", "e5"])
def test_no_number(text):
    with pytest.raises(ValueError, match="not a number"):
        parse_float(text)


def test_a_truth_value():
    assert [parse_boolean(text) for text in ("true", "FALSE")] == [True, False]
    with pytest.raises(ValueError, match="neither true nor false"):
        parse_boolean("1")


def test_what_emf_escapes():
    assert escape("a<b>&\"'\n\t\r") == "a&lt;b>&amp;&quot;'&#xA;&#x9;&#xD;"


@given(st.text().filter(lambda text: impossible_character(text) is None))
def test_an_escaped_value_is_read_as_it_was(text):
    assert unescape(escape(text)) == text
