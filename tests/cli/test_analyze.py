"""`amuros analyze` as its user sees it."""

import json
import shutil
from functools import cache

import pytest
from command import amuros
from support import ROOT

ADVANCED = ROOT / "samples" / "bodas-test-advanced.yaml"
RCLC = ROOT / "samples" / "rclc-in-executor.yaml"


@cache
def explained(model, name):
    """What several tests look at."""
    return amuros("analyze", model, "--explain", name)


@pytest.mark.parametrize("path", [ADVANCED, ADVANCED.with_suffix(".amxmi")], ids=["yaml", "amxmi"])
def test_the_machine_readable_result(path, tmp_path):
    run = amuros("analyze", path, "--output", f"json={tmp_path / 'r.json'}")
    assert (run.returncode, run.stdout) == (0, "")
    result = json.loads((tmp_path / "r.json").read_text())
    assert result["model"] == str(path)
    assert result["assumptions"]
    (processor,) = result["processors"]
    assert processor["utilisation"]["acet"] == pytest.approx(0.01265 + 0.004 + 0.0001)
    control = next(process for process in result["processes"] if process["name"] == "Control_Function")
    assert (control["kind"], control["processor"], control["preemption"]) == ("task", "Core_0", "preemptive")
    assert (control["bcet_ps"], control["acet_ps"], control["wcet_ps"]) == (4_000_000, 4_000_000, 4_000_000)
    assert (control["bcrt_ps"], control["wcrt_ps"], control["deadline_ps"]) == (16_000_000, 29_000_000, 10**9)
    assert (control["verdict"], control["claim"]) == ("met", "exact")
    assert control["terms"] == {"own_ps": 4_000_000, "interference_ps": 25_000_000, "blocking_ps": 0}
    requirements = {
        limit["name"]: (limit["limit_ps"], limit["value_ps"], limit["margin_ps"], limit["verdict"])
        for limit in result["requirements"]
    }
    assert requirements == {
        "Control_Function_response_time": (10**9, 29_000_000, 971_000_000, "met"),
        "factor-to-output_reaction": (25 * 10**9, 20_029_000_000, 4_971_000_000, "met"),
    }
    (chain,) = result["chains"]
    assert (chain["name"], chain["communication"]) == ("factor-to-output", "implicit")
    values = {value["quantity"]: (value["value_ps"], value["claim"]) for value in chain["values"]}
    assert values["max_reduced_reaction_time"] == (20_029_000_000, "exact")


def test_metrics_of_processes(tmp_path):
    run = amuros("analyze", ADVANCED, "--metrics", "--output", "text", "--output", f"json={tmp_path / 'r.json'}")
    section = [line.split() for line in run.stdout[run.stdout.index("Metrics of Control_Function") :].splitlines()]
    # Figure 6.6 of the thesis.
    for row in (
        "gross execution time 4 us 4 us 4 us exact",
        "initial pending time 12 us 12.65 us 25 us exact",
        "start to start 987 us 1 ms 1.013 ms exact",
    ):
        assert row.split() in section
    assert "Metrics of" not in amuros("analyze", ADVANCED).stdout
    processes = json.loads((tmp_path / "r.json").read_text())["processes"]
    control = next(process for process in processes if process["name"] == "Control_Function")
    assert (control["mean_response_ps"], control["response_jitter_ps"]) == (16_650_000, 13_000_000)
    assert control["metrics"]["slack_time"] == {
        "min_ps": 971_000_000,
        "avg_ps": 983_350_000,
        "max_ps": 984_000_000,
        "claim": "exact",
    }


