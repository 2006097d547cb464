"""Names of a model are shown and written as names: no spreadsheet and no CI system executes them."""

import csv
import json

import pytest
from command import amuros

import amalthea_uros
from amalthea_uros._internal.csv_cells import original_text, safe_cell

NAMES = ["=HYPERLINK(1)", "+1", "-1", "@SUM(1)", "\tx", "::error::gone", " ::error::gone", "'=1", "''+1"]


@pytest.mark.parametrize("name", NAMES)
def test_a_dangerous_cell_gets_an_apostrophe_that_is_taken_away_again(name):
    cell = safe_cell(name)
    assert cell == f"'{name}"
    assert original_text(cell) == name


@pytest.mark.parametrize("name", ["speed", "a=b", "a::b", "'quoted'", ":x", "1+1", ""])
def test_all_others_are_as_they_are(name):
    assert safe_cell(name) == original_text(name) == name


@pytest.fixture
def description(tmp_path):
    path = tmp_path / "app.yaml"
    tasks = [{"name": name, "period": "1 ms", "priority": 1, "execution_time": "1 us"} for name in ("=1+1", "::error::gone")]
    path.write_text(json.dumps({"amuros": 1, "name": "m", "hardware": {"platform": "single-core"}, "tasks": tasks}))
    return path


def header(path):
    with path.open(newline="") as stream:
        return {name.split(".")[0] for name in next(csv.reader(stream))}


def test_tables_have_no_formulas_unless_somebody_wants_the_names_as_they_are(description, tmp_path):
    words = ["simulate", description, "--duration", "3ms", "--table", tmp_path / "t.csv"]
    amuros(*words)
    assert {"'=1+1", "'::error::gone"} <= header(tmp_path / "t.csv")
    amuros(*words, "--raw-names")
    assert {"=1+1", "::error::gone"} <= header(tmp_path / "t.csv")


def test_traces_and_measurements_have_none_either_and_are_read_as_the_same_names(description, tmp_path):
    amuros("simulate", description, "--duration", "3ms", "--trace", tmp_path / "run.csv")
    assert ",'=1+1," in (tmp_path / "run.csv").read_text()
    run = amuros("measure", tmp_path / "run.csv", "--output", f"csv={tmp_path / 'values.csv'}")
    assert run.returncode == 0, run.stderr
    assert "\n'::error::gone," in (tmp_path / "values.csv").read_text()
    trace, values = (amalthea_uros.measure(tmp_path / name) for name in ("run.csv", "values.csv"))
    names = {series.name for series in trace.series}
    assert names == {series.name for series in values.series}
    assert names >= {"=1+1", "::error::gone"}


@pytest.mark.parametrize("colour", ["never", "always"])
def test_no_line_of_output_is_a_command_of_a_ci_system(description, tmp_path, colour):
    text = description.read_text().replace("1 us", "2 ms")
    description.write_text(text.replace("{", "{\n::error::gone: 1,\n", 1))
    for words in (["check"], ["analyze"], ["simulate", "--duration", "3ms"]):
        run = amuros(*words, description, "--color", colour)
        assert not [line for line in (run.stdout + run.stderr).splitlines() if line.lstrip().startswith("::")]
