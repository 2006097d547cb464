"""Campaigns: every run is executed once, wherever that is, and its result depends on nothing but the run."""

import csv
import json
import multiprocessing
import os
import pickle
import sys
import time
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing
from fractions import Fraction
from functools import partial

import campaign_jobs
import pytest
from support import ROOT

from amalthea_uros.design.campaign import campaign, executors
from amalthea_uros.design.campaign.campaign import finished_runs, run_campaign
from amalthea_uros.design.campaign.executors import cluster, executor_for, processes, serial
from amalthea_uros.design.campaign.run import CampaignRun, RunOutcome, plan_runs
from amalthea_uros.design.campaign.simulations import SimulationJob
from amalthea_uros.design.campaign.tables import table_format, write_table
from amalthea_uros.design.changes.change import Change, parse_sweep
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.changes.origin import SystemOrigin
from amalthea_uros.errors import InvalidArgumentError, WriteError
from amalthea_uros.services.subject import open_system
from amalthea_uros.simulate.options import Options
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import Duration


def runs(count):
    return plan_runs([], count, 1) if count else ()


def test_each_variant_is_run_with_the_same_seeds():
    found = plan_runs([parse_sweep("A.x=1ms,2ms")], 2, 7)
    first, second = (Change("A", "x", "1ms"),), (Change("A", "x", "2ms"),)
    assert found == (CampaignRun(1, 7, first), CampaignRun(2, 8, first), CampaignRun(3, 7, second), CampaignRun(4, 8, second))


@pytest.mark.parametrize(("repetitions", "message"), [(0, "expected at least 1"), (1_000_001, "has 1,000,001 runs; at most")])
def test_the_number_of_runs_is_limited(repetitions, message):
    with pytest.raises(InvalidArgumentError, match=message):
        plan_runs([], repetitions, 1)


def test_more_values_than_can_be_kept_are_refused_after_the_first_run(monkeypatch):
    monkeypatch.setattr(campaign, "CAMPAIGN_VALUES", 100)
    executed = []

    def job(run):
        executed.append(run.number)
        return {f"c{number}": number for number in range(10)}

    assert len(finished_runs(job, runs(10), serial)) == 10
    executed.clear()
    with pytest.raises(
        InvalidArgumentError, match=r"11 runs with 10 values each .* at most 100 values are kept, those of 10 runs"
    ):
        finished_runs(job, runs(11), serial)
    assert executed == [1]


def test_the_columns_of_a_run_have_numbers_in_internal_units():
    changes = [Change("T", "period", "2 ms"), Change("T", "priority", "3"), Change("C", "frequency", "1.5 MHz")]
    run = CampaignRun(4, 9, (*changes, Change("T", "execution_time", "1us..2us")))
    assert run.columns() == {
        "run": 4,
        "seed": 9,
        "T.period_ps": 2_000_000_000,
        "T.priority": 3,
        "C.frequency_hz": 1_500_000,
        "T.execution_time": "1us..2us",
    }


def squares(outcomes):
    return sorted((outcome.run.number, outcome.record["square"]) for outcome in outcomes)


@pytest.mark.parametrize("count", [0, 1, 50])
def test_every_run_is_executed_once(count):
    found = run_campaign(campaign_jobs.square, runs(count), serial)
    assert squares(found) == [(number, number**2) for number in range(1, count + 1)]


def test_processes_are_others_than_this_one_and_execute_every_run_once():
    outcomes = list(run_campaign(campaign_jobs.square, runs(1500), processes(2)))
    assert squares(outcomes) == [(number, number**2) for number in range(1, 1501)]
    used = {outcome.record["process"] for outcome in outcomes}
    assert os.getpid() not in used
    assert len(used) <= 2


@pytest.mark.parametrize("executor", [serial, processes(2)], ids=["serial", "processes"])
def test_a_run_that_fails_does_not_stop_the_others(executor):
    outcomes = sorted(run_campaign(campaign_jobs.failing, runs(3), executor), key=lambda outcome: outcome.run.number)
    assert [outcome.record for outcome in outcomes] == [{}, {"seed was": 2}, {}]
    assert outcomes[0].error.startswith("KeyError: 'unexpected' (campaign_jobs.py:")
    assert (outcomes[1].error, outcomes[2].error) == ("", "a multiple of three")


def test_nobody_waits_for_a_slow_run(tmp_path):
    job = partial(campaign_jobs.slow_first, folder=tmp_path)
    numbers = []
    for outcome in run_campaign(job, runs(20), processes(2)):
        numbers.append(outcome.run.number)
        (tmp_path / str(outcome.run.number)).touch()
    assert sorted(numbers) == list(range(1, 21))
    assert numbers[0] != 1


