"""Pictures of sweeps, as they are in the SVG."""

import re
from fractions import Fraction

import pytest

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.report.pictures.swept import SweptPicture, draw_swept

MS = 10**9


def picture(axes, values, verdicts=None, **others):
    targets = ("A.period", "B.offset")[: len(axes)]
    found = {"quantity": "chain.max", "is_time": True, "targets": targets, "axes": axes, "values": values}
    return draw_swept(SweptPicture(**found, verdicts=verdicts or {}, **others))


def test_the_height_of_a_point_is_in_proportion_to_its_value():
    drawn = picture((("1ms", "2ms", "4ms"),), {(f"{n}ms",): Fraction(n * MS) for n in (1, 2, 4)})
    heights = [float(y) for y in re.findall(r'cy="([\d.]+)"', drawn)]
    rises = [heights[0] - height for height in heights]
    assert rises[2] == pytest.approx(3 * rises[1])


def test_an_unknown_value_is_a_gap_and_is_told():
    drawn = picture((("1ms", "2ms", "4ms"),), {("1ms",): Fraction(MS), ("2ms",): None, ("4ms",): Fraction(2 * MS)})
    assert drawn.count("<circle") == 2
    assert "A.period 2ms: unknown" in drawn
    way = re.search(r'class="t0 steps" d="([^"]+)"', drawn)[1]
    assert way.count("M") == 2


def test_the_greatest_cell_is_the_darkest_and_what_was_not_tried_is_empty():
    values = {("1", "a"): Fraction(MS), ("1", "b"): Fraction(3 * MS), ("2", "a"): Fraction(2 * MS)}
    drawn = picture((("1", "2"), ("a", "b")), values, {("1", "b"): Verdict.MISSED})
    first, greatest, middle = (float(value) for value in re.findall(r'<rect[^>]+fill-opacity="([\d.]+)"', drawn)[:3])
    assert first < middle < greatest
    assert "A.period 2, B.offset b: not tried" in drawn
    assert "missed" in drawn


def test_no_map_that_nobody_could_read():
    many = tuple(map(str, range(100)))
    with pytest.raises(InvalidArgumentError, match="use --table"):
        picture((many, many), {})
    with pytest.raises(InvalidArgumentError, match="one or two swept values"):
        draw_swept(SweptPicture(quantity="q", is_time=True, targets=("a", "b", "c"), axes=(), values={}, verdicts={}))
