"""The worst case of a chain: each job waits and runs where its times are."""

import re
from dataclasses import replace
from itertools import product

import pytest
from effort import every
from support import ROOT
from svg_reading import NASTY, SVG, assert_readable, contents, parsed, scale

from amalthea_uros import LatencyQuantity, analyze_files
from amalthea_uros.analyze.explanations.chains import explain_chain
from amalthea_uros.report.pictures.chain_hops import MOST_HOPS, draw_hops
from amalthea_uros.units import MILLISECOND

MS = MILLISECOND


def explanation(sample, chain, quantity=LatencyQuantity.MAX_REDUCED_REACTION_TIME):
    return explain_chain(analyze_files(ROOT / "samples" / sample).analysis, chain, quantity)


@pytest.fixture(scope="module")
def thesis():
    return explanation("bodas-test-advanced.yaml", "factor-to-output")


def bars(picture, process):
    """(left, right) of the boxes of a process."""
    nodes = [
        bar
        for group in parsed(picture).iter(f"{SVG}g")
        if (group.findtext(f"{SVG}title") or "").startswith(f"{process}:")
        for bar in group.iter(f"{SVG}rect")
    ]
    return [(float(bar.get("x")), float(bar.get("x")) + float(bar.get("width"))) for bar in nodes]


def test_the_worst_case_of_the_thesis(thesis):
    # By hand: the executor reads at 0 and writes at 25 us; the function that takes its message runs at 19.016 ms; the next job of the
    # control function that reads after 19.018 ms starts at 20.025 ms and takes 4 us.
    picture = draw_hops(thesis)
    x = scale(picture)
    wait, _run = bars(picture, "Message_Factor")
    assert wait == pytest.approx((x(0.025), x(19.016)), abs=0.02)
    wait, _run = bars(picture, "Control_Function")
    assert wait == pytest.approx((x(19.018), x(20.025)), abs=0.02)
    assert {"20.029 ms", "job 2, waits 18.991 ms, runs 2 us", "job 22, waits 1.007 ms, runs 4 us"} <= set(contents(picture))


def test_short_runs_are_seen(thesis):
    assert all(right - left >= 3 for left, right in bars(draw_hops(thesis), "Message_Factor"))


def test_arrows_lead_from_each_write_to_the_next_lane(thesis):
    picture = draw_hops(thesis)
    x = scale(picture)
    arrows = [node.get("d") for node in parsed(picture).iter(f"{SVG}path") if node.get("marker-end")]
    starts = [float(re.match(r"M([\d.]+)", arrow)[1]) for arrow in arrows[:-1]]
    assert starts == pytest.approx([x(0.025), x(19.018)], abs=0.02)


def test_a_limit_is_drawn_where_it_is(thesis):
    picture = draw_hops(thesis, 25 * MS)
    line = next(node for node in parsed(picture).iter(f"{SVG}path") if node.get("class") == "alert")
    assert float(re.match(r"M([\d.]+)", line.get("d"))[1]) == pytest.approx(scale(picture)(25), abs=0.02)
    assert "limit 25 ms" in contents(picture)


def test_data_that_get_old_until_they_are_overwritten_have_a_box():
    # The next output comes 1.013 ms later: 40.029 ms are the hops and this.
    picture = draw_hops(explanation("bodas-test-advanced.yaml", "factor-to-output", LatencyQuantity.MAX_DATA_AGE))
    assert "40.029 ms" in contents(picture)
    assert any(text.startswith("output is overwri") and text.endswith("after 1.013 ms") for text in contents(picture))


CHAINS = ("speed-to-torque", "wheel-to-torque", "height-to-log", "wheels-to-odometry")
QUANTITIES = (LatencyQuantity.MAX_REDUCED_REACTION_TIME, LatencyQuantity.MAX_DATA_AGE)


@pytest.mark.parametrize(("chain", "quantity"), every(3, list(product(CHAINS, QUANTITIES))))
def test_all_chains_are_readable(chain, quantity):
    assert_readable(draw_hops(explanation("drive-and-lift.yaml", chain, quantity)))


def test_a_write_before_the_first_read_is_in_the_picture():
    # The callback reads before the executor that calls it has written what the next one takes.
    picture = draw_hops(explanation("rclc-in-executor.yaml", "imu-to-wheels"))
    assert "time since the first read in ms" in contents(picture)
    assert_readable(picture)


def test_an_unknown_latency_says_why(thesis):
    picture = draw_hops(replace(thesis, hops=(), value=None, reason="no data flow connects A to B"))
    assert "no single hops: no data flow connects A to B" in contents(picture)
    assert "unknown" in contents(picture)


def test_names_are_escaped_and_long_ways_end(thesis):
    hop = replace(thesis.hops[1], process=NASTY)
    picture = draw_hops(replace(thesis, hops=(hop,) * (MOST_HOPS + 2)))
    assert contents(picture).count(NASTY) == MOST_HOPS
    assert "2 hops after these not shown." in contents(picture)