def test_a_process_that_dies_is_replaced_and_only_the_run_that_kills_it_twice_is_lost(tmp_path):
    outcomes = list(run_campaign(partial(campaign_jobs.dying, folder=tmp_path), runs(30), processes(2)))
    assert sorted(outcome.run.number for outcome in outcomes) == list(range(1, 31))
    assert [(outcome.run.number, "BrokenProcessPool" in outcome.error) for outcome in outcomes if outcome.error] == [(1, True)]


class Pool:
    """Executes in this process; the first of them breaks when it gets its second run, as if a worker was killed."""

    started = 0

    def __init__(self, _count, _context, *, initializer, initargs):
        self.job = pickle.loads(initargs[0])
        self.open = []
        Pool.started += 1
        self.breaks = Pool.started == 1

    def submit(self, _execute, runs):
        future = Future()
        if self.breaks and self.open:
            self.open[0].set_exception(BrokenProcessPool("killed"))
            raise self.error
        self.open.append(future)
        if not self.breaks:
            future.set_result([RunOutcome(run, dict(self.job(run))) for run in runs])
        return future

    def shutdown(self, **_options):
        pass


@pytest.mark.parametrize(
    "error",
    [
        BrokenProcessPool("a process was terminated abruptly"),
        # It closes its queues while another process is started that shall have them, or that process is the one that is killed.
        OSError("handle is closed"),
        ValueError("bad value(s) in fds_to_keep"),
        BrokenPipeError("broken pipe"),
        # It has noted that it accepts nothing, but not yet why.
        RuntimeError("cannot schedule new futures after shutdown"),
    ],
    ids=lambda error: type(error).__name__,
)
def test_a_process_that_is_killed_while_another_one_starts_loses_nothing(monkeypatch, error):
    monkeypatch.setattr(executors, "ProcessPoolExecutor", Pool)
    monkeypatch.setattr(Pool, "started", 0)
    monkeypatch.setattr(Pool, "error", error, raising=False)
    found = run_campaign(campaign_jobs.square, runs(6), processes(2))
    assert squares(found) == [(number, number**2) for number in range(1, 7)]
    assert Pool.started == 2


def test_a_pool_that_cannot_be_replaced_is_an_error(monkeypatch):
    class Full(Pool):
        def submit(self, _execute, _runs):
            raise OSError("too many open files")

    monkeypatch.setattr(executors, "ProcessPoolExecutor", Full)
    with pytest.raises(OSError, match="too many open files"):
        list(run_campaign(campaign_jobs.square, runs(2), processes(2)))


def test_processes_end_when_a_campaign_is_stopped_early():
    with closing(run_campaign(campaign_jobs.endless, runs(8), processes(2))) as outcomes:
        assert next(outcomes).run.number in (1, 2)
    deadline = time.monotonic() + 30
    while multiprocessing.active_children() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert multiprocessing.active_children() == []


@pytest.fixture(scope="module")
def scheduler():
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as found:
        yield found.scheduler_address


def test_a_cluster_gives_the_same_results(scheduler):
    outcomes = list(run_campaign(campaign_jobs.square, runs(40), cluster(scheduler)))
    assert squares(outcomes) == [(number, number**2) for number in range(1, 41)]
    assert os.getpid() not in {outcome.record["process"] for outcome in outcomes}
    failed = {outcome.run.seed: outcome for outcome in run_campaign(campaign_jobs.failing, runs(3), cluster(scheduler))}
    assert [failed[seed].error[:8] for seed in (1, 2, 3)] == ["KeyError", "", "a multip"]


def test_a_cluster_that_does_not_answer():
    pytest.importorskip("distributed")
    with pytest.raises(InvalidArgumentError, match="no Dask scheduler answers at 'nothing://here'"):
        list(run_campaign(campaign_jobs.square, runs(1), cluster("nothing://here")))


def test_a_cluster_without_workers():
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(n_workers=0, dashboard_address=None) as found,
        pytest.raises(InvalidArgumentError, match="has no workers; start some with 'dask worker"),
    ):
        list(run_campaign(campaign_jobs.square, runs(1), cluster(found.scheduler_address)))


