"""`amuros diff` as people and programs see it."""

import json
import subprocess
import sys
from io import StringIO
from pathlib import Path

import pytest
from click.testing import CliRunner

from amalthea_uros import diff
from amalthea_uros.cli.models import diff as command
from amalthea_uros.metamodel.classes import Amalthea, Label, SWModel
from amalthea_uros.metamodel.model import Model
from amalthea_uros.report import formats

HEAD = (
    '<am:Amalthea xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"'
    ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0">\n'
)
OLD = """<swModel>
<tasks name="Executor_Task" preemption="preemptive" stimuli="S?type=PeriodicStimulus"/>
<labels name="Y"/>
</swModel>
"""
NEW = """<swModel>
<tasks name="Executor_Task" preemption="cooperative"/>
<runnables name="X"><activityGraph><items xsi:type="am:Ticks"/></activityGraph></runnables>
</swModel>
"""
EXPECTED = """\
Timing
  Executor_Task: preemption preemptive -> cooperative
  + runnable X

Objects
- Label Y
~ Task Executor_Task
    stimuli: removed S
    preemption: preemptive -> cooperative
+ Runnable X (2 parts)

4 differences: 1 added, 1 removed, 2 changed
"""


@pytest.fixture
def files(tmp_path) -> tuple[str, str]:
    paths = tmp_path / "old.amxmi", tmp_path / "new.amxmi"
    for path, body in zip(paths, (OLD, NEW), strict=True):
        path.write_text(f"{HEAD}{body}</am:Amalthea>\n")
    return str(paths[0]), str(paths[1])


def run(*arguments: str):
    return CliRunner().invoke(command, arguments, catch_exceptions=False)


def test_text_is_grouped_by_object(files) -> None:
    result = run(*files)
    assert (sorted(result.output.splitlines()), result.exit_code) == (sorted(EXPECTED.splitlines()), 1)
    lines = result.output.splitlines()
    assert lines[:5] == EXPECTED.splitlines()[:5]
    assert lines[lines.index("~ Task Executor_Task") + 1].startswith("    ")
    assert lines[-1] == EXPECTED.splitlines()[-1]


def test_no_difference(files) -> None:
    result = run(files[0], files[0])
    assert (result.output, result.exit_code) == ("no differences in meaning\n", 0)


def test_folder_is_one_model(files, tmp_path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    (folder / "a.amxmi").write_text(Path(files[0]).read_text())
    assert run(files[0], str(folder)).exit_code == 0


def test_json_tells_where(files) -> None:
    result = run("--output", "json", *files)
    answer = json.loads(result.output)
    assert (answer["old"], answer["new"], result.exit_code) == (*files, 1)
    changes = {(c["class"], c["feature"]): c for c in answer["changes"]}
    assert changes["Task", "preemption"] == {
        "kind": "changed",
        "class": "Task",
        "object": "Executor_Task",
        "feature": "preemption",
        "old": "preemptive",
        "new": "cooperative",
        "old_location": {"file": files[0], "line": 3, "column": 29},
        "new_location": {"file": files[1], "line": 3, "column": 29},
    }
    assert changes["Label", ""]["new_location"] is None
    assert changes["Label", ""]["old_location"] == {"file": files[0], "line": 4, "column": 1}


def test_several_outputs(files, tmp_path) -> None:
    target = tmp_path / "result.json"
    result = run("--output", "text", "--output", f"json={target}", *files)
    assert result.output.endswith("4 differences: 1 added, 1 removed, 2 changed\n")
    assert len(json.loads(target.read_text())["changes"]) == 4


def test_colours_on_a_terminal(monkeypatch) -> None:
    class Screen(StringIO):
        def isatty(self) -> bool:
            return True

    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.delenv("NO_COLOR", raising=False)
    empty, full = (Model.of(Amalthea(sw_model=SWModel(labels=labels))) for labels in ([], [Label(name="L")]))
    added, removed = Screen(), Screen()
    formats.write("text", diff(empty, full), added)
    formats.write("text", diff(full, empty), removed)
    assert "\x1b[32m+ Label L\x1b[0m" in added.getvalue()
    assert "\x1b[31m- Label L\x1b[0m" in removed.getvalue()


def test_unreadable_model_is_told_as_finding(files, tmp_path) -> None:
    arguments = [sys.executable, "-m", "amalthea_uros", "diff", files[0], str(tmp_path / "missing.amxmi")]
    result = subprocess.run(arguments, capture_output=True, text=True, check=False)
    assert (result.returncode, result.stdout) == (2, "")
    assert "XMI001" in result.stderr
