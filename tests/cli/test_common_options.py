"""The options of all commands: how much is shown, and in which colours."""

import pytest
from command import amuros
from support import DATA, ROOT

from amalthea_uros.cli.main import COMMANDS

SAMPLES = ROOT / "samples"
YAML, MODEL = SAMPLES / "bodas-test-simple.yaml", SAMPLES / "executor.amxmi"
COLOUR = "\x1b["


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_them(command):
    text = amuros(command, "--help").stdout
    for option in ("-q, --quiet", "-v, --verbose", "--color [auto|always|never]"):
        assert option in text
    assert text.count("--color") == 1


@pytest.mark.parametrize(
    ("arguments", "closing"),
    [
        (["analyze", YAML], "Schedulable: yes; tightest: Control_Function, 984 us of 1 ms left"),
        (["check", YAML], "no findings"),
        (["simulate", YAML, "--duration", "20ms"], "Observed over 20 ms (seed 1): no deadline or requirement missed"),
        (["diff", MODEL, MODEL], "no differences in meaning"),
    ],
    ids=lambda value: value[0] if isinstance(value, list) else "",
)
def test_quiet_commands_show_the_closing_line(arguments, closing):
    quiet = amuros(*arguments, "-q")
    (line,) = quiet.stdout.splitlines()
    assert line.startswith(closing)
    assert quiet.stderr == ""
    whole = amuros(*arguments)
    assert whole.stdout.splitlines()[-1] == line
    assert whole.returncode == quiet.returncode


def test_a_quiet_build_names_the_file(tmp_path):
    target = tmp_path / "app.amxmi"
    quiet = amuros("build", SAMPLES / "drive-and-lift.yaml", "-o", target, "--quiet")
    assert quiet.stdout.startswith(f"{target}: AMALTHEA 3.3.0, ")
    assert (len(quiet.stdout.splitlines()), quiet.stderr) == (1, "")


def test_errors_are_never_quiet(tmp_path):
    path = tmp_path / "app.yaml"
    path.write_text(YAML.read_text().replace("rate: 50 Hz", "rat: 50 Hz"))
    for command in ("analyze", "build", "check"):
        quiet = amuros(command, path, "-q")
        assert quiet.returncode == amuros(command, path).returncode != 0
        assert "unknown key 'rat'" in quiet.stdout + quiet.stderr


def test_a_quiet_failure_shows_no_warnings(tmp_path):
    path = tmp_path / "app.yaml"
    text = (SAMPLES / "drive-and-lift.yaml").read_text()
    path.write_text(text.replace("[Executor_Task, Set_Speed", "[Executor_Task, Set_Sped").replace("acknowledgement: 10 ms", ""))
    whole, quiet = amuros("analyze", path).stderr, amuros("analyze", path, "-q").stderr
    assert " warning: " in whole
    assert " warning: " not in quiet
    assert "'Set_Sped'" in quiet
    assert quiet.splitlines()[-1] == whole.splitlines()[-1]


def test_a_quiet_check_shows_errors_but_no_warnings(tmp_path):
    model = tmp_path / "m.amxmi"
    text = (DATA / "brake.amxmi").read_text()
    model.write_text(text.replace('access="read"', 'acess="read"').replace('data="Pedal', 'data="Petal'))
    whole, quiet = amuros("check", model).stdout, amuros("check", model, "-q").stdout
    assert " warning: " in whole
    assert " error: " in whole
    assert " warning: " not in quiet
    assert quiet.count(" error: ") == whole.count(" error: ")
    assert quiet.splitlines()[-1] == whole.splitlines()[-1]


def test_a_result_in_a_file_is_whole_and_plain_whatever_the_terminal_gets(tmp_path):
    plain, quiet = tmp_path / "plain.txt", tmp_path / "quiet.txt"
    amuros("analyze", YAML, "--output", f"text={plain}")
    amuros("analyze", YAML, "--output", f"text={quiet}", "-q", "--color", "always")
    assert quiet.read_text() == plain.read_text()
    assert COLOUR not in plain.read_text()


@pytest.mark.parametrize(
    ("option", "environment", "coloured"),
    [
        ([], {}, False),
        ([], {"FORCE_COLOR": "1"}, True),
        ([], {"FORCE_COLOR": "0"}, True),  # "regardless of its value", says force-color.org
        ([], {"FORCE_COLOR": ""}, False),
        ([], {"FORCE_COLOR": "1", "NO_COLOR": "1"}, False),
        ([], {"FORCE_COLOR": "1", "NO_COLOR": ""}, True),
        (["--color", "always"], {"NO_COLOR": "1"}, True),
        (["--color", "never"], {"FORCE_COLOR": "1"}, False),
        (["--color=auto"], {"FORCE_COLOR": "1"}, True),
    ],
)
def test_colours_follow_the_option_and_then_the_environment(option, environment, coloured, monkeypatch):
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    assert (COLOUR in amuros("analyze", YAML, *option).stdout) is coloured


def test_findings_on_standard_error_are_coloured_too(tmp_path):
    path = tmp_path / "app.yaml"
    path.write_text(YAML.read_text().replace("rate: 50 Hz", "rat: 50 Hz"))
    assert COLOUR in amuros("build", path, "--color", "always").stderr
    assert COLOUR not in amuros("build", path).stderr


def test_json_is_never_coloured():
    assert COLOUR not in amuros("analyze", YAML, "--output", "json", "--color", "always").stdout


def test_a_wrong_choice_is_refused():
    refused = amuros("info", MODEL, "--color", "sometimes")
    assert refused.returncode == 2
    assert "'sometimes' is not one of 'auto', 'always', 'never'" in refused.stderr
