"""`amuros analyze` ends with what would give more numbers, as a command that can be pasted."""

import json
import shlex

from command import amuros
from support import ROOT

from amalthea_uros import build_model, save
from amalthea_uros.perf.system import System

LINE = "To get numbers"
EXECUTOR = ROOT / "samples" / "executor.amxmi"


def test_the_command_that_is_shown_gives_the_numbers(tmp_path):
    model = tmp_path / "a model.amxmi"
    text = EXECUTOR.read_text()
    assert ' stimuli="' in text
    # No task is activated any more.
    head, *rest = text.split(' stimuli="')
    model.write_text(head + "".join(part.partition('"')[2] for part in rest))
    before = amuros("analyze", model, "--output", "text", "--output", f"json={tmp_path / 'before.json'}")
    lines = before.stdout.splitlines()
    start = lines.index(LINE)
    command = " ".join(line.strip().removesuffix("\\") for line in lines[start + 2 : lines.index("", start)])
    program, *words = shlex.split(command)
    assert program == "amuros"
    assert lines[-1].startswith("Not proved schedulable: ")
    after = amuros(*words, "--output", f"json={tmp_path / 'after.json'}")
    assert after.returncode in (0, 1), after.stderr
    gained = set(json.loads((tmp_path / "before.json").read_text())["missing"]["gained"])
    assert gained
    assert gained == known(tmp_path / "after.json") - known(tmp_path / "before.json")


def known(path):
    return {each["name"] for each in json.loads(path.read_text())["processes"] if each["wcrt_ps"] is not None}


def test_what_is_complete_has_no_such_lines():
    assert LINE not in amuros("analyze", EXECUTOR).stdout


def test_a_model_without_tasks_asks_for_the_file_that_has_them(tmp_path):
    model = tmp_path / "hardware.amxmi"
    save(build_model(System()), model)
    assert "The model has no tasks and no interrupts: add them, or give all files" in amuros("analyze", model).stdout
