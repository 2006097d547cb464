"""The answers are the same wherever a command runs, and an output is whole or as it was, whatever happens to the process."""

import os
import signal
import subprocess
import sys

import pytest
from support import ROOT

YAML = ROOT / "samples" / "bodas-test-advanced.yaml"
COMMAND = [sys.executable, "-m", "amalthea_uros"]
PATHS = {"PYTHONPATH": str(ROOT), "PATH": os.environ["PATH"]}
#: How processes are started elsewhere: by containers without a home, in other languages, by users who strip docstrings.
ENVIRONMENTS = {
    "optimized, C locale, no home": {"PYTHONOPTIMIZE": "2", "LC_ALL": "C", "HOME": "/nonexistent"},
    "hash seed": {"PYTHONHASHSEED": "4711", "LANG": "tr_TR.UTF-8"},
}


def _run(*words, **variables):
    command = [*COMMAND, *map(str, words)]
    return subprocess.run(command, capture_output=True, check=False, env=PATHS | variables, timeout=120)


@pytest.mark.parametrize("words", [("analyze", YAML), ("check", YAML, "--output", "json")], ids=lambda words: words[0])
def test_the_environment_does_not_change_an_answer(words):
    usual = _run(*words)
    assert usual.returncode == 0
    for variables in ENVIRONMENTS.values():
        found = _run(*words, **variables)
        assert (found.returncode, found.stdout, found.stderr) == (0, usual.stdout, usual.stderr)


@pytest.mark.skipif(os.name == "nt", reason="there are no such pipes")
def test_a_reader_that_ends_early_is_no_failure_to_talk_about():
    with subprocess.Popen([*COMMAND, "rules"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=PATHS) as process:
        process.stdout.close()
        message = process.stderr.read().decode()
    assert "Traceback" not in message
    assert "Error" not in message


KILLED = """
import os, signal, sys
def kill(*_arguments):
    os.kill(os.getpid(), signal.SIGKILL)
{when}
from amalthea_uros.cli.process import run
sys.argv = {arguments}
run()
"""
MOMENTS = {
    "written": "os.fsync = kill",
    "renamed": "sys.addaudithook(lambda event, _: kill() if event == 'os.rename' else None)",
}


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="there is no such signal")
@pytest.mark.parametrize("moment", MOMENTS)
def test_a_process_that_is_killed_while_it_writes_leaves_the_old_content(moment, tmp_path):
    target = tmp_path / "a.amxmi"
    target.write_text("the old content")
    code = KILLED.format(when=MOMENTS[moment], arguments=["amuros", "build", str(YAML), "-o", str(target)])
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False, env=PATHS, timeout=120)
    assert run.returncode == -signal.SIGKILL, run.stderr
    assert target.read_text() == "the old content"


def test_two_processes_with_one_output_leave_the_whole_content_of_one(tmp_path):
    alone, shared = tmp_path / "alone.amxmi", tmp_path / "shared.amxmi"
    assert _run("build", YAML, "-o", alone).returncode == 0
    command = [*COMMAND, "build", str(YAML), "-o", str(shared)]
    both = [subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, env=PATHS) for _ in range(2)]
    ends = [(each.communicate(timeout=120)[1], each.returncode) for each in both]
    assert [code for _, code in ends] == [0, 0], ends
    assert shared.read_bytes() == alone.read_bytes()
    assert sorted(each.name for each in tmp_path.iterdir()) == ["alone.amxmi", "shared.amxmi"]


READ_ONLY = """
import os, sys
def refuse(event, arguments):
    is_writing = event == "open" and arguments[2] & (os.O_WRONLY | os.O_RDWR) and not str(arguments[0]).startswith("/dev/")
    if is_writing or event in ("os.mkdir", "tempfile.mkstemp", "tempfile.mkdtemp"):
        raise OSError(30, "Read-only file system", arguments[0])
sys.addaudithook(refuse)
from amalthea_uros.cli.main import main
for words in {commands}:
    sys.argv = ["amuros", *words]
    try:
        main()
    except SystemExit as ending:
        assert not ending.code, (words, ending.code)
"""


def test_commands_without_an_output_write_no_file_not_even_a_temporary_one():
    model, change = str(YAML.with_suffix(".amxmi")), "Control_Function.period=2ms"
    sweep = ["sweep", model, "--sweep", "Control_Function.period=1ms,2ms", "--jobs", "1"]
    commands = [["check", model], ["analyze", model, "--set", change], sweep, ["simulate", model, "--duration", "10ms"]]
    code = READ_ONLY.format(commands=commands)
    environment = PATHS | {"PYTHONDONTWRITEBYTECODE": "1"}
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False, env=environment, timeout=120
    )
    assert run.returncode == 0, run.stderr
    assert "Observed over 10 ms" in run.stdout
