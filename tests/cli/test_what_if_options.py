"""What a change would do, asked from the shell: `--set` of analyze and simulate, and `diff` in words of timing."""

import json
import shutil

import pytest
from command import amuros
from support import ROOT

SAMPLES = ROOT / "samples"
MODEL = SAMPLES / "executor.amxmi"
SET = ("--set", "Executor_Task.priority=0")


def section(text, heading):
    """The lines below a heading, up to the next empty one."""
    lines = text.splitlines()
    start = next(number for number, line in enumerate(lines) if line.startswith(heading)) + 1
    end = lines.index("", start) if "" in lines[start:] else len(lines)
    return [" ".join(line.split()) for line in lines[start:end]]


def test_analyze_shows_the_change_and_what_it_does():
    found = amuros("analyze", MODEL, *SET)
    assert found.stderr == "Executor_Task.priority: 3 -> 0\n"
    table = section(found.stdout, "Before and after the change")
    assert table[0] == "object quantity before after effect claim"
    assert "Executor_Task worst response 12 us 18 us worse exact" in table
    assert "Control_Function worst response 16 us 4 us better exact" in table
    assert table[-1].endswith("other figures are unchanged")
    assert found.stdout.splitlines()[-1].startswith("Schedulable: yes")
    assert found.returncode == 0


def test_the_exit_code_follows_the_changed_system():
    found = amuros("analyze", MODEL, "--set", "Core_0.frequency=1kHz")
    assert found.returncode == 1
    assert "system schedulable yes no worse" in section(found.stdout, "Before and after the change")


@pytest.mark.parametrize("change", ["{}.period=1ms", "Executor_Task.{}=1ms", "Executor_Task.period={}", "{}"])
@pytest.mark.parametrize("subject", ["executor.amxmi", "bodas-test-advanced.yaml"])
def test_a_mistake_of_thousands_of_characters_is_not_repeated(subject, change):
    found = amuros("analyze", SAMPLES / subject, "--set", change.format("x" * 5000))
    assert found.returncode == 2
    assert "xxx..." in found.stderr
    assert len(found.stderr) < 1000


def test_the_list_of_values_fits_a_terminal(monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    lines = amuros("analyze", SAMPLES / "drive-and-lift.yaml", "--keys").stdout.splitlines()
    (order,) = [line for line in lines if line.startswith("middleware.task_periods ")]
    assert order.endswith("  [1 ms, 5 ms, 10 ms, 20 ms, ...")
    assert max(map(len, lines)) <= 80


def test_without_a_change_there_is_no_table():
    assert "Before and after" not in amuros("analyze", MODEL).stdout
    same = amuros("analyze", MODEL, "--set", "Executor_Task.priority=3")
    assert section(same.stdout, "Before and after")[0].startswith("nothing changed: ")


def test_json_has_exact_numbers():
    found = json.loads(amuros("analyze", MODEL, *SET, "--output", "json").stdout)
    assert found["changes"] == [{"key": "Executor_Task.priority", "from": "3", "to": "0", "consequence": False}]
    rows = {(row["object"], row["quantity"]): row for row in found["impact"]["rows"]}
    row = rows["Executor_Task", "worst_case_response_time"]
    assert (row["before"]["value_ps"], row["after"]["value_ps"], row["effect"]) == (12_000_000, 18_000_000, "worse")
    effects = found["impact"]["effects"]
    assert sum(effects.values()) == len(found["impact"]["rows"])


def test_simulate_compares_what_is_observed_with_the_same_seed():
    arguments = ("simulate", MODEL, "--duration", "100ms", *SET)
    found = amuros(*arguments)
    table = section(found.stdout, "Before and after the change (observed with seed 1)")
    assert any(line.startswith("Control_Function max response") and line.endswith("better observed") for line in table)
    assert "impact" in json.loads(amuros(*arguments, "--output", "json").stdout)
    assert "Before and after" not in amuros(*arguments, "--runs", "2").stdout


def test_the_trace_of_a_comparison_is_that_of_the_changed_system(tmp_path):
    for name, model in (("compared.csv", (MODEL, *SET)), ("alone.csv", (tmp_path / "changed.amxmi",))):
        if name == "alone.csv":
            amuros("analyze", MODEL, *SET, "-o", tmp_path / "changed.amxmi")
        amuros("simulate", *model, "--duration", "10ms", "--trace", tmp_path / name)
    assert (tmp_path / "compared.csv").read_text() == (tmp_path / "alone.csv").read_text() != ""


def test_the_changed_model_is_written(tmp_path):
    target = tmp_path / "changed.amxmi"
    assert amuros("analyze", MODEL, *SET, "-o", target).returncode == 0
    found = amuros("diff", MODEL, target)
    assert found.stdout.splitlines()[:4] == ["Timing", "  Executor_Task: priority 3 -> 0", "", "Objects"]
    assert found.stdout.splitlines()[-1] == "1 difference: 1 changed"
    assert found.returncode == 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("-o", "x.amxmi"), "-o writes a changed model; add a change, e.g. --set Executor_Task.period=2ms"),
        ((*SET, "-o", "x.yaml"), "a changed system is written as an AMALTHEA model, not as a description"),
        ((*SET, "-o", "executor.amxmi"), "would replace a file that is read"),
        (("--set", "Executor_Task.perod=1ms"), "did you mean 'period'?"),
        (("--set", "Executor_Tsk.period=1ms"), "did you mean 'Executor_Task'"),
        (("--set", "Executor_Task.period"), "is not of the form OBJECT.KEY=VALUE"),
    ],
)
def test_wrong_use_is_refused_and_nothing_is_written(arguments, message, tmp_path):
    shutil.copy(MODEL, tmp_path)
    found = amuros("analyze", "executor.amxmi", *arguments, cwd=tmp_path)
    assert (found.returncode, found.stdout) == (2, "")
    assert message in " ".join(found.stderr.split())
    assert [path.name for path in tmp_path.iterdir()] == ["executor.amxmi"]
    assert (tmp_path / "executor.amxmi").read_bytes() == MODEL.read_bytes()


