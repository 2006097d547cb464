"""`amuros lsp`, as an editor uses it: a process that answers in JSON-RPC."""

import json
import re
import sys
from collections import defaultdict

import pytest
import yaml
from click.testing import CliRunner
from command import amuros
from effort import every
from language_client import LanguageClient, at
from support import MODEL, ROOT

from amalthea_uros.cli.main import cli
from amalthea_uros.services.fix import fix_files
from amalthea_uros.validate.settings import CheckSettings

pytest.importorskip("pygls")

SAMPLE = (ROOT / "samples" / "bodas-test-advanced.yaml").read_text()
START = "amuros: 1\nname: a\nhardware: single-core\n"
TASKS = "tasks:\n  - {name: A, period: 10 ms, execution_time: 1 ms}\n  - {name: B, period: 20 ms, execution_time: 2 ms}\n"


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    client = LanguageClient([sys.executable, "-m", "amalthea_uros", "lsp"], tmp_path_factory.mktemp("editor"))
    yield client
    client.kill()


@pytest.fixture
def file(server, tmp_path):
    """The path of an app.yaml that is not on disk."""
    yield (path := tmp_path / "app.yaml")
    server.notify("textDocument/didClose", {"textDocument": {"uri": path.as_uri()}})


def found(diagnostics):
    """Each diagnostic as its line, its columns, its id and the first line of its message, counted from 0."""
    return [
        (d["range"]["start"]["line"], d["range"]["start"]["character"], d["range"]["end"]["character"], d["code"])
        for d in diagnostics
    ]


def position_of(text, part):
    before = text[: text.index(part)]
    return before.count("\n"), len(before) - before.rfind("\n") - 1


def test_a_text_without_findings_has_no_diagnostics(server, file):
    assert server.open(file, SAMPLE) == []


def test_a_finding_is_a_diagnostic_with_its_place_and_page(server, file):
    (diagnostic,) = server.open(file, START + "tasks:\n  - {name: A, perod: 10 ms, execution_time: 1 ms, period: 1 ms}\n")
    assert found([diagnostic]) == [(4, 14, 19, "YML010")]
    assert diagnostic["message"] == "unknown key 'perod'\nDid you mean 'period'?"
    assert diagnostic["severity"] == 1
    assert diagnostic["codeDescription"]["href"].endswith("/rules/YML010/")


def test_the_diagnostics_are_the_findings_of_check(server, file):
    # C(A) + C(B) is more than the period of A: overload
    text = START + TASKS.replace("execution_time: 1 ms", "execution_time: 11 ms")
    shown = {(line + 1, code) for line, _, _, code in found(server.open(file, text))}
    file.write_text(text)
    checked = {line.split(": ")[1].split()[0] for line in amuros("check", file).stdout.splitlines() if "app.yaml:" in line}
    assert {code for _, code in shown} == checked != set()


def test_columns_are_counted_in_units_of_utf_16(server, file):
    # U+1F600 has two units.
    text = START + 'tasks:\n  - {name: "\U0001f600", perod: 1 ms, period: 1 ms, execution_time: 1 us}\n'
    assert found(server.open(file, text)) == [(4, 17, 22, "YML010")]


def test_what_is_no_yaml_is_a_diagnostic_too(server, file):
    ((line, _, _, code),) = found(server.open(file, START + "tasks: [\n"))
    assert (line >= 3, code) == (True, "YML001")
    server.change(file, SAMPLE)
    assert server.diagnostics_of(file) == []


def test_yaml_of_other_programs_is_left_alone(server, file):
    assert server.open(file, "services:\n  web: {image: x}\n") == []


def test_many_quick_changes_end_with_the_diagnostics_of_the_last_text(server, file):
    server.start_open(file, SAMPLE)
    for end in range(len(SAMPLE) - 60, len(SAMPLE)):
        server.change(file, SAMPLE[:end])
    server.change(file, START + "taks: []\n")
    assert found(server.diagnostics_of(file)) == [(3, 0, 4, "YML010")]


def test_a_hover_shows_the_response_time_and_the_verdict_of_analyze(server, file):
    server.open(file, START + TASKS)
    # B waits for one job of A: 1 ms + 2 ms
    hover = server.hover(file, *position_of(START + TASKS, "B,"))
    assert "**met**: worst-case response time 3 ms (exact), deadline 20 ms (the period)" in hover
    file.write_text(START + TASKS)
    explained = amuros("analyze", file, "--explain", "B").stdout
    assert [line for line in explained.splitlines() if line] == hover.split("```")[1].splitlines()[1:]


