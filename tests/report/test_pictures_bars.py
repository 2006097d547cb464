"""Loads and response times as bars: lengths are those of the analysis, and what is unknown looks different."""

import re
from dataclasses import replace
from fractions import Fraction

import pytest
from support import ROOT
from svg_reading import NASTY, SVG, assert_readable, contents, parsed

from amalthea_uros import Options, analyze_files, simulate_files
from amalthea_uros._internal.by_name import Results
from amalthea_uros.analyze.results.processes import ProcessorResult
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.report.pictures.load_bars import MOST_CORES, draw_loads
from amalthea_uros.report.pictures.page import embedded
from amalthea_uros.report.pictures.response_bars import MOST_ROWS, draw_responses
from amalthea_uros.timing.response import Response
from amalthea_uros.units import MILLISECOND, Duration

SAMPLES = ROOT / "samples"
MS = MILLISECOND


@pytest.fixture(scope="module")
def analysis():
    return analyze_files(SAMPLES / "bodas-test-advanced.yaml").analysis


def core(name, best, mean, worst, at_least):
    best, mean, worst = (None if load is None else Fraction(load) for load in (best, mean, worst))
    return ProcessorResult(name=name, frequency=None, best=best, mean=mean, worst=worst, at_least=Fraction(at_least))


def loads_of(analysis, *cores):
    return draw_loads(replace(analysis, processors=Results(cores)))


def bars(picture, name):
    """(left, right, class or fill) of the rectangles in the group of a core."""
    group = next(
        node for node in parsed(picture).iter(f"{SVG}g") if (node.findtext(f"{SVG}title") or "").startswith(f"{name}:")
    )
    return [
        (float(bar.get("x")), float(bar.get("x")) + float(bar.get("width")), bar.get("class") or bar.get("fill"))
        for bar in group.iter(f"{SVG}rect")
    ]


def full(picture):
    """The pixel of 100 %."""
    line = next(
        node for node in parsed(picture).iter(f"{SVG}path") if node.get("class") == "alert" and "V" in (node.get("d") or "")
    )
    return float(re.match(r"M([\d.]+)", line.get("d"))[1])


def test_the_bar_of_a_load_is_its_part_of_the_way_to_100_percent(analysis):
    picture = loads_of(analysis, core("A", "1/4", "3/8", "1/2", "1/2"))
    worst, best = bars(picture, "A")
    assert worst[1] - worst[0] == pytest.approx((full(picture) - worst[0]) / 2, abs=0.02)
    assert best[1] - best[0] == pytest.approx((full(picture) - worst[0]) / 4, abs=0.02)
    assert "worst 50 %, mean 37.5 %, best 25 %" in contents(picture)


def test_an_unknown_part_of_the_load_is_hatched_and_said(analysis):
    picture = loads_of(analysis, core("A", None, None, None, "1/4"))
    known, unknown = bars(picture, "A")
    assert unknown[2] == "url(#amuros-unknown)"
    assert unknown[0] == known[1]
    assert {"at least 25 %", "unknown part of the worst case"} <= set(contents(picture))


def test_an_overload_goes_beyond_100_percent_and_looks_different(analysis):
    picture = loads_of(analysis, core("A", "1/2", 1, "3/2", "3/2"))
    worst, _ = bars(picture, "A")
    assert worst[1] > full(picture)
    assert worst[2] == "late"
    assert "overload" in contents(picture)
    assert "Bars end at 200 %; the numbers are complete." in contents(loads_of(analysis, core("A", 3, 3, 3, 3)))


def test_of_many_cores_those_with_the_highest_loads_are_drawn(analysis):
    cores = [core(f"C{number}", 0, 0, Fraction(number, 100), Fraction(number, 100)) for number in range(MOST_CORES + 3)]
    picture = loads_of(analysis, *cores)
    assert "3 cores with lower loads not shown." in contents(picture)
    assert f"C{MOST_CORES + 2}" in contents(picture)
    assert "C2" not in contents(picture)


def test_a_model_without_cores_or_processes_says_so(analysis):
    assert "the model has no core" in contents(loads_of(analysis))
    assert "the model has no processes" in contents(draw_responses(replace(analysis, processes=Results())))


def process(analysis, name, worst, deadline, verdict, **terms):
    response = Response(worst=worst, best=1, method="m", source="s", terms=terms or {"own": worst})
    return replace(analysis.processes[0], name=name, response=response, deadline=deadline, verdict=verdict)


def responses_of(analysis, *processes):
    return draw_responses(replace(analysis, processes=Results(processes)))