def test_callbacks_in_the_executor(tmp_path):
    run = amuros("analyze", RCLC, "--output", "text", "--output", f"json={tmp_path / 'r.json'}")
    assert "On_Imu_Callback      rclc_executor    161 us  165.5 us  192.8 us     10 ms  exact" in run.stdout
    callbacks = json.loads((tmp_path / "r.json").read_text())["callbacks"]
    assert [callback["name"] for callback in callbacks] == ["On_Imu_Callback", "On_Command_Callback", "Control_Callback"]
    imu = callbacks[0]
    assert (imu["process"], imu["bcrt_ps"], imu["wcrt_ps"], imu["deadline_ps"], imu["claim"]) == (
        "rclc_executor",
        161_000_000,
        192_800_000,
        10 * 10**9,
        "exact",
    )
    assert (imu["mean_response_ps"], imu["metrics"]["net_execution_time"]["max_ps"]) == (165_460_000, 90_000_000)


def test_a_missed_requirement(tmp_path):
    path = tmp_path / "app.yaml"
    path.write_text(ADVANCED.read_text().replace("response_time: 1 ms", "response_time: 20 us"))
    run = amuros("analyze", path)
    assert run.returncode == 1
    assert "at most 20 us     29 us  missed      -9 us" in run.stdout
    # By priority, whatever is missed.
    assert run.stdout.index("Executor_Task") < run.stdout.index("Control_Function  Core_0")


def test_overload(tmp_path):
    path = tmp_path / "app.yaml"
    path.write_text(ADVANCED.read_text())
    run = amuros("analyze", path, "--scale", "80")
    assert run.returncode == 1
    assert "unbounded" in run.stdout
    assert "overload: tasks at this priority or higher need" in run.stdout
    assert "####################!" in run.stdout


def test_another_clock(tmp_path):
    run = amuros("analyze", ADVANCED, "--frequency", "Core_0=2MHz", "--explain", "Control_Function")
    assert run.stdout.startswith("Control_Function: worst-case response time 14.5 us (exact)")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--frequency", "Core_9=2MHz"], "unknown core 'Core_9'; did you mean 'Core_0'?"),
        (["--frequency", "Core_0=2"], "has no unit"),
        (["--frequency", "Core_0=0MHz"], "greater than zero"),
        (["--explain", "Nothing"], "unknown process, callback or chain 'Nothing'; known: Executor_Task"),
        (["--chain", "x"], "unknown chain 'x'"),
        (["--scale", "0"], "0"),
        (["--scale", "nan"], "'nan' is not a finite number"),
        (["--scale", "1e400"], "'1e400' is not a finite number"),
        (["--quantile", "nan"], "'nan' is not a finite number"),
        (["--quantile", "0.5"], "0<x<0.5"),
        (["--mode-label", "speed"], "not of the form LABEL=VALUE"),
        (["--mode-label", "speed=1"], "unknown mode label 'speed'; the model has no mode label"),
        (["--memory", "cached"], "'cached'"),
    ],
)
def test_wrong_use(arguments, message):
    run = amuros("analyze", ADVANCED, *arguments)
    assert run.returncode == 2
    assert message in run.stderr
    assert "Traceback" not in run.stderr


def test_files_that_cannot_be_read(tmp_path):
    assert amuros("analyze", tmp_path / "none.yaml").returncode == 2
    assert amuros("analyze", tmp_path / "none.amxmi").returncode == 2
    broken = shutil.copy(ADVANCED, tmp_path / "broken.amxmi")
    assert amuros("analyze", broken).returncode == 2


def test_sensitivity_and_priorities(tmp_path):
    run = amuros(
        "analyze",
        ADVANCED,
        # The phase in which messages meet the most; with all of them it takes twenty times as long.
        "--phase",
        "Message_Factor=0ms",
        "--sensitivity",
        "--assign-priorities",
        "--output",
        "text",
        "--output",
        f"json={tmp_path / 'r.json'}",
    )
    assert run.returncode == 0
    assert "Maximum factors on execution times" in run.stdout
    assert "the present priorities meet all deadlines" in run.stdout
    result = json.loads((tmp_path / "r.json").read_text())
    assert result["sensitivity"]["everything"] == pytest.approx(1000 / 29, rel=1e-3)
    assert result["priorities"][0]["outcome"] == "kept"