def test_a_cluster_without_the_package(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(InvalidArgumentError, match=r"pip install amuros\[cluster\]"):
        list(run_campaign(campaign_jobs.square, runs(1), cluster("tcp://127.0.0.1:1")))


@pytest.mark.parametrize("path", [ROOT / "samples" / "drive-and-lift.amxmi", ROOT / "samples" / "drive-and-lift.yaml"])
def test_the_job_of_a_simulation_can_be_sent_without_the_model_that_it_comes_from(path):
    options = Options(duration=Duration(10**12), settings=Settings(scale=Fraction(1, 3)))
    origin = SystemOrigin(Configuration(open_system([path]).system, options.settings))
    job = SimulationJob(origin, (Change("A", "x", "1ms"),), options)
    data = pickle.dumps(job)
    assert pickle.loads(data) == job
    assert b"metamodel" not in data
    assert len(data) < path.with_suffix(".amxmi").stat().st_size


ROWS = [
    RunOutcome(CampaignRun(1, 5), {"a": 1, "b": 0.5, "c": 'x, "y"'}).row(),
    RunOutcome(CampaignRun(2, 6), {"a": 2**70, "b": None, "d": "é"}).row(),
    RunOutcome(CampaignRun(3, 7), {}, "failed").row(),
]
COLUMNS = ["run", "seed", "a", "b", "c", "d", "error"]
TABLE = [[1, 5, 1, 0.5, 'x, "y"', None, None], [2, 6, 2**70, None, None, "é", None], [3, 7, None, None, None, None, "failed"]]


def test_a_table_as_csv_and_json(tmp_path):
    write_table(tmp_path / "t.csv", ROWS)
    with (tmp_path / "t.csv").open(encoding="utf-8", newline="") as stream:
        found = list(csv.reader(stream))
    assert found == [COLUMNS, *([("" if value is None else str(value)) for value in row] for row in TABLE)]
    write_table(tmp_path / "t.JSON", ROWS)
    assert json.loads((tmp_path / "t.JSON").read_text("utf-8")) == [dict(zip(COLUMNS, row, strict=True)) for row in TABLE]


def test_a_table_as_parquet(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    write_table(tmp_path / "t.parquet", ROWS)
    found = parquet.read_table(tmp_path / "t.parquet").to_pydict()
    # Numbers beyond 64 bits make a column of texts.
    assert found == {
        column: [value if column != "a" or value is None else str(value) for value in values]
        for column, values in zip(COLUMNS, map(list, zip(*TABLE, strict=True)), strict=True)
    }


def test_runs_are_executed_one_by_one_where_processes_cannot_talk_to_each_other(monkeypatch):
    assert executor_for(2, 2, None) is not serial

    def refuse(*_arguments):
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr(multiprocessing.get_context("spawn"), "Lock", refuse)
    assert executor_for(2, 2, None) is serial


@pytest.mark.parametrize("suffix", ["csv", "json", "parquet"])
def test_a_table_without_rows(suffix, tmp_path):
    if suffix == "parquet":
        pytest.importorskip("pyarrow")
    write_table(tmp_path / f"t.{suffix}", [])
    assert (tmp_path / f"t.{suffix}").exists()


def test_an_interrupted_campaign_without_a_result_keeps_the_former_table(tmp_path):
    (tmp_path / "t.csv").write_text("run,seed\n1,1\n")
    write_table(tmp_path / "t.csv", [])
    assert (tmp_path / "t.csv").read_text() == "run,seed\n1,1\n"


@pytest.mark.parametrize("is_there", [False, True])
def test_a_table_that_is_not_complete_is_written_beside_the_former_one(is_there, tmp_path):
    former = {"t.csv": "run,seed\n1,1\n"} if is_there else {}
    for name, text in former.items():
        (tmp_path / name).write_text(text)
    assert write_table(tmp_path / "t.csv", [], is_complete=False) is None
    assert write_table(tmp_path / "t.csv", ROWS[:1], is_complete=False) == tmp_path / "t.partial.csv"
    lines = {each.name: each.read_text() for each in tmp_path.iterdir()}
    assert lines.pop("t.partial.csv").splitlines()[0] == "run,seed,a,b,c"
    assert lines == former


def test_a_table_that_cannot_be_written(tmp_path, monkeypatch):
    with pytest.raises(InvalidArgumentError, match=r"expected one of \.csv, \.json, \.parquet"):
        table_format(tmp_path / "t.xlsx")
    with pytest.raises(WriteError, match="cannot be written"):
        write_table(tmp_path / "missing" / "t.csv", ROWS)
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(InvalidArgumentError, match=r"pip install amuros\[pandas\]"):
        table_format(tmp_path / "t.parquet")
