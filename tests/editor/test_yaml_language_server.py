"""The JSON Schema in yaml-language-server, which VS Code, Neovim and others use: messages, completion and hovers."""

import shutil
from itertools import count

import pytest
from language_client import LanguageClient, at
from support import ROOT

SERVER = ROOT / "tests" / "node" / "node_modules" / "yaml-language-server" / "bin" / "yaml-language-server"
SCHEMA = ROOT / "schemas" / "app.schema.json"
START = "amuros: 1\nname: a\nhardware: single-core\n"

pytestmark = pytest.mark.skipif(
    shutil.which("node") is None or not SERVER.exists(), reason="needs node and tests/node: npm install"
)


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    yaml = {
        "validate": True,
        "hover": True,
        "completion": True,
        "schemas": {SCHEMA.as_uri(): "*.yaml"},
        "schemaStore": {"enable": False},
    }
    capabilities = {
        "workspace": {"configuration": True},
        "textDocument": {"completion": {"completionItem": {"snippetSupport": True}}},
    }
    client = LanguageClient(["node", SERVER, "--stdio"], tmp_path_factory.mktemp("yaml"), {"yaml": yaml}, capabilities)
    yield client
    client.kill()


@pytest.fixture
def opened(server, tmp_path):
    """Opens a text, and gives its path with the diagnostics."""
    numbers = count()

    def open_text(text):
        path = tmp_path / f"app{next(numbers)}.yaml"
        server.start_open(path, text)
        return path, server.any_diagnostics_of(path)

    return open_text


@pytest.mark.parametrize("sample", sorted((ROOT / "samples").glob("*.yaml")), ids=lambda path: path.stem)
def test_a_sample_has_no_diagnostics(opened, sample):
    assert opened(sample.read_text())[1] == []


TIME = "expected a time above zero with a unit such as '10 ms'"


@pytest.mark.parametrize(
    ("text", "place", "message"),
    [
        ("tasks: [{name: A, period: 10, execution_time: 1 ms}]", "10,", TIME),
        ("tasks: [{name: A, period: 0 ms, execution_time: 1 ms}]", "0 ms", TIME),
        ("tasks: [{name: A, period: -5 ms, execution_time: 1 ms}]", "-5", TIME),
        ("tasks: [{name: A, period: 10 msec, execution_time: 1 ms}]", "10", TIME),
        ("tasks: [{name: A, period: 10 ms, execution_time: 1}]", "1}", TIME),
        ("tasks: [{name: A, perod: 10 ms, execution_time: 1 ms}]", "perod", "Property perod is not allowed."),
        ("tasks: [{name: A, period: 10 ms, execution_time: {min: 1 ms, max: 2}}]", "2}", TIME),
        ("tasks: [{name: A, period: 10 ms, preemption: prio}]", "prio", '"preemptive", "cooperative", "non-preemptive"'),
        ("tasks: [{name: A, period: 10 ms, offset: -1 ms}]", "-1", "a time of zero or more"),
        ("tasks: [{name: true, period: 10 ms}]", "true", "expected a name"),
        ("middleware: {transport: {can: {bitrate: 250 kbps}}}", "250", "expected a bit rate above zero"),
        ("labels: {a: {size: 4 b}}", "4 b", "expected a data size of zero or more"),
    ],
)
def test_a_mistake_has_a_diagnostic_at_its_place(opened, text, place, message):
    _, (diagnostic,) = opened(START + text + "\n")
    assert message in diagnostic["message"]
    assert (diagnostic["range"]["start"]["line"], diagnostic["range"]["start"]["character"]) == (3, text.index(place))


@pytest.mark.parametrize(
    ("text", "offered"),
    [
        (START + "tasks:\n  - name: A\n    ", {"period", "execution_time", "priority", "deadline"}),
        ("amuros: 1\nname: a\nhardware: ", {"bodas-rc18-12-40", "generic", "esp32"}),
        (START + "tasks:\n  - name: A\n    preemption: ", {"preemptive", "cooperative", "non-preemptive"}),
        ("", {"amuros", "hardware", "tasks", "chains"}),
    ],
)
def test_completion_offers_keys_and_values(server, opened, text, offered):
    path, _ = opened(text)
    line = text.count("\n")
    found = server.request("textDocument/completion", at(path, line, len(text.rpartition("\n")[2])))
    assert {item["label"] for item in (found["items"] if isinstance(found, dict) else found)} >= offered


@pytest.mark.parametrize(
    ("place", "description"),
    [
        ("period", "Periodic activation."),
        ("execution_time: 1 ms", "The same execution time in every job."),
        ("execution_time: {", "An execution time:"),
        ("semantics", "`LET`: All messages are taken before the first callback runs"),
    ],
)
def test_a_hover_shows_what_a_key_means_in_its_form(server, opened, place, description):
    text = START + (
        "middleware: {executor: {semantics: LET}}\n"
        "tasks:\n  - {name: A, period: 10 ms, execution_time: 1 ms}\n  - {name: B, execution_time: {min: 1 ms, max: 2 ms}}\n"
    )
    path, _ = opened(text)
    before = text[: text.index(place)]
    hover = server.hover(path, before.count("\n"), len(before.rpartition("\n")[2]) + 1)
    assert description in hover.replace("\\", "")