def test_proposed_priorities(tmp_path):
    path = tmp_path / "app.yaml"
    path.write_text(
        "amuros: 1\nname: app\nhardware: single-core\ntasks:\n"
        "  - {name: Slow, period: 20 ms, execution_time: 5 ms, deadline: 20 ms, priority: 2}\n"
        "  - {name: Fast, period: 5 ms, execution_time: 1 ms, deadline: 2 ms, priority: 1}\n"
    )
    run = amuros("analyze", path, "--assign-priorities")
    assert run.returncode == 1
    assert "  Fast    1         2\n  Slow    2         1\n" in run.stdout, run.stdout + run.stderr


def test_a_wire_has_no_clock_that_could_be_another_one():
    """The waits of its driver would be scaled, too."""
    run = amuros("analyze", ROOT / "samples" / "robot-xrce.yaml", "--frequency", "TCP_to_agent=1GHz")
    assert run.returncode == 2
    assert "'TCP_to_agent' is a wire" in run.stderr


@pytest.mark.parametrize(
    ("offset", "deadline", "message"),
    [
        # Each of them takes 4 ms: together they need 8 ms, 5 ms apart only 4 ms each.
        ("5 ms", "4 ms", "  the present priorities meet all deadlines\n"),
        (
            "0 ms",
            "4 ms",
            "  no proposal: no assignment of distinct priorities meets all deadlines: at the lowest priority, each task misses its "
            "deadline: 'A' by up to 4 ms, 'B' by up to 4 ms\n",
        ),
    ],
)
def test_no_other_priorities(offset, deadline, message, tmp_path):
    path = tmp_path / "app.yaml"
    task = f"period: 10 ms, execution_time: 4 ms, deadline: {deadline}"
    path.write_text(
        "amuros: 1\nname: app\nhardware: single-core\ntasks:\n"
        f"  - {{name: A, priority: 1, {task}, offset: 0 ms}}\n  - {{name: B, priority: 2, {task}, offset: {offset}}}\n"
    )
    run = amuros("analyze", path, "--assign-priorities")
    assert message in run.stdout


def test_a_phase_that_is_stated_for_one_analysis():
    run = amuros("analyze", ADVANCED, "--phase", "Message_Factor=5ms")
    assert run.returncode == 0
    # The message is taken 15 ms before the next job of Message_Factor, which waits for 12 us + 4 us.
    assert "  Message_Factor    Core_0         1   2 us  18 us  18 us" in run.stdout
    assert "is due regularly, in one of 20 jobs of Executor_Task, first in job 6, at 5 ms, as stated" in run.stdout


@pytest.mark.parametrize(
    ("phase", "message"),
    [
        (
            "Message_Factor=1.5ms",
            "the phase 1.5 ms of 'Message_Factor' is not an activation of 'Executor_Task', which are at 0 s + n * 1 ms",
        ),
        ("Message=1ms", "unknown callback with a phase 'Message'; did you mean 'Message_Factor'?"),
        ("Message_Factor=-1ms", "a phase must not be negative"),
        ("Message_Factor=1", "'1' has no unit"),
    ],
)
def test_a_phase_that_cannot_be(phase, message):
    run = amuros("analyze", ADVANCED, "--phase", phase)
    assert run.returncode == 2
    assert message in run.stderr


def test_a_chain_that_is_too_slow(tmp_path):
    path = tmp_path / "app.yaml"
    path.write_text(ADVANCED.read_text().replace("reaction: 25 ms", "reaction: 2 ms"))
    run = amuros("analyze", path)
    assert run.returncode == 1
    assert "reaction of factor-to-output" in run.stdout
    assert "missed" in run.stdout


def test_whose_jobs_interfere():
    run = amuros("analyze", ROOT / "samples" / "drive-and-lift.yaml", "--explain", "Control_Speed")
    lines = {line.split()[0]: line.split()[1:] for line in run.stdout.splitlines() if line.startswith("  ") and line.split()}
    # What the processes above it take adds up to the interference.
    assert lines["own"] == ["140", "us"]
    times = [float(lines[name][1]) for name in ("Executor_Task", "Task_5ms", "CAN_Receive", "Wheel_Pulse")]
    assert f"  interference  {round(sum(times), 1)} us" in run.stdout
    exact = amuros("analyze", ADVANCED, "--explain", "Control_Function")
    assert "  Executor_Task       1  25 us" in exact.stdout