LATE = START + (
    "tasks:\n  - {name: A, period: 10 ms, execution_time: 1 ms, writes: [x]}\n"
    "  - {name: B, period: 20 ms, execution_time: 2 ms, reads: [x]}\n"
    "chains:\n  - {name: a-to-b, path: [A, x, B], reaction: 5 ms}\n"
)


@pytest.mark.parametrize(
    ("text", "chain", "shown"),
    [
        (SAMPLE, "factor-to-output", "**met**: reaction at most 25 ms"),
        # A value may wait for nearly a whole period of B.
        (LATE, "a-to-b", "**missed**: reaction at most 5 ms"),
    ],
)
def test_a_hover_on_a_chain_begins_with_the_answer_of_analyze(server, file, text, chain, shown):
    server.open(file, text)
    hover = server.hover(file, *position_of(text, chain))
    file.write_text(text)
    answer = amuros("analyze", file).stdout.splitlines()[0]
    assert hover.startswith(f"```text\n{answer}\n```")
    assert shown in hover
    assert "what would shorten it" in hover


def test_a_hover_follows_the_text(server, file):
    server.open(file, START + TASKS)
    place = position_of(START + TASKS, "A,")
    assert "response time 1 ms" in server.hover(file, *place)
    server.change(file, (START + TASKS).replace("execution_time: 1 ms", "execution_time: 11 ms"))
    assert "**met**" not in server.hover(file, *place)
    server.change(file, START + "tasks: [\n")
    assert server.hover(file, *place) == ""


def test_a_hover_on_a_key_shows_what_it_means(server, file):
    server.open(file, SAMPLE)
    assert server.hover(file, *position_of(SAMPLE, "hardware")) == "**hardware**: The controller."


def keys_in(node):
    """The nodes of all keys; identifiers of messages are given to names, which mean nothing else."""
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            yield key
            yield from () if key.value == "identifiers" else keys_in(value)
    elif isinstance(node, yaml.SequenceNode):
        for item in node.value:
            yield from keys_in(item)


@pytest.mark.parametrize("path", sorted((ROOT / "samples").glob("*.yaml")), ids=lambda path: path.stem)
def test_each_key_of_a_sample_has_a_meaning(server, file, path):
    server.start_open(file, text := path.read_text())
    for key in every(8, list(keys_in(yaml.compose(text)))):
        hover = server.hover(file, key.start_mark.line, key.start_mark.column)
        assert re.match(rf"\*\*{key.value}\*\*: .{{5}}", hover), (key.value, hover)


SCHEMA = json.loads((ROOT / "schemas" / "app.schema.json").read_text())


def forms(schema):
    """The alternatives of a value in the schema, without references."""
    if "$ref" in schema:
        return forms(SCHEMA["definitions"][schema["$ref"].rpartition("/")[2]])
    others = [*schema.get("anyOf", ()), *schema.get("allOf", ())]
    return [schema, *(form for other in others for form in forms(other))]


def mappings(schema, text, depth=5):
    """What is written before the keys of each mapping, and one of its keys, down to a depth."""
    for form in forms(schema):
        inside = [(f"{text}{key}: ", value) for key, value in form.get("properties", {}).items()]
        inside += [(f"{text}a_name: ", value) for value in form.get("patternProperties", {}).values() if text]
        for written, value in inside:
            yield text, written.removeprefix(text).removesuffix(": ")
            for other in forms(value) if depth else ():
                if "items" in other:
                    yield from mappings(other["items"], f"{written}[{{", depth - 1)
                elif "properties" in other or "patternProperties" in other:
                    yield from mappings(other, f"{written}{{", depth - 1)


def test_each_key_of_the_schema_is_completed_with_its_meaning(server, file):
    expected = defaultdict(set)
    for text, key in mappings(SCHEMA, ""):
        expected[text].add(key)
    assert len(expected) > 300
    server.start_open(file, "amuros: 1\n")
    for text in every(8, sorted(expected)):
        server.change(file, f"amuros: 1\n{text}")
        items = server.request("textDocument/completion", at(file, 1, len(text)))
        assert {item["label"] for item in items} == expected[text] - {"amuros", "a_name"}, text
        assert all(item["documentation"]["value"] for item in items), text