def test_the_changed_model_on_standard_output_is_not_mixed_with_the_tables():
    found = amuros("analyze", MODEL, *SET, "-o", "-")
    assert found.stdout.startswith("<?xml")
    assert found.stdout.rstrip().endswith("</am:Amalthea>")
    assert "Before and after the change" in found.stderr


def test_diff_of_descriptions_in_words_of_timing(tmp_path):
    old = SAMPLES / "bodas-test-advanced.yaml"
    new = tmp_path / "new.yaml"
    text = old.read_text()
    assert "period: 1 ms, execution_time: 4 us" in " ".join(text.split()) or "4 us" in text
    new.write_text(text.replace("4 us", "6 us"))
    found = amuros("diff", old, new, "--impact")
    assert "  Control_Function.execution_time: 4 us -> 6 us" in found.stdout.splitlines()
    assert any(
        line.startswith("Control_Function worst response") and " worse " in f"{line} "
        for line in section(found.stdout, "Before and after the change")
    )
    content = json.loads(amuros("diff", old, new, "--impact", "--output", "json").stdout)
    assert content["timing"] == [
        {
            "kind": "changed",
            "class": "runnable",
            "object": "Control_Function_Callback",
            "values": [{"key": "Control_Function_Callback.execution_time", "from": "4 us", "to": "6 us", "consequence": False}],
        }
    ]
    assert content["impact"]["rows"]


def test_diff_of_descriptions_names_what_only_one_has():
    found = amuros("diff", SAMPLES / "bodas-test-advanced.yaml", SAMPLES / "drive-and-lift.yaml")
    lines = found.stdout.splitlines()
    assert "  + nodes.lift" in lines
    assert "  - nodes.bodas" in lines
    assert "  can.bitrate: 250 kbit/s -> 1 Mbit/s" in lines


def test_diff_names_added_and_removed_tasks_with_their_timing():
    found = amuros("diff", MODEL, SAMPLES / "drive-and-lift.amxmi")
    lines = found.stdout.splitlines()
    assert "  + task Control_Lift (every 20 ms, 100 us..250 us, priority 4, Core_1)" in lines
    assert "  - task Message_Factor (every 20 ms, 2 us, priority 1, Core_0)" in lines


def test_diff_of_equal_models_has_no_timing():
    found = amuros("diff", MODEL, MODEL, "--impact")
    assert found.returncode == 0
    assert found.stdout.splitlines()[0] == "no differences in meaning"