class TestExplain:
    def test_another_quantity(self):
        run = amuros("analyze", ADVANCED, "--explain", "factor-to-output", "--quantity", "max_data_age")
        assert run.stdout.startswith("factor-to-output: max data age 40.03 ms (exact)")
        # The next control function ends a millisecond later.
        assert "  until overwritten" in run.stdout
        # The factor of a message is used for 20 ms, by all jobs of the control function in this time.
        assert ", Control_Function: still reads this value, every 1 ms, until a new one comes" in run.stdout

    def test_a_process_and_a_chain_of_the_same_name(self, tmp_path):
        path = tmp_path / "app.yaml"
        path.write_text(ADVANCED.read_text().replace("factor-to-output", "Control_Function"))
        run = amuros("analyze", path, "--explain", "Control_Function")
        assert run.stdout.startswith("Control_Function: worst-case response time 29 us (exact)")
        assert "'Control_Function' is also the name of an event chain:\nControl_Function: max reduced" in run.stdout

    def test_a_callback_by_its_name_in_the_description(self):
        run = amuros("analyze", ROOT / "samples" / "rclc-in-executor.yaml", "--explain", "On_Command")
        assert run.stdout.startswith("On_Command_Callback: worst-case response time 232.8 us (exact), in rclc_executor")

    def test_lines_fit_into_a_page(self):
        for model, name in ((ADVANCED, "factor-to-output"), (ROOT / "samples" / "rclc-in-executor.yaml", "rclc_executor")):
            run = explained(model, name)
            # Routes are as long as their events.
            assert max(len(line) for line in run.stdout.splitlines() if "-[" not in line) <= 100

    def test_an_overload(self):
        run = amuros("analyze", ADVANCED, "--scale", "80", "--explain", "Control_Function")
        assert run.returncode == 1
        assert run.stdout.splitlines()[1:3] == [
            "  what would give it a bound",
            "    Reduce the load by at least 33.2% of the core.",
        ]
        # 12.65 us and 4 us in each millisecond, 80 times.
        rows = [line.split() for line in run.stdout.splitlines()]
        assert ["Executor_Task", "3", "101.2", "%"] in rows
        assert ["Control_Function", "2", "32", "%"] in rows
        assert ["sum", "133.2", "%"] in rows
        assert ["supply", "100", "%"] in rows

    def test_machine_readable(self, tmp_path):
        for name in ("Executor_Task", "factor-to-output"):
            amuros("analyze", ADVANCED, "--explain", name, "--output", f"json={tmp_path / name}")
        process = json.loads((tmp_path / "Executor_Task").read_text())["explanation"]
        assert process["chain"] is None
        assert [(each["name"], each["time_ps"]) for each in process["process"]["execution"]] == [
            ("Executor_Task_Spin", 12_000_000),
            ("Take_Message_Factor", 13_000_000),
        ]
        result = json.loads((tmp_path / "factor-to-output").read_text())
        chain = result["explanation"]["chain"]
        assert chain["value_ps"] == sum(hop["wait_ps"] + hop["run_ps"] for hop in chain["hops"]) == 20_029_000_000
        assert [hop["process"] for hop in chain["hops"]] == ["Executor_Task", "Message_Factor", "Control_Function"]
        assert [cause["kind"] for cause in chain["hops"][2]["wait_causes"]] == ["next_job", "interference"]
        best = result["explanation"]["improvements"]["found"][0]
        # The callback in each millisecond, with the priority of that rate: the executor, 25 us, and both functions, 2 and 4 us.
        assert (best["before_ps"], best["after_ps"]) == (20_029_000_000, 31_000_000)
        assert best["changes"] == [{"key": "Message_Factor.task_period", "from": "not set", "to": "1 ms", "consequence": False}]
        # The rest of the result is there as well.
        assert result["chains"][0]["name"] == "factor-to-output"
