"""`amuros report`: files by their suffixes, changes, and the exit code of the analysis."""

import pytest
from command import amuros
from support import ROOT

ADVANCED = ROOT / "samples" / "bodas-test-advanced.yaml"
SHORT = ("--duration", "50ms")
#: It is activated every millisecond.
#: More than a millisecond in each.
OVERLOADED = ("--set", "Control_Function.execution_time=0.999ms")


def test_the_suffix_says_the_format(tmp_path):
    files = [tmp_path / name for name in ("r.html", "r.md", "r.mmd", "r.dot")]
    run = amuros("report", ADVANCED, *SHORT, *(word for file in files for word in ("-o", file)))
    assert run.returncode == 0, run.stderr
    starts = [file.read_text().lstrip()[:12] for file in files]
    assert [start.split()[0] for start in starts] == ["<!DOCTYPE", "##", "flowchart", "digraph"]
    assert run.stderr.splitlines()[-1] == "Schedulable: yes; tightest: factor-to-output_reaction, 4.971 ms of 25 ms left"


def test_standard_output_has_the_format_that_is_asked_for():
    run = amuros("report", ADVANCED, "--no-simulation", "--output", "markdown")
    assert run.stdout.startswith("## ")
    assert "Observed" not in run.stdout


def test_the_summary_is_that_of_the_sample():
    run = amuros("report", ADVANCED, "--duration", "1s", "--output", "markdown")
    assert run.stdout == (ROOT / "tests" / "report" / "bodas-test-advanced.md").read_text()


def test_changes_are_reported_with_their_impact():
    run = amuros("report", ADVANCED, "--no-simulation", *OVERLOADED, "--output", "markdown")
    assert run.returncode == 1
    assert "| Control_Function.execution_time | 4 us | 0.999 ms |" in run.stdout
    assert "### Before and after" in run.stdout
    assert "Control_Function.execution_time: 4 us -> 0.999 ms" in run.stderr


@pytest.mark.parametrize(("fail_on", "code"), [("missed", 1), ("never", 0)])
def test_the_exit_code_follows_the_closing_line(tmp_path, fail_on, code):
    run = amuros("report", ADVANCED, "--no-simulation", *OVERLOADED, "--fail-on", fail_on, "-o", tmp_path / "r.md")
    assert run.returncode == code


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ((), "add -o FILE, e.g. -o report.html, or --output FORMAT"),
        (("-o", "r.pdf"), "expected one of .html, .md, .mmd, .dot"),
        (("-o", "no/such/folder/r.html"), "No such file or directory"),
        (("-o", "r.md", "-o", "r.md"), "the same file"),
        (("-o", "r.md", "--format", "html"), "No such option '--format': write --output FORMAT"),
        (("-o", "r.md", "--set", "Nobody.period=1ms"), "unknown object 'Nobody'"),
        (("-o", "r.md", "--duration", "0s"), "greater than zero"),
    ],
)
def test_wrong_use_is_refused_before_the_work(tmp_path, options, message):
    run = amuros("report", ADVANCED, *options, cwd=tmp_path)
    assert run.returncode == 2
    assert message in run.stderr
    assert list(tmp_path.iterdir()) == []


def test_an_input_is_not_replaced(tmp_path):
    path = tmp_path / "app.md"
    path.write_text("x")
    assert "would replace a file that is read" in amuros("report", path, "-o", path).stderr