def test_the_tightest_is_first_after_what_is_missed_or_unknown(analysis):
    rows = [
        process(analysis, "loose", 1 * MS, 10 * MS, Verdict.MET),
        process(analysis, "free", 1 * MS, None, None),
        process(analysis, "tight", 9 * MS, 10 * MS, Verdict.MET),
        replace(process(analysis, "hidden", 1, 10 * MS, Verdict.UNKNOWN), response=None, reason="no bound"),
        process(analysis, "late", 11 * MS, 10 * MS, Verdict.MISSED),
    ]
    picture = responses_of(analysis, process(analysis, NASTY, 1 * MS, 20 * MS, Verdict.MET), *rows)
    assert NASTY in contents(picture)
    names = [content for content in contents(picture) if content in {"loose", "free", "tight", "hidden", "late"}]
    assert names == ["late", "hidden", "tight", "loose", "free"]
    assert {"unknown", "no bound", "90 %", "110 %", "9 ms of 10 ms"} <= set(contents(picture))
    assert_readable(picture)


def test_a_miss_by_a_picosecond_does_not_look_like_a_deadline_that_is_met(analysis):
    picture = responses_of(analysis, process(analysis, "late", 10 * MS + 1, 10 * MS, Verdict.MISSED))
    assert "> 100 %" in contents(picture)
    assert "10.01 ms of 10 ms" in contents(picture)


def test_the_parts_of_a_worst_case_are_as_long_as_their_times(analysis):
    # By hand: Message_Factor takes 2 us, and waits for 25 us of the executor and 4 us of the control function.
    picture = draw_responses(analysis)
    own, interference = (
        float(bar.get("width"))
        for bar in parsed(picture).iter(f"{SVG}rect")
        if (bar.findtext(f"{SVG}title") or "").startswith("Message_Factor:")
    )
    assert interference / own == pytest.approx(29 / 2, rel=0.01)
    assert "Message_Factor: interference 29 us" in picture


def test_a_busy_window_that_begins_before_the_activation_has_a_mark_there(analysis):
    row = process(analysis, "Task", 3 * MS, 10 * MS, Verdict.MET, own=4 * MS, **{"earlier arrival": -1 * MS})
    assert "activation in the busy window" in contents(responses_of(analysis, row))


def test_observed_response_times_are_below_the_bars(analysis):
    system = SAMPLES / "bodas-test-advanced.yaml"
    run = simulate_files(system, Options(duration=Duration(25 * MS))).simulation
    picture = draw_responses(analysis, run)
    # The executor takes 12 us, and 13 us more for a message.
    assert "observed 12 us to 25 us" in picture
    assert "observed" in contents(picture)
    assert_readable(picture)


def test_only_the_tightest_of_many_are_drawn(analysis):
    rows = [process(analysis, f"T{number}", number + 1, 100, Verdict.MET) for number in range(MOST_ROWS + 5)]
    assert "5 processes farther from the deadline not shown." in contents(responses_of(analysis, *rows))


@pytest.mark.parametrize("draw", [draw_loads, draw_responses])
def test_a_picture_describes_itself(analysis, draw):
    root = parsed(draw(analysis))
    assert root.get("role") == "img"
    assert root.findtext(f"{SVG}title")
    assert root.findtext(f"{SVG}desc")


def test_pictures_in_one_page_have_ids_of_their_own(analysis):
    name = ' id="amuros-x" url(#amuros-y)'
    picture = embedded(loads_of(analysis, core(name, None, None, None, 0)), "loads")
    ids = [node.get("id") for node in parsed(picture).iter() if node.get("id")]
    assert ids
    assert all(each.startswith("loads-") for each in ids)
    used = {node.get("fill") for node in parsed(picture).iter(f"{SVG}rect")} - {None}
    assert used == {"url(#loads-unknown)"}
    assert any(name in content for content in contents(picture))
    assert "<style>" not in picture


def test_a_worst_case_of_which_little_is_certain_is_shown_whole(analysis):
    """An executor in a loop may iterate much more often than it must."""
    picture = loads_of(analysis, core("rare", "1/100", "1/100", "1/50", "1/50"), core("often", "1/100", None, "1/10", "1/100"))
    assert "the highest load is that of often: worst 10" in "".join(parsed(picture).itertext())
    assert max(right - left for left, right, _ in bars(picture, "often")) == pytest.approx(
        5 * max(right - left for left, right, _ in bars(picture, "rare")), rel=0.05
    )
