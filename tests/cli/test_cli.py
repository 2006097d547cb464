"""The command line as its user sees it."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from command import amuros
from support import DATA

import amalthea_uros

BRAKE = DATA / "brake.amxmi"


@pytest.fixture
def brake(tmp_path):
    path = tmp_path / "brake.amxmi"
    path.write_bytes(BRAKE.read_bytes())
    return path


def test_help_names_every_command():
    run = amuros("--help")
    assert run.returncode == 0
    for command in ("analyze", "build", "diff", "fmt", "info", "schema"):
        assert command in run.stdout
        assert amuros(command, "--help").returncode == 0


def test_help_imports_no_heavy_module():
    code = (
        "import sys; sys.argv = ['amuros', '--help']; from amalthea_uros.cli.main import main\n"
        "try: main()\nfinally: print(*sys.modules)"
    )
    modules = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    heavy = {"lxml", "xmlschema", "numpy", "networkx", "pydantic", "jinja2", "amalthea_uros.metamodel", "amalthea_uros.xmi"}
    assert heavy.isdisjoint(modules)


def test_version():
    assert amuros("--version").stdout == f"amuros, version {amalthea_uros.__version__}\n"


def test_wrong_use():
    assert amuros("infos").returncode == 2
    assert amuros("info").returncode == 2
    assert amuros("info", BRAKE, "--output", "yaml").returncode == 2


def test_info():
    run = amuros("info", BRAKE)
    assert run.returncode == 0
    assert "AMALTHEA 3.0.0, 18 objects" in run.stdout
    assert "Brake (left)  task  every 10 ms, offset 500 us" in run.stdout


def test_info_as_json_beside_the_text(tmp_path):
    run = amuros("info", BRAKE, "--output", "text", "--output", f"json={tmp_path / 'info.json'}")
    assert "Brake (left)" in run.stdout
    result = json.loads((tmp_path / "info.json").read_text())
    assert result["amuros"] == amalthea_uros.__version__
    assert result["counts"]["Runnable"] == 2
    (process,) = result["processes"]
    assert (process["name"], process["kind"], process["runnable_calls"]) == ("Brake (left)", "task", 2)


def test_info_shows_the_place_of_a_finding(brake):
    brake.write_text(brake.read_text().replace('access="read"', 'acess="read"'))
    run = amuros("info", brake)
    assert run.returncode == 0
    first, line, caret, advice = run.stderr.splitlines()
    assert first == f"{brake}:12:66: XMI011 warning: unknown attribute 'acess' of LabelAccess (AMALTHEA 3.0.0)"
    assert line[caret.index("^") :].startswith("acess=")
    assert advice == "  help: Did you mean 'access'? Unknown content is ignored, but preserved when the file is saved."


def test_info_validates_against_the_schema(brake):
    assert amuros("info", "--schema", brake).returncode == 0
    brake.write_text(brake.read_text().replace('access="read"', 'access="peek"'))
    run = amuros("info", "--schema", brake)
    assert run.returncode == 1
    assert 'XSD001 error: attribute access="peek" is not a literal of LabelAccessEnum' in run.stderr


def test_fmt_rewrites_in_place(brake):
    brake.write_text(brake.read_text().replace("      <", "\t<"))
    assert amuros("fmt", "--check", brake).returncode == 1
    diff = amuros("fmt", "--diff", brake)
    assert diff.returncode == 1
    assert "-\t<activityGraph>" in diff.stdout
    assert amuros("fmt", brake).stdout == f"{brake}: rewritten\n"
    assert brake.read_bytes() == BRAKE.read_bytes()
    assert amuros("fmt", "--check", brake).returncode == 0


def test_diff(brake):
    assert amuros("diff", BRAKE, brake).stdout == "no differences in meaning\n"
    brake.write_text(brake.read_text().replace('value="10" unit="ms"', 'value="20" unit="ms"'))
    run = amuros("diff", BRAKE, brake, "--output", "text")
    assert run.returncode == 1
    timing = "Timing\n  Brake (left): period 10 ms -> 20 ms\n\nObjects\n"
    assert run.stdout == f"{timing}~ PeriodicStimulus T_10ms\n    recurrence: 10 ms -> 20 ms\n\n1 difference: 1 changed\n"


def test_diff_as_json(brake):
    brake.write_text(brake.read_text().replace("Pedal", "Lever"))
    run = amuros("diff", BRAKE, brake, "--output", "json")
    (change,) = json.loads(run.stdout)["changes"]
    assert change["feature"] == "name"
    assert (change["old"], change["new"]) == ("Pedal", "Lever")
    assert change["new_location"] == {"file": str(brake), "line": 19, "column": 39}


def test_a_closed_pipe_is_no_error():
    command = f"{sys.executable} -m amalthea_uros info {BRAKE} | head -1"
    run = subprocess.run(command, shell=True, capture_output=True, text=True, check=True)
    assert run.stderr == ""


@pytest.mark.parametrize("arguments", [("info", BRAKE), ("rules",), ("--help",)])
def test_output_that_cannot_be_written_is_said(arguments):
    full = Path("/dev/full")
    if not full.exists():
        pytest.skip("this system has no /dev/full")
    with full.open("w") as stream:
        command = [sys.executable, "-m", "amalthea_uros", *map(str, arguments)]
        run = subprocess.run(command, stdout=stream, stderr=subprocess.PIPE, text=True, check=False)
    assert run.returncode == 2
    assert run.stderr == "amuros: the output cannot be written: No space left on device\n"


@pytest.mark.parametrize("arguments", [f"info {BRAKE}", "--help"])
def test_closed_standard_output_is_said(arguments):
    command = f"{sys.executable} -m amalthea_uros {arguments} >&-"
    run = subprocess.run(command, shell=True, stderr=subprocess.PIPE, text=True, check=False)
    assert run.returncode == 2
    assert run.stderr == "amuros: the output cannot be written: it is closed\n"


def test_closed_error_output_keeps_the_exit_code():
    run = subprocess.run(f"{sys.executable} -m amalthea_uros info nothing.amxmi 2>&-", shell=True, check=False)
    assert run.returncode == 2


@pytest.mark.parametrize(
    "arguments", [("info", "{}"), ("diff", "{}", "{}"), ("check", "{}"), ("analyze", "{}"), ("migrate", "{}")]
)
def test_a_result_does_not_replace_what_is_read(brake, arguments):
    before = brake.read_bytes()
    (brake.parent / "folder").mkdir()
    same = brake.parent / "folder" / ".." / brake.name
    run = amuros(*(argument.format(brake) for argument in arguments), "--output", f"json={same}")
    assert run.returncode == 2
    assert f"--output json={same} would replace a file that is read." in run.stderr
    assert brake.read_bytes() == before


def test_a_zipped_model(brake):
    amalthea_uros.save(amalthea_uros.load(brake), compress=True)
    assert brake.read_bytes()[:2] == b"PK"
    assert "zipped" in amuros("info", brake).stdout
    model = amalthea_uros.load(brake)
    amalthea_uros.save(model)
    assert brake.read_bytes()[:2] == b"PK"
    amalthea_uros.save(model, compress=False)
    assert brake.read_bytes() == BRAKE.read_bytes()
