"""Options that do not exist, or had another name, and files whose suffix is that of another format: what to write instead."""

import re

import pytest
from command import amuros
from support import ROOT

APP = ROOT / "samples" / "bodas-test-simple.yaml"


@pytest.mark.parametrize(
    ("command", "options", "message"),
    [
        ("simulate", ["--btf", "x.btf"], "No such option '--btf': write --trace FILE.btf; the suffix says the format."),
        ("analyze", ["--json"], "write --output json, or --output json=FILE"),
        ("analyze", ["--sarif"], "this command have no such format; amuros check MODEL --output sarif=FILE has the findings"),
        ("check", ["--sarif"], "No such option '--sarif': write --output sarif=FILE."),
        ("sweep", ["--vary", "A.period=1ms"], "No such option '--vary': write --sweep OBJECT.KEY=VALUES."),
        ("report", ["--format", "html"], "write --output FORMAT"),
        ("check", ["--unknown"], "No such option '--unknown'"),
        ("simulate", ["--duration", "10m"], "'m' is not a unit of time; write 'min' for minutes, or 'ms' for milliseconds"),
        ("simulate", ["--gantt", "x.png"], "'x.png' does not end with .svg; pictures are written as SVG"),
        ("simulate", ["--histogram", "Control_Function=x.pdf"], "'x.pdf' does not end with .svg"),
        ("build", ["-o", "x.txt"], "'x.txt' does not end with .amxmi"),
        (
            "analyze",
            ["--set", "Executor_Task.period=2ms", "-o", "x.json"],
            "'x.json' does not end with .amxmi or .yaml or .yml",
        ),
        ("optimize", ["--time-limit", "nan"], "'nan' is not a finite number"),
        ("optimize", ["-o", "x.json"], "'x.json' does not end with .amxmi or .yaml or .yml"),
        (
            "calibrate",
            ["run.log", "-o", "x.amxmi"],
            "'x.amxmi' does not end with .yaml or .yml; descriptions are written as YAML",
        ),
        ("import", ["-o", "x.amxmi"], "'x.amxmi' does not end with .yaml or .yml"),
        ("init", ["-o", "x.yaml"], "No such option '-o': write the file alone: amuros init --board BOARD FILE."),
    ],
)
def test_what_to_write_instead(command, options, message, tmp_path):
    run = amuros(command, APP, *options, cwd=tmp_path)
    assert run.returncode == 2
    assert message in " ".join(run.stderr.split())
    assert list(tmp_path.iterdir()) == []


def test_an_option_that_had_another_name_still_works(tmp_path):
    old = amuros("build", APP, "--platform", "bodas-rc18-12-40", "-o", "-", cwd=tmp_path)
    new = amuros("build", APP, "--board=bodas-rc18-12-40", "-o", "-", cwd=tmp_path)
    assert (old.returncode, old.stdout) == (new.returncode, new.stdout) == (0, new.stdout)
    assert "note: --platform of this command is now --board" in old.stderr
    run = amuros("analyze", APP, "--mode=speed=1", cwd=tmp_path)
    assert "note: --mode of this command is now --mode-label" in run.stderr
    assert "unknown mode label 'speed'" in run.stderr


def test_the_commands_are_grouped_by_task():
    lines = amuros("--help").stdout.splitlines()
    assert max(map(len, lines)) <= 80
    assert [line for line in lines if line.endswith(":") and line[0] != " "] == [
        *("Options:", "Describe:", "Check and predict:", "Improve:", "Measure:", "Work with models:", "Look up and set up:")
    ]


#: Wrong words of 5,000 characters.
LONG = {
    "set": ["analyze", APP, "--set", "Executor_Task.period=" + "9" * 5000],
    "object": ["analyze", APP, "--set", "x" * 5000 + ".period=1ms"],
    "no change": ["analyze", APP, "--set", "x" * 5000],
    "option": ["check", APP, "--" + "x" * 5000],
    "format": ["check", APP, "--output", "x" * 5000],
    "sweep": ["sweep", APP, "--sweep", "A.period=" + "9" * 5000 + "ms..1s/1ms"],
    "seed": ["simulate", APP, "--seed", "9" * 5000],
    "rule": ["explain", "x" * 5000],
    "command": ["x" * 5000],
}


@pytest.mark.parametrize("words", LONG.values(), ids=LONG)
def test_a_long_word_does_not_hide_what_is_said_about_it(words):
    run = amuros(*words)
    assert run.returncode == 2
    assert len(run.stderr) < 1000
    assert re.search(r"\.\.\. \(5,\d{3} characters\)", run.stderr)
