"""`-` is standard input and standard output in every command."""

import json
import os
import subprocess
import sys
from threading import Thread

import pytest
from command import amuros
from support import DATA, MODEL, ROOT

DESCRIPTION = ROOT / "samples" / "bodas-test-simple.yaml"
BUILT = ROOT / "samples" / "bodas-test-simple.amxmi"
OLDER = ROOT / "samples" / "pump-1.2.0.amxmi"
CHECKED = MODEL.format("<swModel><tasks/></swModel>")


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["info", "-"], "AMALTHEA 3.3.0"),
        (["check", "-", "--profile", "schema"], "no findings"),
        (["analyze", "-"], "Schedulable: yes"),
        (["simulate", "-", "--duration", "2ms"], "Observed over 2 ms"),
        (["chains", "-", "--from", "Message_Factor", "--to", "Control_Function"], "Control_Function"),
        (["diff", "-", BUILT], "no differences"),
        (["diff", BUILT, "-"], "no differences"),
    ],
)
def test_a_model_is_read_from_standard_input(arguments, expected):
    run = amuros(*arguments, given=BUILT.read_text())
    assert expected in run.stdout
    assert "Traceback" not in run.stderr


@pytest.mark.parametrize("path", ["-", "/dev/fd/0"])
@pytest.mark.parametrize("command", [["check"], ["analyze"], ["simulate", "--duration", "2ms"], ["build"]])
def test_a_description_is_recognised_by_its_content(command, path):
    run = amuros(*command, path, given=DESCRIPTION.read_text())
    assert (run.returncode, "Traceback" in run.stderr) == (0, False)


def test_a_description_is_a_named_pipe(tmp_path):
    path = tmp_path / "app.yaml"
    os.mkfifo(path)
    writer = Thread(target=path.write_text, args=[DESCRIPTION.read_text()], daemon=True)
    writer.start()
    run = amuros("analyze", path)
    assert "Schedulable: yes" in run.stdout
    writer.join()


def test_a_place_in_standard_input():
    run = amuros("check", "-", "--select", "AM-EMF-*", given=CHECKED)
    assert run.stdout.startswith("/dev/stdin:3:")


@pytest.mark.parametrize("target", [["-o", "-"], ["-o", "/dev/stdout"], ["-o", "/dev/fd/1"]])
def test_a_model_is_written_to_standard_output_and_the_text_goes_to_standard_error(target, tmp_path):
    with (tmp_path / "out").open("w+") as out:
        command = [sys.executable, "-m", "amalthea_uros", "build", DESCRIPTION, *target]
        run = subprocess.run(command, stdout=out, stderr=subprocess.PIPE, text=True, check=True)
    assert (tmp_path / "out").read_text() == BUILT.read_text()
    assert "Tasks (3)" in run.stderr


def test_build_as_a_filter():
    for path in ("-", "/dev/fd/0"):
        run = amuros("build", path, given=DESCRIPTION.read_text())
        assert run.stdout == BUILT.read_text()


def test_fmt_as_a_filter():
    once = amuros("fmt", "-", given=CHECKED)
    assert (once.returncode, once.stderr) == (0, "/dev/stdin: rewritten\n")
    again = amuros("fmt", "-", given=once.stdout)
    assert (again.stdout, again.stderr) == (once.stdout, "")
    assert amuros("fmt", "/dev/fd/0", given=once.stdout).stdout == once.stdout
    assert amuros("fmt", "--check", "-", given=CHECKED).returncode == 1
    assert amuros("fmt", "--diff", "-", given=once.stdout).stdout == ""


def test_migrate_as_a_filter():
    run = amuros("migrate", "-", "-o", "-", given=OLDER.read_text())
    assert 'xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0"' in run.stdout
    assert "stdin" in run.stderr


@pytest.mark.parametrize(
    ("option", "start"), [("--trace", "#version"), ("--table", "duration_ps,"), ("--gantt", "<svg"), ("--output", "{")]
)
def test_results_of_a_simulation(option, start):
    value = "json=-" if option == "--output" else "-"
    run = amuros("simulate", DESCRIPTION, "--duration", "2ms", option, value)
    assert run.returncode == 0
    assert run.stdout.startswith(start)


def test_a_baseline_goes_out_and_comes_in():
    written = amuros("check", "-", "--select", "AM-EMF-*", "--write-baseline", "-", given=CHECKED)
    assert json.loads(written.stdout)["accepted"]
    path = DATA / "brake.amxmi"
    accepted = amuros("check", path, "--write-baseline", "-").stdout
    assert amuros("check", path, "--baseline", "-", given=accepted).stdout.endswith("\nno findings\n")


@pytest.mark.parametrize(
    "arguments",
    [
        ["simulate", DESCRIPTION, "--trace", "-", "--table", "-"],
        ["simulate", DESCRIPTION, "--trace", "-", "--trace", "/dev/stdout"],
        ["simulate", DESCRIPTION, "--gantt", "-", "--output", "json"],
        ["build", DESCRIPTION, "-o", "-", "--output", "json"],
        ["info", BUILT, "--output", "json", "--output", "text"],
        ["check", BUILT, "--write-baseline", "-", "--output", "json=-"],
    ],
)
def test_two_results_in_one_stream_are_refused(arguments):
    run = amuros(*arguments)
    assert (run.returncode, run.stdout) == (2, "")
    assert "both write to standard output; give all but one of them a file" in run.stderr


@pytest.mark.parametrize("path", ["-", "/dev/fd/0"])
@pytest.mark.parametrize("arguments", [["check", "--fix"], ["migrate"], ["check", "--watch"]])
def test_standard_input_is_not_changed_in_place(arguments, path):
    run = amuros(*arguments, path, given=CHECKED)
    assert (run.returncode, run.stdout) == (2, "")
    assert "standard input" in run.stderr


def test_no_file_is_made_with_that_name(tmp_path):
    amuros("build", "-", "-o", "-", given=DESCRIPTION.read_text(), cwd=tmp_path)
    amuros("simulate", DESCRIPTION, "--duration", "2ms", "--trace", "-", cwd=tmp_path)
    assert list(tmp_path.iterdir()) == []
