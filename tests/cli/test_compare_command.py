"""`amuros compare`: options, texts, files and exit codes."""

import json

import pytest
from command import amuros
from support import ROOT

SIMPLE = ROOT / "samples" / "bodas-test-simple.yaml"
#: Only of these processes: the messages have no part in it, and so no phase.
ONE = ("--by", "simulation", "--duration", "5ms", "--phase", "Message_Factor=0ms")


@pytest.fixture
def watch(tmp_path):
    """A function that writes measured values of one object, in microseconds."""

    def write(*values, name="Control_Function", quantity="response_time"):
        path = tmp_path / "watch.csv"
        lines = (f"{name},process,{quantity},{value}\n" for value in values)
        path.write_text("object,kind,quantity,value_us\n" + "".join(lines))
        return path

    return write


def test_a_model_that_holds(watch):
    run = amuros("compare", SIMPLE, watch(16, 16), *ONE)
    assert run.returncode == 0, run.stderr
    assert run.stdout.splitlines()[-1].startswith("Model holds: 4 comparisons within 20 % of the measurement")


def test_a_deviation_that_is_too_large(watch):
    run = amuros("compare", SIMPLE, watch(20.1), *ONE)
    assert run.returncode == 1
    assert "largest deviation +20.4 %" in run.stdout
    assert amuros("compare", SIMPLE, watch(20.1), *ONE, "--tolerance", "21%").returncode == 0


def test_a_bound_that_is_refuted_is_an_error(watch):
    run = amuros("compare", SIMPLE, watch(16, 16.5), "--by", "analysis")
    assert run.returncode == 1
    assert "CMP001 error: the model is wrong" in run.stderr
    assert "Model refuted: max response time of Control_Function is 16.5 us, 500 ns above the upper bound" in run.stdout
    assert amuros("compare", SIMPLE, watch(16, 16.5), "--by", "analysis", "--uncertainty", "1us").returncode == 0


def test_extremes_are_rounded_outwards_everywhere(watch):
    """One measured value is one number in all tables and in the closing line."""
    run = amuros("compare", SIMPLE, watch(15.99991, 16.00001), "--by", "both", "--phase", "Message_Factor=0ms")
    predicted, bounds, _ = (line for line in run.stdout.splitlines() if line.startswith("  Control_Function  "))
    (limit,) = (line for line in run.stdout.splitlines() if line.startswith("  Control_Function_response_time  "))
    assert "15.99 us / 16 us / 16.01 us" in predicted
    assert all("16.01 us" in row for row in (bounds, limit))
    assert "min response time of Control_Function is 15.99 us, 90 ps below" in run.stdout.splitlines()[-1]


def test_limits_that_were_not_measured_have_one_cause(watch):
    """So that long tables say it once, in one footnote."""
    run = amuros("compare", SIMPLE, watch(16, name="Executor_Task"), *ONE, "--output", "json")
    causes = {limit["reason"] for limit in json.loads(run.stdout)["requirements"] if limit["verdict"] == "not_observed"}
    assert causes == {"no value of it was measured"}


def test_a_limit_that_is_missed(watch):
    run = amuros("compare", SIMPLE, watch(1100), *ONE, "--tolerance", "99%")
    assert run.returncode == 1
    assert "limit missed: response time of Control_Function is 1.1 ms, at most 1 ms" in run.stdout


def test_names_overheads_and_changes(watch):
    trace = watch(58, name="Task_B", quantity="duration")
    run = amuros("compare", SIMPLE, trace, *ONE, "--as", "Task_B=Control_Function.response_time", "--overhead", "41us", "--set",
                 "Control_Function.execution_time=5us", "--output", "json")  # fmt: skip
    found = json.loads(run.stdout)
    assert found["summary"]["holds"]
    assert {(row["trace_object"], row["object"]) for row in found["rows"] if row["statistic"]} == {
        ("Task_B", "Control_Function")
    }
    assert found["rows"][0]["predicted_ps"] == 58_000_000
    assert found["changes"][0]["key"] == "Control_Function.execution_time"
    mapped = amuros("compare", SIMPLE, watch(16, name="Task_B"), *ONE, "--map", "Task_B=Control_Function")
    assert mapped.returncode == 0


def test_nothing_to_compare(watch):
    run = amuros("compare", SIMPLE, watch(1, name="Other"), *ONE)
    assert run.returncode == 1
    assert "CMP005 error" in run.stderr
    assert run.stdout.splitlines()[-1] == "Nothing compared: no measured quantity is predicted"


def test_files(watch, tmp_path):
    amuros("compare", SIMPLE, watch(16, 17), "--duration", "5ms", "--phase", "Message_Factor=0ms", "--picture",
           tmp_path / "p.svg", "--output", f"markdown={tmp_path / 'c.md'}")  # fmt: skip
    assert "<title>response time of Control_Function: measured 16 us to 17 us" in (tmp_path / "p.svg").read_text()
    page = (tmp_path / "c.md").read_text()
    assert page.startswith("# Comparison with a measurement\n\n**Model refuted:")
    assert "## Bounds of the analysis" in page


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--tolerance", "20"), "write percent"),
        (("--map", "a=b"), "unknown object of the trace 'a'"),
        (("--as", "a=b"), "is not of the form MEASURED=OBJECT.QUANTITY"),
        (("--overhead", "Nobody=1us"), "unknown process 'Nobody'"),
        (("--overhead", "1"), "has no unit"),
        (("--by", "magic"), "'magic' is not one of"),
        (("--uncertainty", "-1us"), "must not be negative"),
    ],
)
def test_wrong_options_are_refused(options, message, watch):
    run = amuros("compare", SIMPLE, watch(16), *ONE, *options)
    assert run.returncode == 2
    assert message in run.stderr.replace("\n", " ")


def test_a_picture_does_not_replace_a_file_that_is_read(watch):
    path = watch(16)
    path = path.rename(path.with_suffix(".svg"))
    run = amuros("compare", SIMPLE, path, "--picture", path)
    assert run.returncode == 2
    assert "would replace a file that is read" in run.stderr
