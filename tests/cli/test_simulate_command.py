"""`amuros simulate` as its user sees it, with a simulation of which the observations are known beforehand."""

import json
import re
import signal
import subprocess
import sys
import textwrap
import time
from fractions import Fraction
from types import ModuleType

import numpy as np
import pytest
from command import amuros
from lxml import etree
from support import ROOT

from amalthea_uros._internal.by_name import Results
from amalthea_uros.cli.main import main
from amalthea_uros.services.simulate import simulate
from amalthea_uros.simulate.observations import (
    CoreObservation,
    CountObservation,
    MetricObservation,
    ObservedOccurrence,
    ProcessObservation,
    TimeHistogram,
)
from amalthea_uros.simulate.results import ObservedVerdict, Simulation
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.trace.table import NO_NOTE, Entity, EntityKind, EventKind, EventTable

ADVANCED = ROOT / "samples" / "bodas-test-advanced.yaml"
US, MS = 10**6, 10**9
ENTITIES = (Entity(EntityKind.STIMULUS, "tick"), Entity(EntityKind.TASK, "Control_Function"), Entity(EntityKind.CORE, "Core_0"))


def simulate_system(system, options, sinks=()):
    """One process, of which all jobs have a response time of as many microseconds as the seed, and the deadline is the period."""
    (stimulus,) = system.processes["Control_Function"].stimuli
    period, response = system.stimuli_by_name[stimulus].period, options.seed * US
    if options.seed == 13:
        raise KeyboardInterrupt
    if options.seed == 14:
        raise ArithmeticError("fourteen")
    for open_sink in sinks:
        assert options.traced is not None
        with open_sink(ENTITIES) as sink:
            sink.write(events(response, *options.traced, period))
    observed = MetricObservation(
        count=options.duration // period,
        min=Fraction(response),
        mean=Fraction(response),
        max=Fraction(response),
        std=0.0,
        at_min=ObservedOccurrence(instance=0, time=Fraction(0)),
        at_max=ObservedOccurrence(instance=0, time=Fraction(0)),
        histogram=TimeHistogram(start=Fraction(response), width=Fraction(1), counts=(options.duration // period,)),
    )
    process = ProcessObservation(
        name="Control_Function",
        is_isr=False,
        core="Core_0",
        priority=2,
        jobs=options.duration // period,
        load=Fraction(response, period),
        metrics={JobMetric.RESPONSE_TIME: observed},
        preemptions=CountObservation(total=0, min=0, max=0),
        migrations=CountObservation(total=0, min=0, max=0),
        deadline=period,
        is_implicit=True,
        verdict=ObservedVerdict.MISSED if response > period else ObservedVerdict.OK,
    )
    return Simulation(
        duration=options.duration,
        seed=options.seed,
        mode=options.mode,
        cores=Results([CoreObservation(name="Core_0", load=process.load)]),
        processes=Results([process]),
    )


def events(response, start, end, period):
    jobs = [job for job in range(end // period + 1) if start <= job * period <= end]
    rows = [
        row
        for job in jobs
        for row in (
            (job * period, EventKind.ACTIVATE, 0, 1, job),
            (job * period, EventKind.START, 2, 1, job),
            (job * period + response, EventKind.TERMINATE, 2, 1, job),
        )
        if row[0] <= end
    ]
    time, kind, source, target, instance = (np.array(column) for column in zip(*rows, strict=True))
    zeros, notes = np.zeros(len(rows), np.int64), np.full(len(rows), NO_NOTE)
    return EventTable(
        ENTITIES, time, kind.astype(np.int16), source.astype(np.int32), zeros, target.astype(np.int32), instance, notes
    )


@pytest.fixture
def run(monkeypatch, capsys):
    """Calls the command in this process; gives the exit code, and what it wrote."""
    module = ModuleType("amalthea_uros.simulate.runs.run")
    module.simulate_system = simulate_system
    monkeypatch.setitem(sys.modules, module.__name__, module)

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["amuros", "simulate", *map(str, arguments)])
        with pytest.raises(SystemExit) as ending:
            main()
        return ending.value.code or 0, *capsys.readouterr()

    return call


def test_one_run(run, tmp_path):
    code, output, _ = run(ADVANCED, "--duration", "5min", "--output", "text", "--output", f"json={tmp_path / 'r.json'}")
    assert code == 0
    assert "Control_Function" in output
    assert output.splitlines()[-1].startswith("Observed over 5 min (seed 1)")
    result = json.loads((tmp_path / "r.json").read_text())
    assert (result["model"], result["duration_ps"], result["seed"]) == (str(ADVANCED), 300 * 10**12, 1)


def test_a_missed_limit_makes_the_exit_code_1(run):
    assert run(ADVANCED, "--seed", 999)[0] == 0
    assert run(ADVANCED, "--seed", 1001)[0] == 1
    assert run(ADVANCED.with_suffix(".amxmi"), "--seed", 1001, "--set", "Control_Function.period=2ms")[0] == 0


def test_changes_and_failures_are_shown_beside_the_result(run, tmp_path):
    arguments = ("--set", "Control_Function.period=2ms", "--seed", 2001, "--output", f"json={tmp_path / 'r.json'}")
    code, output, errors = run(ADVANCED, *arguments)
    assert (code, output) == (1, "")
    changed, closing = errors.splitlines()
    assert changed == "Control_Function.period: 1 ms -> 2 ms"
    assert closing.startswith("Observed over 1 s (seed 2001)")
    assert run(ADVANCED, *arguments, "--runs", 2, "--jobs", 1)[0] == 1
    assert json.loads((tmp_path / "r.json").read_text())["changes"] == [
        {"key": "Control_Function.period", "from": "1 ms", "to": "2 ms", "consequence": False}
    ]


@pytest.mark.parametrize("runs", [1, 2])
def test_a_run_in_which_nothing_happens_makes_the_exit_code_1_and_says_so(runs, run):
    code, output, _ = run(ADVANCED, "--duration", "999us", "--runs", runs, "--jobs", 1)
    assert code == 1
    assert "nothing was executed" in output


@pytest.mark.parametrize("runs", [1, 2])
def test_a_process_that_is_left_out_makes_the_exit_code_1_and_the_closing_line_says_so(runs, tmp_path):
    # The first task of the sample without its allocation.
    model = re.sub(
        "<taskAllocation .*?</taskAllocation>", "", (ROOT / "samples" / "executor.amxmi").read_text(), count=1, flags=re.DOTALL
    )
    (tmp_path / "m.amxmi").write_text(model)
    done = amuros("simulate", tmp_path / "m.amxmi", "--duration", "40ms", "--runs", str(runs), "--jobs", "1")
    assert done.returncode == 1, done.stderr
    assert "is not simulated: it is not allocated to a scheduler" in done.stdout


def test_a_table_of_all_variants_and_seeds(run, tmp_path):
    code, output, errors = run(
        ADVANCED.with_suffix(".amxmi"),
        *("--seed", 500, "--runs", 2, "--jobs", 1, "--sweep", "Control_Function.period=250us..750us/0.25ms"),
        *("--sweep", "Core_0.frequency=1MHz,2MHz", "--table", tmp_path / "t.json"),
    )
    rows = json.loads((tmp_path / "t.json").read_text())
    assert [(row["run"], row["Control_Function.period_ps"] // US, row["Core_0.frequency_hz"], row["seed"]) for row in rows] == [
        (4 * i + 2 * j + k + 1, period, frequency, 500 + k)
        for i, period in enumerate((250, 500, 750))
        for j, frequency in enumerate((10**6, 2 * 10**6))
        for k in range(2)
    ]
    # The response time is 500 or 501 us: longer than the period of 250 us, and once longer than that of 500 us.
    missed = [row["run"] for row in rows if row["Control_Function.verdict"] == "observed_missed"]
    assert missed == [1, 2, 3, 4, 6, 8]
    assert {row["Control_Function.response_time.max_ps"] for row in rows} == {500 * US, 501 * US}
    assert code == 1
    assert "limits missed or activations lost in 6" in output.splitlines()[-1]
    assert errors == ""


def test_the_result_of_a_campaign_as_json(run, tmp_path):
    assert run(ADVANCED, "--runs", 2, "--jobs", 1, "--output", f"json={tmp_path / 'r.json'}")[0] == 0
    result = json.loads((tmp_path / "r.json").read_text())
    assert (result["model"], result["planned_runs"], [row["seed"] for row in result["runs"]]) == (str(ADVANCED), 2, [1, 2])


def test_a_run_that_fails_has_its_error_in_the_table(run, tmp_path):
    code, output, _ = run(ADVANCED, "--seed", 14, "--runs", 2, "--jobs", 1, "--table", tmp_path / "t.csv")
    assert code == 1
    header, first, second = (line.split(",") for line in (tmp_path / "t.csv").read_text().splitlines())
    assert first[header.index("error")].startswith("ArithmeticError: fourteen")
    assert second[header.index("error")] == ""
    assert "1 run failed" in output


def test_ctrl_c_keeps_the_runs_that_are_finished(run, tmp_path):
    (tmp_path / "t.json").write_text("a full table")
    (tmp_path / "r.json").write_text("a full result")
    files = ("--table", tmp_path / "t.json", "--output", f"json={tmp_path / 'r.json'}", "--output", "text")
    code, output, errors = run(ADVANCED, "--seed", 10, "--runs", 9, "--jobs", 1, *files)
    assert code == 130
    assert [(tmp_path / f"{name}.json").read_text() for name in "tr"] == ["a full table", "a full result"]
    assert len(json.loads((tmp_path / "r.partial.json").read_text())["runs"]) == 3
    assert [row["seed"] for row in json.loads((tmp_path / "t.partial.json").read_text())] == [10, 11, 12]
    assert f"the table is not complete; it is in '{tmp_path / 't.partial.json'}'" in errors
    assert "interrupted: 3 of 9 runs finished" in errors
    assert "Observed in 3 of 9 runs" in output


@pytest.mark.parametrize(
    ("end", "printed", "code"),
    [("os.killpg(0, signal.SIGINT)", "[1, 2]\n", 0), ("os.kill(os.getpid(), signal.SIGKILL)", "", -signal.SIGKILL)],
    ids=["Ctrl-C", "SIGKILL"],
)
def test_processes_end_with_the_one_that_started_them(end, printed, code, tmp_path):
    script = tmp_path / "campaign.py"
    script.write_text(
        textwrap.dedent("""
        import os, signal, sys, threading, time
        import campaign_jobs
        from amalthea_uros.design.campaign.campaign import run_campaign
        from amalthea_uros.design.campaign.executors import processes
        from amalthea_uros.design.campaign.run import plan_runs

        if __name__ == "__main__":
            numbers = []
            try:
                for outcome in run_campaign(campaign_jobs.endless, plan_runs([], 8, 1), processes(2)):
                    numbers.append(outcome.run.number)
                    if len(numbers) == 2:
                        END
            except KeyboardInterrupt:
                print(sorted(numbers))
        """).replace("END", end)
    )
    # Processes that remained would keep the standard output open.
    run = subprocess.run(
        [sys.executable, script],
        capture_output=True,
        text=True,
        check=False,
        timeout=100,
        start_new_session=True,
        env={"PYTHONPATH": f"{ROOT}:{ROOT / 'tests' / 'design'}", "PATH": ""},
    )
    assert (run.stdout, run.returncode) == (printed, code)
    assert code != 0 or run.stderr == ""


def test_a_trace_of_a_part_of_the_run(run, tmp_path):
    assert run(ADVANCED, "--trace", tmp_path / "all.csv", "--duration", "5ms")[0] == 0
    assert run(ADVANCED, "--trace", tmp_path / "part.csv", "--trace-window", "2ms..3ms", "--duration", "5ms")[0] == 0
    times = {
        name: [int(line.split(",")[0]) for line in (tmp_path / f"{name}.csv").read_text().splitlines()[1:]]
        for name in ("all", "part")
    }
    assert set(times["all"]) == {job * MS + at for job in range(6) for at in (0, US) if job * MS + at <= 5 * MS}
    assert set(times["part"]) == {2 * MS, 2 * MS + US, 3 * MS}


def test_an_interrupted_run_leaves_no_trace(tmp_path):
    trace = tmp_path / "long.btf"
    command = [sys.executable, "-m", "amalthea_uros", "simulate", ADVANCED, "--duration", "10h", "--trace", trace]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        while not any(tmp_path.iterdir()):  # what has been written so far
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate()
    assert (process.returncode, output) == (130, "")
    assert errors == "interrupted: the run is not finished; traces of unfinished runs are not kept\n"
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_before_the_run_is_no_finding(run, monkeypatch):
    def interrupted(*_arguments, **_options):
        raise KeyboardInterrupt

    monkeypatch.setattr("amalthea_uros.services.changed.open_system", interrupted)
    assert run(ADVANCED) == (130, "", "interrupted\n")


def test_a_dash_is_standard_output(run):
    assert json.loads(run(ADVANCED, "--output", "json=-")[1])["duration_ps"] == 1000 * MS


def test_pictures(run, tmp_path):
    paths = {name: tmp_path / f"{name}.svg" for name in ("gantt", "timeline", "histogram")}
    code, _, errors = run(
        ADVANCED,
        *("--duration", "10ms", "--gantt", paths["gantt"], "--window", "0ms..3ms"),
        *("--timeline", f"Control_Function={paths['timeline']}", "--histogram", f"Control_Function={paths['histogram']}"),
    )
    assert (code, errors) == (0, "")
    texts = {name: " ".join(etree.parse(path).getroot().itertext()) for name, path in paths.items()}
    assert all("Control_Function" in text for text in texts.values())
    assert "deadline" in texts["histogram"]


def test_pictures_show_the_worst_job_by_default(run, tmp_path):
    assert run(ADVANCED, "--duration", "10ms", "--gantt", tmp_path / "g.svg", "--seed", 100)[0] == 0
    # The job from 0 to 100 us, with a margin of a tenth.
    assert "110 us" in " ".join(etree.parse(tmp_path / "g.svg").getroot().itertext())


WRONG = {
    "a duration without unit": (["--duration", "5"], "has no unit"),
    "a duration of nothing": (["--duration", "0s"], "greater than zero"),
    "a change of nothing": (["--set", "Control_Function.period"], "OBJECT.KEY=VALUE"),
    "an unknown object": (["--set", "Control.period=1ms"], "unknown object 'Control'; did you mean 'Control_Function'"),
    "an unknown object of a sweep": (["--sweep", "Control.period=1ms,2ms"], "unknown object 'Control'"),
    "a value of a sweep that is wrong": (["--sweep", "Control_Function.period=1ms,2"], "'2' has no unit"),
    "a sweep without steps": (["--sweep", "Control_Function.period=1ms..2ms"], "has no step"),
    "a message that does not exist": (["--phase", "Nothing=1ms"], "'Nothing'"),
    "an unknown label": (["--labels", "memory_1, memory3"], "unknown label 'memory3'; did you mean"),
    "an unknown label of many runs": (["--labels", "memory3", "--runs", "2"], "unknown label 'memory3'"),
    "a core that does not exist": (["--frequency", "Core_9=1MHz"], "unknown core 'Core_9'"),
    "a window that ends before it starts": (["--window", "3ms..1ms"], "not a range of times"),
    "a window of a trace without trace": (["--trace-window", "1ms..2ms"], "--trace-window needs --trace"),
    "a trace of many runs": (["--trace", "t.btf", "--runs", "2"], "of a single run"),
    "a picture of many runs": (["--gantt", "g.svg", "--sweep", "Control_Function.period=1ms,2ms"], "of a single run"),
    "a table of an unknown kind": (["--table", "t.xlsx"], r"expected one of .csv, .json, .parquet"),
    "a table in the place of the model": (["--table", ADVANCED], "would replace a file that is read"),
    "a trace in the place of the model": (["--trace", ADVANCED], "would replace a file that is read"),
    "a trace of an unknown kind": (["--trace", "t.xyz"], "no trace format is known"),
    "a process that does not exist": (["--timeline", "X=x.svg"], "unknown process 'X'"),
    "a histogram of nothing": (["--histogram", "X=x.svg"], "unknown process or chain 'X'"),
    "a quantity that does not exist": (
        ["--histogram", "Control_Function.load=x.svg"],
        "unknown quantity with a histogram 'load'",
    ),
    "a quantity of which no values are kept": (
        ["--histogram", "Control_Function.slack_time=x.svg"],
        "unknown quantity with a histogram 'slack_time'; known: net_execution_time, response_time",
    ),
    "a chain that does not exist": (["--gantt", "g.svg", "--chain", "X"], "unknown chain 'X'; known: factor-to-output"),
    "a process of the chart that does not exist": (["--gantt", "g.svg", "--gantt-of", "X"], "unknown process 'X'"),
    "a chain without a chart": (["--chain", "factor-to-output"], "add --gantt FILE"),
    "two choices of a window": (
        ["--gantt", "g.svg", "--gantt-of", "Control_Function", "--window", "1ms..2ms"],
        "--gantt-of and --window each choose what --gantt shows",
    ),
    "a trace window after the end": (["--trace", "t.btf", "--trace-window", "3s..4s"], "the run ends at 1 s"),
    "a window after the end": (["--window", "3s..4s", "--gantt", "g.svg"], "the run ends at 1 s"),
    "a window of nothing": (["--window", "1ms..2ms"], "--window chooses what --gantt and --timeline show"),
    "a file for two pictures": (["--gantt", "g.svg", "--timeline", "Control_Function=g.svg"], "g.svg is the file of 2 options"),
    "a file for a result and a table": (["--output", "json=x.json", "--table", "x.json"], "x.json is the file of 2 options"),
    "a result that cannot be written": (
        ["--output", "json=nowhere/x.json"],
        "nowhere/x.json: XMI101 error: the file cannot be",
    ),
    "a table that cannot be written": (["--table", "nowhere/x.csv"], "nowhere/x.csv: XMI101 error: the file cannot be written"),
    "a picture that cannot be written": (
        ["--gantt", "nowhere/x.svg"],
        "nowhere/x.svg: XMI101 error: the file cannot be written",
    ),
    "a trace that cannot be written": (["--trace", "nowhere/x.btf"], "nowhere/x.btf: TRC101 error: the file cannot be written"),
    "metrics of many runs": (["--metrics", "--runs", "2"], "--table FILE has the metrics of all runs"),
    "a cluster for one run": (["--cluster", "tcp://nowhere:8786"], "--cluster executes the runs of --sweep or --runs"),
    "no runs": (["--runs", "0"], "x>=1"),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_use_writes_nothing(case, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    arguments, message = WRONG[case]
    code, output, errors = run(ADVANCED, *arguments)
    assert (code, output) == (2, "")
    assert message in " ".join(errors.split())
    assert list(tmp_path.iterdir()) == []


def test_the_library_takes_texts_and_systems(run):
    from amalthea_uros.services.subject import open_system

    found = simulate(open_system([ADVANCED]).system, "10 ms", seed=7, mode="worst", changes=["Control_Function.period=2ms"])
    assert (found.duration, found.seed, found.mode) == (10 * MS, 7, "worst")
    assert found["Control_Function"].jobs == 5
    assert simulate(ADVANCED, "10 ms")["Control_Function"].jobs == 10
    assert simulate([ADVANCED.with_suffix(".amxmi")], "10 ms")["Control_Function"].jobs == 10
    with pytest.raises(ValueError, match="'5' has no unit"):
        simulate(ADVANCED, "5")
    with pytest.raises(ValueError, match="unknown mode 'fast'; expected one of sampled, worst, best, average"):
        simulate(ADVANCED, "5s", mode="fast")


@pytest.mark.early
def test_processes_give_the_same_table(tmp_path):
    tables = []
    for jobs in (1, 2):
        arguments = (
            "--duration",
            "40ms",
            "--runs",
            3,
            "--sweep",
            "Control_Function.execution_time=4us,1us..9us",
            "--jobs",
            jobs,
        )
        finished = amuros("simulate", ADVANCED, *arguments, "--table", tmp_path / "t.csv")
        assert (finished.returncode, finished.stderr) == (0, "")
        tables.append((tmp_path / "t.csv").read_text())
    assert tables[0] == tables[1]
    assert len(tables[0].splitlines()) == 7


def test_help_says_how_to_write_changes_and_sweeps():
    output = " ".join(amuros("simulate", "--help").stdout.split())
    assert "Executor_Task.period=2ms" in output
    assert "Executor_Task.period=1ms..10ms/1ms" in output
