"""How frames that mark starts and ends are written."""

import pytest

from amalthea_uros.measure.markers import Marker, parse_marker, refuse_overlap
from amalthea_uros.trace.can.frames import EXTENDED


@pytest.mark.parametrize(
    ("text", "marker"),
    [
        ("123", Marker(0x123)),
        ("0x123", Marker(0x123)),
        ("0x18000001", Marker(0x18000001 | EXTENDED)),
        # candump writes identifiers of 29 bits with eight digits, however small they are.
        ("00000123", Marker(0x123 | EXTENDED)),
        ("800", Marker(0x800 | EXTENDED)),
        ("123#01", Marker(0x123, (1,))),
        ("can0:123#01xx0A", Marker(0x123, (1, None, 10), "can0")),
    ],
)
def test_a_marker_is_written_as_candump_shows_it(text, marker):
    assert parse_marker(text) == marker
    assert parse_marker(str(marker)) == marker


@pytest.mark.parametrize("text", ["", "x", "123#1", "123#", "20000000", "can0:", "123##01", "1234567890"])
def test_other_text_is_refused(text):
    with pytest.raises(ValueError, match=r"29 bits|an example"):
        parse_marker(text)


def test_the_first_bytes_decide():
    marker = parse_marker("123#01xx03")
    assert marker.fits(bytes([1, 9, 3]))
    assert marker.fits(bytes([1, 9, 3, 4]))
    assert not marker.fits(bytes([1, 9]))
    assert not marker.fits(bytes([1, 9, 4]))


@pytest.mark.parametrize(("one", "other"), [("123", "123"), ("123", "123#01"), ("can0:123", "123"), ("123#xx01", "123#02")])
def test_a_frame_cannot_be_start_and_end(one, other):
    with pytest.raises(ValueError, match="a frame can be both"):
        refuse_overlap(parse_marker(one), parse_marker(other))


@pytest.mark.parametrize(
    ("one", "other"), [("123", "124"), ("123", "00000123"), ("can0:123", "can1:123"), ("123#01", "123#02")]
)
def test_markers_that_differ_are_told_apart(one, other):
    refuse_overlap(parse_marker(one), parse_marker(other))
