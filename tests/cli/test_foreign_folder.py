"""No command executes code of the folder in which it runs: a folder that was cloned may have anything in it."""

import os
import signal
import subprocess
import sys
from pkgutil import iter_modules
from shutil import copy

import pytest
from click import Context
from effort import every
from support import ROOT

from amalthea_uros._internal import machine_code, own_processes
from amalthea_uros.cli.main import COMMANDS, cli

SAMPLES = ROOT / "samples"
INPUTS = {
    "a.amxmi": "executor.amxmi",
    "app.yaml": "bodas-test-measured.yaml",
    "node.c": "sources/int32_publisher.c",
    "run.log": "bodas-test-measured.log",
    "run.markers.yml": "bodas-test-measured.markers.yml",
    "xrce.yaml": "robot-xrce.yaml",
}
#: What every command is called with, in a folder with these inputs.
CALLS = {
    "analyze": "app.yaml --explain Executor_Task",
    "build": "app.yaml -o built.amxmi",
    "calibrate": "app.yaml run.log --markers run.markers.yml",
    "chains": "app.yaml --from Executor_Task --to Executor_Task",
    "check": "app.yaml",
    "compare": "app.yaml run.log --markers run.markers.yml",
    "completion": "bash",
    "diff": "a.amxmi a.amxmi",
    "explain": "XMI020",
    "export": "app.yaml -o app.iprx",
    "fmt": "--check a.amxmi",
    "generate": "xrce.yaml -o build",
    "import": "node.c -o imported.yaml",
    "info": "--schema a.amxmi",
    "init": "new.yaml",
    "lsp": "",
    "measure": "run.log --markers run.markers.yml",
    "migrate": "a.amxmi -o migrated.amxmi",
    "optimize": "app.yaml --jobs 2 --time-limit 3",
    "report": "app.yaml -o report.html",
    "rules": "",
    "schema": "",
    "simulate": "app.yaml --runs 3 --jobs 2 --duration 10ms",
    "sweep": "app.yaml --sweep Message_Factor.rate=10Hz..50Hz/10Hz --jobs 2",
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Inputs among modules of all names that are imported somewhere; importing one leaves a trace."""
    path = tmp_path_factory.mktemp("cloned")
    poison = f"open({str(path / 'executed')!r}, 'a').write(__name__ + ' ')\nraise SystemExit('foreign code runs')\n"
    installed = {module.name for module in iter_modules()}
    # Libraries that are used where they are installed: some of them are not installed here.
    optional = {"dask", "numba", "sitecustomize", "usercustomize"}
    for name in sys.stdlib_module_names | installed | optional:
        (path / f"{name}.py").write_text(poison)
    (path / ".numba_config.yaml").write_text("cache_dir: foreign\n")
    for name, sample in INPUTS.items():
        copy(SAMPLES / sample, path / name)
    return path


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    """The command as pip installs it: a script in a folder of its own."""
    path = tmp_path_factory.mktemp("bin") / "amuros"
    path.write_text("import sys\nfrom amalthea_uros.cli.process import run\nif __name__ == '__main__':\n    sys.exit(run())\n")
    return [sys.executable, str(path)]


def environment(**more):
    kept = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    return {**kept, "PYTHONPATH": str(ROOT), **more}


def executed(folder):
    return (folder / "executed").read_text() if (folder / "executed").exists() else ""


def commands_with(option):
    return [name for name in COMMANDS if any(option in each.opts for each in cli.get_command(Context(cli), name).params)]


def test_every_command_is_called_and_those_that_can_with_workers():
    assert set(CALLS) == set(COMMANDS)
    assert [command for command in commands_with("--jobs") if "--jobs 2" not in CALLS[command]] == []


@pytest.mark.parametrize("command", every(4, [*CALLS][::-1]))
def test_no_command_executes_code_of_the_working_folder(command, folder, program):
    words = [*program, command, *CALLS[command].split()]
    run = subprocess.run(
        words, cwd=folder, env=environment(), capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL
    )
    assert executed(folder) == ""
    assert "Traceback" not in run.stderr
    assert "foreign code" not in run.stdout + run.stderr
    assert run.returncode in (0, 1), run.stderr


@pytest.mark.parametrize("command", every(3, commands_with("--watch")))
def test_a_watching_command_executes_none_either(command, folder, program):
    words = [*program, command, *CALLS[command].split(), "--watch"]
    with subprocess.Popen(
        words, cwd=folder, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    ) as run:
        lines = []
        while not any(line.startswith("watching") for line in lines):
            lines.append(run.stdout.readline())
            assert lines[-1], lines
        run.send_signal(signal.SIGINT)
    assert executed(folder) == ""
    assert len(lines) > 1


def test_no_machine_code_is_loaded_where_settings_of_numba_may_name_foreign_code(folder, monkeypatch):
    monkeypatch.setattr(machine_code, "find_spec", lambda _name: object())
    assert machine_code.is_available()
    monkeypatch.chdir(folder)
    assert not machine_code.is_available()


def test_only_the_working_folder_is_forgotten(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", ["", str(ROOT), ".", str(tmp_path), "/elsewhere"])
    own_processes.forget_working_folder()
    assert sys.path == [str(ROOT), "/elsewhere"]
    # In a checkout, the package itself is in the working folder.
    monkeypatch.chdir(ROOT)
    own_processes.forget_working_folder()
    assert sys.path == [str(ROOT), "/elsewhere"]


def test_the_environment_is_as_before_once_processes_are_started(monkeypatch):
    for former in (None, "", "0"):
        monkeypatch.setenv("PYTHONSAFEPATH", former) if former is not None else monkeypatch.delenv(
            "PYTHONSAFEPATH", raising=False
        )
        with own_processes.safe_start():
            assert os.environ["PYTHONSAFEPATH"] == "1"
        assert os.environ.get("PYTHONSAFEPATH") == former
