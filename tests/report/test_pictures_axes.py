"""Axes have nice numbers, in units of their range, and labels that have room."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.report.basics.escape import visible
from amalthea_uros.report.pictures.axes import TimeAxis, count_ticks, default_window, multiples, nice_step, unit_of
from amalthea_uros.report.pictures.svg import element, elided, text, text_width
from amalthea_uros.units import MICROSECOND, MILLISECOND, NANOSECOND, SECOND

TIMES = st.integers(0, 2**62)
US, MS = MICROSECOND, MILLISECOND


@pytest.mark.parametrize(("span", "parts", "step"), [(10, 10, 1), (11, 10, 2), (21, 10, 5), (51, 10, 10), (1000, 6, 200)])
def test_a_nice_step_is_the_smallest_of_1_2_and_5_times_a_power_of_ten(span, parts, step):
    assert nice_step(span, parts) == step


@given(st.integers(1, 10**18), st.integers(1, 50))
def test_steps_are_1_2_or_5_times_a_power_of_ten(span, parts):
    step = nice_step(span, parts)
    assert str(step).rstrip("0") in ("1", "2", "5")
    assert step * parts >= span


def test_multiples_include_both_ends():
    assert list(multiples(5, 10, 20)) == [10, 15, 20]
    assert list(multiples(5, 11, 19)) == [15]


@pytest.mark.parametrize(
    ("span", "unit"), [(1, "ps"), (2 * NANOSECOND, "ns"), (MS, "us"), (2 * MS, "ms"), (21 * MS, "ms"), (300 * SECOND, "s")]
)
def test_the_unit_is_the_largest_of_which_there_are_two(span, unit):
    assert unit_of(span)[0] == unit


def test_a_period_of_a_millisecond_is_labelled_in_steps_of_100_us():
    axis = TimeAxis(0, MS, 0, 800)
    assert [axis.label(tick) for tick in axis.ticks] == [str(number) for number in range(0, 1001, 100)]
    assert axis.caption("time") == "time in us"


def test_a_window_far_from_zero_is_labelled_relative_to_a_round_time():
    axis = TimeAxis(12_345 * MS + 678 * US, 12_345 * MS + 698 * US, 0, 800)
    assert axis.caption("time") == "time in us after 12.345 s"
    assert [axis.label(tick) for tick in axis.ticks][:2] == ["678", "680"]


@given(TIMES, st.integers(1, 2**60), st.floats(200, 900))
def test_ticks_are_in_the_window_equally_far_from_each_other_with_room_for_labels(start, span, width):
    axis = TimeAxis(start, start + span, 0, width)
    ticks = list(axis.ticks)
    assert all(start <= tick <= start + span for tick in ticks)
    assert len({after - before for before, after in pairwise(ticks)}) <= 1
    for before, after in pairwise(ticks):
        widths = (text_width(axis.label(before), 11) + text_width(axis.label(after), 11)) / 2
        assert axis.x(before) + widths < axis.x(after)


@given(st.integers(0, 10**12))
def test_counts_have_at_most_seven_labels_up_to_the_highest(highest):
    ticks = count_ticks(highest)
    assert ticks[0] == 0
    assert ticks[-1] >= max(highest, 1)
    assert 2 <= len(ticks) <= 8


def test_a_window_has_a_tenth_on_both_sides_and_round_ends():
    # 1000 us with margins of 100 us are 1200 us; a twentieth of that is 60 us, the next nice number 100 us.
    assert default_window(5000 * US, 6000 * US) == (4900 * US, 6100 * US)
    assert default_window(5010 * US, 6010 * US) == (4900 * US, 6200 * US)


def test_a_window_does_not_begin_before_zero():
    assert default_window(0, 1000 * US) == (0, 1100 * US)


@given(TIMES, st.integers(0, 2**60))
def test_a_window_contains_what_it_is_around(time, length):
    start, end = default_window(time, time + length)
    assert start <= time <= time + length < end
    assert end - start <= 2 * length + 2 * US


def test_a_window_that_ends_before_it_starts_is_refused():
    with pytest.raises(InvalidArgumentError, match="start at 2 us and end before, at 1 us"):
        default_window(2 * US, US)


def test_characters_that_are_not_latin_are_as_wide_as_high():
    assert text_width("\N{CJK UNIFIED IDEOGRAPH-6642}\N{CJK UNIFIED IDEOGRAPH-9593}", 10) == 20


@given(st.text(max_size=60), st.floats(0, 300))
def test_elided_text_fits_and_keeps_both_ends(content, room):
    shown = elided(content, 12, room)
    assert text_width(shown, 12) <= room
    content = visible(content)
    if shown not in ("", content):
        first, last = shown.split("\N{HORIZONTAL ELLIPSIS}") if shown.count("\N{HORIZONTAL ELLIPSIS}") == 1 else ("", "")
        assert content.startswith(first)
        assert content.endswith(last)


def test_text_and_attributes_are_escaped():
    assert element("text", text('<&">\0'), name_='<&">') == "<text name='&lt;&amp;\"&gt;'>&lt;&amp;\"&gt;\\x00</text>"


def test_coordinates_have_two_decimals_without_zeros():
    assert element("line", x1=1.0, x2=0.126, y1=-0.001, y2=100) == '<line x1="1" x2="0.13" y1="0" y2="100"/>'
