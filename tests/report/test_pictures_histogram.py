"""Histograms: bars are as high as their counts, marks are where their times are, and no label is on another."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from svg_reading import SVG, assert_readable, contents, parsed, rectangles, scale

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.report.pictures.histogram import HistogramPicture, Mark, MarkKind, histogram, short_time_text
from amalthea_uros.units import MICROSECOND, MILLISECOND, parse_time

US, MS = MICROSECOND, MILLISECOND
EDGES = tuple(number * US for number in range(10, 31))
COUNTS = (*range(10), *range(10, 0, -1))


def drawn(counts=COUNTS, edges=EDGES, marks=()):
    return histogram(HistogramPicture("Response time", edges, "simulated", counts, tuple(marks)))


def bars(picture):
    nodes = [node for node in parsed(picture).iter(f"{SVG}rect") if node.find(f"{SVG}title") is not None]
    return [{name: float(node.get(name)) for name in ("x", "y", "width", "height")} for node in nodes]


def lines(picture):
    """The horizontal places of the marks by their tooltips."""
    nodes = [node for node in parsed(picture).iter(f"{SVG}g") if node.find(f"{SVG}title") is not None]
    return {node.findtext(f"{SVG}title"): float(node.find(f"{SVG}path").get("d")[1:].split()[0]) for node in nodes}


def test_bars_are_where_their_bins_are_and_as_high_as_their_counts():
    picture = drawn()
    x = scale(picture)
    found = bars(picture)
    assert len(found) == 19  # the first bin is empty
    unit = max(bar["height"] for bar in found) / 10
    for bar, count, low in zip(found, COUNTS[1:], range(11, 30), strict=True):
        assert bar["height"] == pytest.approx(count * unit, abs=0.02)
        assert bar["x"] == pytest.approx(x(low), abs=0.02)
        assert bar["x"] + bar["width"] == pytest.approx(x(low + 1), abs=0.02)


def test_a_bar_tells_its_bin_and_count():
    assert rectangles(drawn(), "12 us to 13 us: 2 jobs")


def test_one_value_of_many_is_still_seen():
    assert bars(drawn((1_000_000, *[0] * 18, 1)))[-1]["height"] >= 1


def test_marks_are_where_their_times_are():
    marks = [
        Mark("min", 11 * US),
        Mark("mean", 20 * US),
        Mark("limit", 25 * US, MarkKind.LIMIT),
        Mark("WCRT", 31 * US, MarkKind.BOUND),
    ]
    picture = drawn(marks=marks)
    x = scale(picture)
    expected = {"min: 11 us": x(11), "mean: 20 us": x(20), "limit: 25 us": x(25), "WCRT: 31 us": x(31)}
    assert lines(picture) == pytest.approx(expected, abs=0.02)
    assert {"min 11 us", "mean 20 us", "limit 25 us", "WCRT 31 us"} <= set(contents(picture))


def test_a_mark_that_is_far_away_is_at_the_edge_and_does_not_flatten_the_rest():
    picture = drawn(marks=[Mark("deadline", MS, MarkKind.LIMIT)])
    assert "deadline 1 ms \N{RIGHTWARDS ARROW}" in contents(picture)
    assert 500 < bars(picture)[-1]["x"] < lines(picture)["deadline: 1 ms"]


def test_the_legend_tells_observations_limits_and_bounds():
    picture = drawn(marks=[Mark("max", 30 * US), Mark("WCRT", 31 * US, MarkKind.BOUND)])
    assert {"simulated", "observed", "bound"} <= set(contents(picture))
    assert "limit" not in contents(picture)


def test_many_bins_are_put_together_without_losing_values():
    picture = drawn((1,) * 1024, edges=tuple(range(0, 1025 * US, US)))
    tips = [node.text for node in parsed(picture).iter(f"{SVG}title") if "jobs" in node.text]
    assert len(tips) <= 200
    assert sum(int(tip.split(": ")[1].split()[0]) for tip in tips) == 1024


@pytest.mark.parametrize(("width", "shown"), [(1 * US, 5 * US), (2 * US, 10 * US), (10 * US, 50 * US)])
def test_bins_that_are_put_together_have_a_round_width_and_round_edges(width, shown):
    # 700 bins from 13 widths on are too many; 5 of them are one, from 10 on.
    picture = drawn((1,) * 700, edges=tuple(range(13 * width, 714 * width, width)))
    tips = [node.text.partition(":")[0] for node in parsed(picture).iter(f"{SVG}title") if "jobs" in node.text]
    edges = [tuple(map(parse_time, tip.split(" to "))) for tip in tips]
    assert edges[0] == (10 * width, 15 * width)
    assert all(low % shown == 0 and high == low + shown for low, high in edges)


def test_empty_bins_at_the_ends_take_no_room():
    wide = drawn((*[0] * 500, 5, 6, 7, *[0] * 500), edges=tuple(range(0, 1004 * US, US)))
    assert all(bar["width"] > 50 for bar in bars(wide))


def test_a_histogram_without_values_says_so():
    assert "no values" in contents(drawn((0,) * 20))
    assert_readable(drawn((0,) * 20))


def test_a_single_value_is_no_wall():
    picture = drawn((10_000,), edges=(12 * US, 12 * US + 1))
    [bar] = bars(picture)
    assert bar["width"] < 100
    assert_readable(picture)


@pytest.mark.parametrize(
    ("edges", "counts", "message"),
    [
        ((1,), (), "at least two edges"),
        ((1, 1), (0,), "greater than the one before"),
        ((1, 2, 3), (1,), "needs 2 counts"),
        ((1, 2), (-1,), "at least 0"),
    ],
)
def test_what_is_no_histogram_is_refused(edges, counts, message):
    with pytest.raises(InvalidArgumentError, match=message):
        HistogramPicture("wrong", edges, "s", counts)


@pytest.mark.parametrize(("time", "shown"), [(0, "0 s"), (123, "123 ps"), (16_654_321, "16.65 us"), (99_999_999, "100 us")])
def test_times_of_labels_have_four_significant_digits(time, shown):
    assert short_time_text(time) == shown


MARKS = st.builds(Mark, st.text(max_size=40), st.integers(0, 80 * US), st.sampled_from(MarkKind))


@given(st.lists(st.integers(0, 10**9), min_size=20, max_size=20), st.lists(MARKS, max_size=9))
def test_every_histogram_is_well_formed_and_its_text_is_readable(counts, marks):
    assert_readable(drawn(tuple(counts), marks=marks))


def test_equal_values_have_a_bin_that_the_axis_can_name():
    picture = drawn((179,), edges=(3 * US, 3 * US + 1))
    assert rectangles(picture, "3 us to 3.05 us: 179 jobs")
    assert {"3000", "response time in ns"} <= set(contents(picture))
