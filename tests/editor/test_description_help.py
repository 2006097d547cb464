"""Completion, the meaning of keys, and quick fixes in an app.yaml, while it is written."""

import re

import pytest
from effort import every
from support import ROOT

pytest.importorskip("pygls")

from lsprotocol import types

from amalthea_uros.editor.diagnostics import diagnostics_of
from amalthea_uros.editor.document import TextDocument
from amalthea_uros.editor.keys import completions, key_hover
from amalthea_uros.editor.quick_fixes import quick_fixes
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.schema_places import places_of_keys

START = "amuros: 1\nname: a\nhardware: single-core\n"


def document(tmp_path, text):
    path = tmp_path / "app.yaml"
    return TextDocument(path.as_uri(), path, text, 1)


def at_cursor(tmp_path, text):
    """The text without `|`, and where that is."""
    before, _, after = text.partition("|")
    lines = before.split("\n")
    return document(tmp_path, before + after), types.Position(len(lines) - 1, len(lines[-1]))


def labels(tmp_path, text):
    return [item.label for item in completions(*at_cursor(tmp_path, text))]


def edited(text, edit):
    lines = text.split("\n")
    start, end = edit.range.start, edit.range.end
    assert start.line == end.line
    line = lines[start.line]
    lines[start.line] = line[: start.character] + edit.new_text + line[end.character :]
    return "\n".join(lines)


@pytest.mark.parametrize(
    ("text", "expected", "missing"),
    [
        (START + "|", "tasks", "name"),
        (START + "ta|", "tasks", "hardware"),
        (START + "tasks:\n  - |", "period", "transport"),
        (START + "tasks:\n  - name: A\n    |", "period", "name"),
        (START + "tasks:\n  - {name: A, per|", "period", "name"),
        (START + "tasks:\n  - {name: A, |}\nchains: []\n", "execution_time", "path"),
        ("amuros: 1\nmiddleware:\n  transport:\n    serial:\n      |", "baud_rate", "serial"),
        ("amuros: 1\nmiddleware:\n  transport: {serial: {|", "driver", "can"),
    ],
)
def test_keys_are_completed(tmp_path, text, expected, missing):
    found = labels(tmp_path, text)
    assert expected in found
    assert missing not in found


def test_words_are_completed(tmp_path):
    assert {"preemptive", "cooperative"} <= set(labels(tmp_path, START + "tasks:\n  - {name: A, preemption: |"))
    assert "nucleo-f446re" in labels(tmp_path, "amuros: 1\nhardware:\n  platform: nuc|")
    assert "bodas-rc18-12-40" in labels(tmp_path, "amuros: 1\nhardware: |")
    assert labels(tmp_path, "amuros: 1\nname: |") == []


def test_a_completion_replaces_what_is_written(tmp_path):
    text = START + "tasks:\n  - {name: A, per"
    item = next(each for each in completions(*at_cursor(tmp_path, text + "|")) if each.label == "period")
    assert edited(text, item.text_edit) == START + "tasks:\n  - {name: A, period: "


def test_a_key_has_a_meaning_also_in_a_text_with_errors(tmp_path):
    hover = key_hover(*at_cursor(tmp_path, START + "tasks:\n  - {name: A, per|iod: 10 ms, [\n"))
    assert hover.contents.value.startswith("**period**: ")
    assert (hover.range.start.character, hover.range.end.character) == (14, 20)
    assert key_hover(*at_cursor(tmp_path, START.replace("a\n", "a|\n"))) is None
    assert key_hover(*at_cursor(tmp_path, START + "no|thing: 1\n")) is None


def test_yaml_of_other_programs_is_left_alone(tmp_path):
    assert labels(tmp_path, "version: 3\n|") == []


@pytest.mark.parametrize(
    ("line", "repaired"),
    [
        ("tasks: [{name: A, perod: 10 ms, execution_time: 1 ms}]", "tasks: [{name: A, period: 10 ms, execution_time: 1 ms}]"),
        ("tasks: [{name: A, period: 10 Ms, execution_time: 1 ms}]", "tasks: [{name: A, period: 10 ms, execution_time: 1 ms}]"),
        ("requirements: [{process: Tsk, response_time: 1 ms}]", "requirements: [{process: Task, response_time: 1 ms}]"),
    ],
)
def test_what_a_finding_suggests_is_a_quick_fix(tmp_path, line, repaired):
    text = START + "isrs: [{name: Task, execution_time: 1 us, period: 1 ms}]\n" + line
    made = document(tmp_path, text)
    (action,) = [each for each in quick_fixes(made, diagnostics_of(made), None) if each.title.startswith("Replace by")]
    (change,) = action.edit.changes[made.uri]
    assert edited(text, change).endswith(repaired)
    assert action.is_preferred


@pytest.mark.parametrize("path", every(3, sorted((ROOT / "samples").glob("*.yaml"))), ids=lambda path: path.stem)
def test_a_letter_that_is_missing_in_a_key_comes_back(path):
    text = path.read_text()
    known = places_of_keys(Description).keys() - {"amuros"}
    keys = [found for found in re.finditer(r"^ *(?:- )?\{?([a-z_]{4,}):\s", text, re.MULTILINE) if found[1] in known]
    for found in every(9, keys):
        wrong = text[: found.start(1) + 1] + text[found.start(1) + 2 :]
        made = TextDocument(path.as_uri(), path, wrong, 1)
        actions = [each for each in quick_fixes(made, diagnostics_of(made), None) if each.title == f"Replace by '{found[1]}'"]
        assert edited(wrong, actions[0].edit.changes[made.uri][0]) == text


def test_a_finding_can_be_accepted(tmp_path):
    text = START + "chains:\n  - {name: c, path: [A, B]}\ntasks:\n"
    text += "  - {name: A, period: 10 ms, execution_time: 1 ms}\n  - {name: B, period: 20 ms, execution_time: 1 ms, deadline: 1 s}\n"
    made = document(tmp_path, text)
    before = [each for each in diagnostics_of(made) if each.severity is not types.DiagnosticSeverity.Error]
    assert before
    for diagnostic in before:
        action = next(each for each in quick_fixes(made, [diagnostic], None) if each.title.startswith("Accept"))
        (change,) = action.edit.changes[made.uri]
        after = document(tmp_path, edited(text, change))
        assert diagnostic.code not in {each.code for each in diagnostics_of(after)}
    assert quick_fixes(made, before, ["source.fixAll"]) == []
