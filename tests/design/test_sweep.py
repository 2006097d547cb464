"""Sweeps: their values and combinations, samples of them, and that each variant is what an analysis with the same change says."""

from fractions import Fraction

import pytest
from command import amuros as run_amuros
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT

import amalthea_uros as amuros
from amalthea_uros.design.changes.change import MAX_VARIANTS, Change, Sweep, parse_sweep, sampled, variants
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.units import TIME, parse, parse_frequency, parse_time

YAML = ROOT / "samples" / "bodas-test-advanced.yaml"
LATENCY = "factor-to-output.max_reduced_reaction_time_ps"
TASKS = amuros.taskset([(10, 1), (20, 4)], unit="ms", priorities="rate monotonic")
PERIODS = {"Message_Factor.period": ["1 ms", "10 ms", "20 ms"]}


def test_each_variant_is_an_analysis_with_its_changes():
    rows = amuros.sweep(YAML, PERIODS).to_records()
    chain = amuros.analyze(YAML, changes={"Message_Factor.period": "1 ms"}).chains["factor-to-output"]
    assert rows[0][LATENCY] == chain.value(amuros.LatencyQuantity.MAX_REDUCED_REACTION_TIME).value
    assert {row["schedulable"] for row in rows} == {"yes"}
    # S. R. Bappanadu's application: the period of Message_Factor less 1 ms, a period of the timer, and its response time.
    # With 1 ms, the order of rates has no place for the callback between its executor and the timer: both end before it.
    assert [row[LATENCY] for row in rows[1:]] == [10_016_000_000, 20_029_000_000]


def test_other_results_depend_on_neither_workers_nor_their_number():
    sweeps = ["T1.execution_time=1ms,2ms", "T2.period=10ms,20ms"]
    assert amuros.sweep(TASKS, sweeps, workers=2).to_records() == amuros.sweep(TASKS, sweeps).to_records()


def test_the_reserve_of_a_variant_is_that_of_its_analysis():
    rows = amuros.sweep(TASKS, {"T1.execution_time": ["2 ms", "8 ms"]}, with_growth=True).to_records()
    changed = amuros.analyze(TASKS, changes=["T1.execution_time=2ms"])
    assert rows[0]["maximum_growth"] == float(amuros.sensitivity(changed).everything)
    # Both tasks together need 2 * 2 + 4 or 2 * 8 + 4 of 20 ms, so that they may grow to 20/8 or 1, in steps of the search.
    assert [row["maximum_growth"] for row in rows] == pytest.approx([2.5, 1], abs=0.01)


def test_a_sample_has_other_variants_for_other_seeds_and_none_twice():
    sweeps = [parse_sweep("A.period=1ms..50ms/1ms"), parse_sweep("B.period=1ms..40ms/1ms")]
    grid = list(variants(sweeps))
    samples = [list(sampled(sweeps, 30, seed)) for seed in (1, 1, 2)]
    assert samples[0] == samples[1] != samples[2]
    for sample in samples:
        places = [grid.index(variant) for variant in sample]
        assert len(places) == 30
        assert places == sorted(set(places))
    assert list(sampled(sweeps, 5000, 1)) == grid


def test_a_variant_that_cannot_be_is_told_and_the_others_are_there(tmp_path):
    table = tmp_path / "all.csv"
    sweeps = ("--sweep", "Control_Function.execution_time=4us,1200us", "--sweep", "Message_Factor.priority=1,5")
    done = run_amuros("sweep", ROOT / "samples" / "executor.amxmi", *sweeps, "--table", table)
    assert done.returncode == 1
    assert len(table.read_text().splitlines()) == 5
    assert "Schedulable: yes in 2 of 4 variants, no in 2" in done.stdout


@pytest.mark.parametrize(
    ("sweeps", "reason"),
    [
        ({"Nobody.period": ["1 ms"]}, "unknown object 'Nobody'"),
        ({"Executor_Task.period": []}, "has no values"),
        ([], "nothing is swept"),
        (["Executor_Task.period=1ms,2ms", "Executor_Task.period=3ms"], "swept more than once"),
        ({"Executor_Task.period": ["often"]}, "often"),
    ],
)
def test_what_cannot_be_swept_is_refused_before_anything_is_analysed(sweeps, reason):
    with pytest.raises(InvalidArgumentError, match=reason):
        amuros.sweep(YAML, sweeps)


def test_an_unknown_quantity_is_refused():
    with pytest.raises(InvalidArgumentError, match="did you mean"):
        amuros.sweep(TASKS, {"T1.period": ["10 ms"]}).column("T1.worst_case_response_tim")


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