def test_a_text_that_is_too_large_to_analyze_says_so(server, file):
    text = START + TASKS + "# " + "x" * 1_000_000
    assert server.open(file, text) == []
    assert "too large" in server.hover(file, *position_of(text, "A,"))


def test_the_limit_of_the_size_holds(server, file):
    text = START + "# " + "x" * (5 * 2**20)
    assert [code for *_, code in found(server.open(file, text))] == ["YML002"]


def test_keys_are_completed_and_suggestions_are_quick_fixes(server, file):
    text = START + "tasks:\n  - {name: A, execution_time: 1 ms, perod: 10 ms, "
    diagnostics = server.open(file, text)
    line, column = position_of(text + "|", "|")
    assert "deadline" in [item["label"] for item in server.request("textDocument/completion", at(file, line, column))]
    server.change(file, text + "}")
    diagnostics = server.diagnostics_of(file)
    everything = {"start": {"line": 0, "character": 0}, "end": {"line": 99, "character": 0}}
    params = {"textDocument": {"uri": file.as_uri()}, "range": everything, "context": {"diagnostics": diagnostics}}
    (action,) = [each for each in server.request("textDocument/codeAction", params) if each["title"] == "Replace by 'period'"]
    assert edited(text + "}", action["edit"]["changes"][file.as_uri()]) == text.replace("perod", "period") + "}"


def test_names_are_symbols_and_lead_to_their_definitions(server, file):
    server.open(file, SAMPLE)
    symbols = server.request("textDocument/documentSymbol", {"textDocument": {"uri": file.as_uri()}})
    assert [symbol["name"] for symbol in symbols] == ["Executor_Task", "bodas", "factor-to-output"]
    assert [symbol["name"] for symbol in symbols[1]["children"]] == ["Message_Factor", "Control_Function"]
    line, column = position_of(SAMPLE, "Control_Function], reaction")
    place = server.request("textDocument/definition", at(file, line, column + 3))
    start = place["range"]["start"]
    assert (start["line"], start["character"]) == position_of(SAMPLE, "Control_Function, period")


@pytest.mark.parametrize(
    "content",
    [
        '<swModel><tasks/><tasks name="Task_1"/></swModel>',
        '<swModel><tasks name="\U0001f600"/><tasks name="T"/><isrs name="T"/><tasks name="T"/></swModel>',
    ],
)
def test_an_action_makes_of_a_model_what_fix_makes_of_it(server, tmp_path, content):
    path = tmp_path / "model.amxmi"
    text = MODEL.format(content)
    diagnostics = server.open(path, text, "xml")
    everything = {"start": {"line": 0, "character": 0}, "end": {"line": 99, "character": 0}}
    params = {"textDocument": {"uri": path.as_uri()}, "range": everything, "context": {"diagnostics": diagnostics}}
    actions = server.request("textDocument/codeAction", params)
    for action in actions:
        rules = {found["code"] for found in action.get("diagnostics", [])}
        path.write_text(text)
        fix_files(path, CheckSettings(select=tuple(rules)))
        assert edited(text, action["edit"]["changes"][path.as_uri()]) == path.read_text() != text
    assert {action["kind"] for action in actions} == {"quickfix", "source.fixAll.amuros"}


def edited(text, edits):
    """A text after edits, whose positions count units of UTF-16."""
    (edit,) = edits
    lines = [line.encode("utf-16-le") for line in text.splitlines(keepends=True)]

    def offset(place):
        return len(b"".join(lines[: place["line"]])) + 2 * place["character"]

    whole = b"".join(lines)
    before, after = whole[: offset(edit["range"]["start"])], whole[offset(edit["range"]["end"]) :]
    return (before + edit["newText"].encode("utf-16-le") + after).decode("utf-16-le")


def test_a_hover_on_a_name_in_a_model_shows_the_same_as_in_its_description(server, file, tmp_path):
    file.write_text(START + TASKS)
    assert amuros("build", file, "-o", tmp_path / "app.amxmi").returncode == 0
    text = (tmp_path / "app.amxmi").read_text()
    server.open(tmp_path / "app.amxmi", text, "xml")
    line, column = position_of(text, 'name="B"')
    assert "worst-case response time 3 ms (exact)" in server.hover(tmp_path / "app.amxmi", line, column + len('name="'))


