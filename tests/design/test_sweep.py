"""Sweeps: each variant is what an analysis with the same change says; samples are subsets of the grid."""

import pytest
from command import amuros as run_amuros
from support import ROOT

import amalthea_uros as amuros
from amalthea_uros.design.changes.change import parse_sweep, sampled, variants
from amalthea_uros.errors import InvalidArgumentError

YAML = ROOT / "samples" / "bodas-test-advanced.yaml"
LATENCY = "factor-to-output.max_reduced_reaction_time_ps"
TASKS = amuros.taskset([(10, 1), (20, 4)], unit="ms", priorities="rate monotonic")
PERIODS = {"Message_Factor.period": ["5 ms", "10 ms", "20 ms"]}


def test_each_variant_is_an_analysis_with_its_changes():
    rows = amuros.sweep(YAML, PERIODS).to_records()
    for row, period in zip(rows, PERIODS["Message_Factor.period"], strict=True):
        chain = amuros.analyze(YAML, changes={"Message_Factor.period": period}).chains["factor-to-output"]
        assert row[LATENCY] == chain.value(amuros.LatencyQuantity.MAX_REDUCED_REACTION_TIME).value
        assert row["schedulable"] == "yes"
    # S. R. Bappanadu's application: the period of Message_Factor less 1 ms, a period of the timer, and its response time.
    assert [row[LATENCY] for row in rows] == [5_016_000_000, 10_016_000_000, 20_029_000_000]


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
    done = run_amuros("sweep", YAML, *sweeps, "--table", table)
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
