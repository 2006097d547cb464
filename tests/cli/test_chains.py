"""`amuros chains` as its user sees it."""

import pytest
from command import amuros
from support import ROOT

import amalthea_uros

ADVANCED = ROOT / "samples" / "bodas-test-advanced.amxmi"


@pytest.mark.parametrize(
    ("start", "end"),
    [("Executor_Task", "Control_Function"), ("Take_Message_Factor", "Control_Function"), ("memory_1", "memory_2")],
)
def test_paths(start, end):
    run = amuros("chains", ADVANCED, "--from", start, "--to", end)
    assert run.returncode == 0
    assert "Executor_Task -[memory_1]-> Message_Factor -[memory_2]-> Control_Function" in run.stdout


def test_a_path_becomes_a_chain_of_the_model(tmp_path):
    output = tmp_path / "more.amxmi"
    run = amuros("chains", ADVANCED, "--from", "Executor_Task", "--to", "Control_Function", "--add", "found", "-o", output)
    assert run.returncode == 0
    found = amuros("analyze", output, "--chain", "found").stdout
    modelled = amuros("analyze", output, "--chain", "factor-to-output").stdout
    assert found.partition("quantity")[2] == modelled.partition("quantity")[2] != ""
    model = amalthea_uros.load(output)
    assert not model.findings
    # Nothing else has changed; the event that was there is used.
    difference = amuros("diff", ADVANCED, output).stdout
    assert "3 differences: 3 added" in difference
    again = amuros("chains", output, "--from", "Executor_Task", "--to", "Control_Function", "--add", "found", "-o", output)
    assert again.returncode == 2
    assert "already has a chain 'found'" in again.stderr


def test_a_description_is_not_rewritten(tmp_path):
    run = amuros(
        "chains",
        ADVANCED.with_suffix(".yaml"),
        *("--from", "Executor_Task", "--to", "Control_Function", "--add", "found", "-o", tmp_path / "x.yaml"),
    )
    assert run.returncode == 2
    assert "path: [Executor_Task, Message_Factor, Control_Function]" in " ".join(run.stderr.split())


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["--from", "Control_Function", "--to", "Executor_Task"], 1, "there is no path from"),
        (["--from", "Nothing", "--to", "Executor_Task"], 2, "unknown process, runnable or label 'Nothing'"),
        (
            ["--from", "Executor_Task", "--to", "Control_Function", "--add", "x"],
            2,
            "--add CHAIN and -o FILE must be given together",
        ),
        (["--from", "Executor_Task", "--to", "Control_Function", "--path", "2"], 2, "no path 2; there is only 1 path"),
    ],
)
def test_wrong_use(arguments, code, message):
    run = amuros("chains", ADVANCED, *arguments)
    assert run.returncode == code
    assert message in run.stdout + run.stderr
    assert "Traceback" not in run.stderr