TASK = MODEL.format('<swModel><tasks name="A" stimuli="S?type=PeriodicStimulus"/></swModel>')
STIMULUS = MODEL.format(
    '<stimuliModel><stimuli xsi:type="am:PeriodicStimulus" name="S"><recurrence value="5" unit="ms"/></stimuli></stimuliModel>'
)


def unresolved(diagnostics):
    return {found["code"] for found in diagnostics} & {"XMI020", "XMI025", "AM-EMF-INTRINSIC/proxy-resolves"}


def test_a_reference_to_another_file_of_the_folder_is_resolved_as_check_does_it(server, tmp_path):
    path, other = tmp_path / "tasks.amxmi", tmp_path / "stimuli.amxmi"
    assert unresolved(server.open(path, TASK, "xml"))
    other.write_text(STIMULUS)
    server.change(path, TASK + "\n")
    shown = server.diagnostics_of(path)
    path.write_text(TASK)
    checked = amuros("check", tmp_path, "--output", "json").stdout
    findings = json.loads(checked)["findings"]
    assert not unresolved(shown)
    assert {found["code"] for found in shown} <= {each["rule"] for each in findings if each["file"] == str(path)}
    server.change(path, TASK.replace('"S?', '"T?'))
    assert unresolved(server.diagnostics_of(path))


def test_a_file_to_which_others_refer_is_part_of_their_model(server, tmp_path):
    """That the task is not mapped is only said while no other file maps it."""
    path = tmp_path / "tasks.amxmi"
    task = MODEL.format('<swModel><tasks name="A"/></swModel>')
    assert "TIM-ALLOCATION" in {found["code"] for found in server.open(path, task, "xml")}
    mapping = MODEL.format(
        '<osModel><operatingSystems name="O"><taskSchedulers name="S"/></operatingSystems></osModel>'
        '<mappingModel><taskAllocation task="A?type=Task" scheduler="S?type=TaskScheduler"/></mappingModel>'
    )
    (tmp_path / "mapping.amxmi").write_text(mapping)
    server.change(path, task + "\n")
    assert "TIM-ALLOCATION" not in {found["code"] for found in server.diagnostics_of(path)}


def test_unrelated_and_broken_files_of_the_folder_do_not_matter(server, tmp_path):
    path = tmp_path / "tasks.amxmi"
    alone = found(server.open(path, TASK, "xml"))
    (tmp_path / "twin.amxmi").write_text(TASK)  # would define A twice
    server.change(path, TASK + "\n")
    assert found(server.diagnostics_of(path)) == alone
    (tmp_path / "broken.amxmi").write_text("<am:Amalthea")
    server.change(path, TASK)
    assert found(server.diagnostics_of(path)) == alone


def test_a_closed_text_has_no_diagnostics(server, tmp_path):
    path = tmp_path / "closed.yaml"
    assert server.open(path, START + "taks: []\n") != []
    server.notify("textDocument/didClose", {"textDocument": {"uri": path.as_uri()}})
    server.request("textDocument/documentSymbol", {"textDocument": {"uri": path.as_uri()}})
    assert server.diagnostics[path.as_uri()]["diagnostics"] == []


def test_the_server_ends_when_it_is_asked_to(tmp_path):
    client = LanguageClient([sys.executable, "-m", "amalthea_uros", "lsp", "--stdio"], tmp_path)
    assert client.open(tmp_path / "app.yaml", SAMPLE) == []
    assert client.end() == 0
    assert client.stderr == []


def test_an_error_inside_is_a_message_in_the_log_and_the_server_goes_on(tmp_path):
    broken = """
from amalthea_uros.editor import server
def fail(document):
    raise RuntimeError("a bug")
server.symbols_of = fail
server.create_server().start_io()
"""
    client = LanguageClient([sys.executable, "-c", broken], tmp_path)
    path = tmp_path / "app.yaml"
    client.open(path, START + "taks: []\n")
    assert client.request("textDocument/documentSymbol", {"textDocument": {"uri": path.as_uri()}}) is None
    assert [message["method"] for message in client.messages] == ["window/logMessage"]
    assert "a bug" in client.messages[0]["params"]["message"]
    client.change(path, SAMPLE)
    assert client.diagnostics_of(path) == []
    client.kill()


def test_without_pygls_the_command_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "pygls", None)
    run = CliRunner().invoke(cli, ["lsp"])
    assert run.exit_code == 2
    assert 'pip install "amuros[lsp]"' in run.stderr
