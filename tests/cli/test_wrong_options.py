"""Options that do not exist, or had another name, and files whose suffix is that of another format: what to write instead."""

import pytest
from command import amuros
from support import ROOT

APP = ROOT / "samples" / "bodas-test-simple.yaml"


@pytest.mark.parametrize(
    ("command", "options", "message"),
    [
        ("simulate", ["--btf", "x.btf"], "No such option '--btf': write --trace FILE.btf; the suffix says the format."),
        ("analyze", ["--json"], "write --output json, or --output json=FILE"),
        ("analyze", ["--mode", "a=b"], "--mode-label LABEL=VALUE sets a mode label"),
        ("measure", ["--baseline", "Empty"], "--empty NAME subtracts the times of an empty object"),
        ("build", ["--platform", "x"], "--board NAME chooses the board"),
        ("report", ["--format", "html"], "write --output FORMAT"),
        ("check", ["--unknown"], "No such option '--unknown'"),
        ("simulate", ["--duration", "10m"], "'m' is not a unit of time; write 'min' for minutes, or 'ms' for milliseconds"),
        ("simulate", ["--gantt", "x.png"], "'x.png' does not end with .svg; pictures are written as SVG"),
        ("simulate", ["--histogram", "Control_Function=x.pdf"], "'x.pdf' does not end with .svg"),
        ("build", ["-o", "x.txt"], "'x.txt' does not end with .amxmi"),
    ],
)
def test_what_to_write_instead(command, options, message, tmp_path):
    run = amuros(command, APP, *options, cwd=tmp_path)
    assert run.returncode == 2
    assert message in " ".join(run.stderr.split())
    assert list(tmp_path.iterdir()) == []


def test_the_commands_are_grouped_by_task():
    lines = amuros("--help").stdout.splitlines()
    assert max(map(len, lines)) <= 80
    assert [line for line in lines if line.endswith(":") and line[0] != " "] == [
        *("Options:", "Describe:", "Check and predict:", "Improve:", "Measure:", "Work with models:", "Look up and set up:")
    ]
