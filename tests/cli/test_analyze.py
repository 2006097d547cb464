"""`amuros analyze` as its user sees it."""

import json
import shutil

import pytest
from support import ROOT
from test_cli import amuros

ADVANCED = ROOT / "samples" / "bodas-test-advanced.yaml"
RCLC = ROOT / "samples" / "rclc-in-executor.yaml"


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
    assert result["requirements"] == [
        {
            "name": "Control_Function_response_time",
            "object": "Control_Function",
            "quantity": "response time",
            "limit_ps": 10**9,
            "value_ps": 29_000_000,
            "margin_ps": 971_000_000,
            "verdict": "met",
            "reason": "",
        },
        {
            "name": "factor-to-output_reaction",
            "object": "factor-to-output",
            "quantity": "reaction",
            "limit_ps": 25 * 10**9,
            "value_ps": 2_016_000_000,
            "margin_ps": 22_984_000_000,
            "verdict": "met",
            "reason": "",
        },
    ]
    (chain,) = result["chains"]
    assert (chain["name"], chain["communication"]) == ("factor-to-output", "implicit")
    values = {value["quantity"]: (value["value_ps"], value["claim"]) for value in chain["values"]}
    assert values["max_reduced_reaction_time"] == (2_016_000_000, "exact")


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
    assert "On_Imu_Callback      rclc_executor    161 us  165.46 us  192.8 us     10 ms  exact" in run.stdout
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
    assert "at most 20 us     29 us  missed       -9 us" in run.stdout
    # What is missed comes first.
    assert run.stdout.index("Control_Function  Core_0") < run.stdout.index("Executor_Task")


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
        (["--explain", "Nothing"], "unknown process 'Nothing'"),
        (["--scale", "0"], "0"),
        (["--mode", "speed"], "not of the form LABEL=VALUE"),
        (["--mode", "speed=1"], "unknown mode label 'speed'; the model has no mode label"),
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
        "--sensitivity",
        "--assign-priorities",
        "--output",
        "text",
        "--output",
        f"json={tmp_path / 'r.json'}",
    )
    assert run.returncode == 0
    assert "Maximum factors on execution times" in run.stdout
    assert "no proposal: 'Executor_Task' has no deadline" in run.stdout
    result = json.loads((tmp_path / "r.json").read_text())
    assert result["sensitivity"]["everything"] == pytest.approx(1000 / 29, rel=1e-3)
    assert result["priorities"][0]["proposed"] is None


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


def test_a_chain():
    run = amuros("analyze", ADVANCED, "--chain", "factor-to-output", "--all-phases")
    assert run.returncode == 0
    assert "Executor_Task_start -[data memory_1]-> Message_Factor_finish -[data memory_2]->" in run.stdout
    assert "max reduced reaction time    20.029 ms  exact" in run.stdout
    assert "Davare" not in run.stdout
    every = amuros("analyze", ADVANCED, "--chain", "factor-to-output", "--method", "all")
    assert "sum of periods and response times (Davare and others 2007)" in every.stdout
    assert "unknown chain 'x'" in amuros("analyze", ADVANCED, "--chain", "x").stderr


def test_any_phase_is_an_alias_of_all_phases():
    runs = [amuros("analyze", ADVANCED, "--chain", "factor-to-output", option) for option in ("--all-phases", "--any-phase")]
    assert runs[0].stdout == runs[1].stdout
    assert "over all 20 phases" in runs[1].stdout


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
