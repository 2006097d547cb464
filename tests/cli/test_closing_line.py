"""The closing line of `amuros analyze`, and the exit code that follows it."""

import json

import pytest
from command import amuros
from support import ROOT

HEAD = "amuros: 1\nname: app\nhardware: {platform: single-core, frequency: 100 MHz}\n"
LATE = (
    f"{HEAD}tasks:\n"
    "  - {name: H, period: 20 ms, execution_time: 6 ms, priority: 2}\n"
    "  - {name: U, period: 25 ms, execution_time: 15 ms, priority: 1, activation_limit: 2}\n"
)
#: The activation limit is 1 by default.
LOST = LATE.replace(", activation_limit: 2", "")
OVERLOADED = LATE.replace("15 ms", "20 ms")
#: With what U and V respond to, and limits of it.
WITH_CHAINS = OVERLOADED.replace("priority: 1}", "priority: 1, writes: [b]}") + (
    "  - {name: V, period: 25 ms, execution_time: 2 ms, priority: 0, reads: [b]}\n"
    "chains:\n  - {name: way, path: [U, V], reaction: {max: 2 s}}\n"
    "requirements:\n"
    "  - {process: U, response_time: {max: 25 ms}}\n"
    "  - {process: U, response_time: {max: 30 ms}}\n"
    "  - {process: V, response_time: {max: 30 ms}}\n"
)
ADVANCED = (ROOT / "samples" / "bodas-test-advanced.yaml").read_text()


def closing(tmp_path, text, *options):
    path = tmp_path / "app.yaml"
    path.write_text(text)
    run = amuros("analyze", path, *options)
    return run.stdout.rstrip().splitlines()[-1] if run.stdout else run.stderr.rstrip().splitlines()[-1], run.returncode


@pytest.mark.parametrize(
    ("text", "line", "code"),
    [
        # 80 % of 25 ms are used, and 3 % of 1 ms.
        (ADVANCED, "Schedulable: yes; tightest: factor-to-output_reaction, 4.971 ms of 25 ms left", 0),
        (LATE, "Schedulable: no: U responds after 27 ms, period 25 ms", 1),
        (
            LATE.replace("15 ms", "15.123456 ms"),
            "Schedulable: no: U responds after 27.13 ms, period 25 ms",
            1,
        ),
        (LOST, "Schedulable: no: U responds after 27 ms, period 25 ms, and loses activations", 1),
        (
            LOST.replace("priority: 1", "priority: 1, deadline: 40 ms"),
            "Schedulable: no: U loses activations: 2 jobs can be pending, and the activation limit is 1",
            1,
        ),
        (
            OVERLOADED,
            "Schedulable: no: U: overload: tasks at this priority or higher need 110.0 % of the core",
            1,
        ),
        # V and the way are late because U is; the requirements are about the same response times.
        (
            WITH_CHAINS,
            "Schedulable: no: U: overload: tasks at this priority or higher need 110.0 % of the core, with 2 consequences",
            1,
        ),
        # 6 of 20 and 17.5025 of 25 ms: 0.3 + 0.7001.
        (
            LATE.replace("15 ms", "17502500 ns"),
            "Schedulable: no: U: overload: tasks at this priority or higher need 100.01 % of the core",
            1,
        ),
    ],
)
def test_the_exit_code_follows_the_closing_line(text, line, code, tmp_path):
    assert closing(tmp_path, text) == (line, code)


def test_the_verdicts_in_the_table(tmp_path):
    for text, verdict in ((LATE, "missed"), (LOST, "lost"), (OVERLOADED, "overload")):
        path = tmp_path / "app.yaml"
        path.write_text(text)
        (row,) = (line for line in amuros("analyze", path).stdout.splitlines() if line.startswith("  U ") and "period" in line)
        assert f"period 25 ms  {verdict}" in row


def test_an_executor_that_loses_jobs_fails(tmp_path):
    # 1.25 of 1 ms: every fifth activation finds the job before still pending.
    path = tmp_path / "app.yaml"
    path.write_text(ADVANCED.replace("{base: 12 us, per_message: 13 us}", "{base: 1250 us, per_message: 13 us}"))
    run = amuros("analyze", path)
    assert run.returncode == 1
    assert "Schedulable: no: " in run.stdout


class TestUnknown:
    """A deadline between what is certain, 15 ms, and the bound: an interrupt at 0 and at 20, if it ever comes so often."""

    UNKNOWN = (
        f"{HEAD}isrs:\n  - {{name: I, sporadic: {{min: 20 ms, max: 1 s}}, execution_time: 6 ms, priority: 1}}\n"
        "tasks:\n  - {name: U, period: 25 ms, execution_time: 15 ms, priority: 1, deadline: 20 ms}\n"
    )

    @pytest.mark.parametrize(("fail_on", "code"), [("missed", 0), ("unknown", 1), ("never", 0)])
    def test_what_fails_is_chosen(self, fail_on, code, tmp_path):
        line, found = closing(tmp_path, self.UNKNOWN, "--fail-on", fail_on)
        assert (line, found) == (
            "Not proved schedulable: 1 of 2 is unknown, because of 'U': the maximum is between 15 ms and 27 ms",
            code,
        )

    @pytest.mark.parametrize(("fail_on", "code"), [("missed", 1), ("unknown", 1), ("never", 0)])
    def test_what_is_missed_fails_unless_nothing_does(self, fail_on, code, tmp_path):
        assert closing(tmp_path, LATE, "--fail-on", fail_on)[1] == code

    def test_it_is_said_on_standard_error_if_there_is_no_text(self, tmp_path):
        path = tmp_path / "app.yaml"
        path.write_text(self.UNKNOWN)
        run = amuros("analyze", path, "--output", f"json={tmp_path / 'r.json'}")
        assert "Not proved schedulable: 1 of 2" in run.stderr
        assert json.loads((tmp_path / "r.json").read_text())["summary"] == {
            "schedulable": "unknown",
            "missed": 0,
            "failures": 0,
            "unknown": 1,
            "judged": 2,
            "overloaded": [],
            "tightest": {"name": "I", "margin_ps": 14 * 10**9},
            "text": "Not proved schedulable: 1 of 2 is unknown, because of 'U': the maximum is between 15 ms and 27 ms",
        }


def test_check_fails_on_an_overload(tmp_path):
    path = tmp_path / "app.yaml"
    path.write_text(OVERLOADED)
    run = amuros("check", path)
    assert run.returncode == 1
    assert "TIM-OVERLOAD error" in run.stdout


def test_what_follows_lost_activations_is_not_exact(tmp_path):
    # The executor takes 0.9 ms, and 1.2 ms with a message, of each ms: it loses an activation after each message, so that nobody knows
    # which job takes the next one.
    path = tmp_path / "app.yaml"
    path.write_text(ADVANCED.replace("base: 12 us", "base: 900 us").replace("per_message: 13 us", "per_message: 300 us"))
    run = amuros("analyze", path, "--output", f"json={tmp_path / 'r.json'}")
    assert run.returncode == 1
    found = json.loads((tmp_path / "r.json").read_text())
    assert {process["name"]: process["failure"] for process in found["processes"]}["Executor_Task"] == "lost"
    assert "exact" not in {process["claim"] for process in found["processes"]}
    assert found["chains"][0]["values"] == []
