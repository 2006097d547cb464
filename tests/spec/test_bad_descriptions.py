"""Whatever is wrong with an app.yaml is told with its place, all of it in one run."""

from operator import itemgetter

import pytest
import yaml
from support import ROOT

from amalthea_uros._internal.limits import DESCRIPTION_VALUES
from amalthea_uros.errors import ReadError
from amalthea_uros.services.build import describe
from amalthea_uros.spec import nodes
from amalthea_uros.spec.read import read_description

GOOD = """\
amuros: 1
name: app
hardware: {platform: single-core}
middleware:
  executor: {period: 1 ms, execution_time: 12 us}
application:
  nodes:
    - name: node
      timers:
        - {name: Timer, period: 1 ms, execution_time: 4 us}
"""


@pytest.fixture
def told(tmp_path):
    """What is told of a text: (line, column, rule, message, help) each."""

    def tell(text):
        path = tmp_path / "app.yaml"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        with pytest.raises(ReadError) as caught:
            read_description(path)
        for finding in caught.value.findings:
            assert finding.severity == "error"
            if finding.location.line is not None:
                assert finding.location.path == path
        return [(f.location.line, f.location.column, f.rule, f.message, f.help) for f in caught.value.findings]

    return tell


def changed(old, new):
    assert GOOD.count(old) == 1
    return GOOD.replace(old, new)


@pytest.fixture
def described(tmp_path):
    """The description of a text."""

    def read(text):
        path = tmp_path / "app.yaml"
        path.write_text(text)
        return read_description(path)

    return read


def timer_of(description):
    return description.application.nodes[0].timers[0]


@pytest.mark.parametrize(
    "row", yaml.safe_load((ROOT / "tests" / "spec" / "mistakes.yaml").read_text()), ids=itemgetter("message")
)
def test_a_mistake_with_its_place(told, row):
    line, column = map(int, row["at"].split(":"))
    assert (line, column, row["rule"], row["message"], row.get("help", "")) in told(changed(row["change"], row["to"]))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        # A single time is both the best case and the worst case.
        pytest.param("execution_time: 4 us", "execution_time: 4", id="a value that stands for several"),
        pytest.param("execution_time: 12 us", "execution_time: 1,5 us", id="a decimal comma"),
    ],
)
def test_a_mistake_is_reported_once(told, old, new):
    assert len(told(changed(old, new))) == 1


def test_all_mistakes_in_one_run(told):
    text = changed("platform:", "platfrm:").replace("1 ms", "1 mss").replace("node\n", "node\n      tmers: []\n")
    assert [(line, rule) for line, _, rule, _, _ in told(text)] == [(3, "YML010"), (5, "YML012"), (9, "YML010"), (11, "YML012")]


@pytest.mark.parametrize(
    ("text", "line", "rule", "reason"),
    [
        ("", None, "YML001", "the file is empty"),
        ("# nothing\n", None, "YML001", "the file is empty"),
        ("- a list\n", 1, "YML012", "expected a mapping, found a list"),
        ("a: [1\nb: 2\n", 2, "YML001", "not valid YAML"),
        ("a:\n\tb: 1\n", 2, "YML001", "tabs cannot be used for indentation"),
        ("a:\n  b: 1\n\tc: 2\n", 3, "YML001", "tabs cannot be used for indentation"),
        ("<?xml version='1.0'?><am:Amalthea/>", 1, "YML001", "this is an AMALTHEA model, not YAML"),
        ("<!-- old --><page/>", 1, "YML001", "this is XML, not YAML"),
        ("a: 1\nb: {<<: [x]}\n", 2, "YML001", "'<<' merges mappings, but its value is something else"),
        ("a: @b\n", 1, "YML001", "a value cannot start with '@' without quotes"),
        ("a: b: c\n", 1, "YML001", "not valid YAML"),
        ("a: 1\n--- \nb: 2\n", 2, "YML001", "several YAML documents"),
        ("a: !!python/object/apply:os.system [ls]\n", 1, "YML001", "tags are not allowed"),
        ("a: *nothing\n", 1, "YML001", "no complete anchor &nothing"),
        ("a: &a [*a]\n", 1, "YML001", "no complete anchor &a"),
        ("a: \x07\n", 1, "YML001", "the character U+0007 is not allowed"),
        (b"\xff\xfe\x00", None, "YML001", "not UTF-8"),
        ("a: " + "[" * 100_000, 1, "YML002", "nested more than 40 levels deep"),
        ("? [a]\n: b\n", 1, "YML001", "a key must be a plain string"),
        ("a: 1\n" * 2_100_000, None, "YML002", "larger than 5 MiB"),
    ],
    ids=lambda value: value[:20] if isinstance(value, str) else "",
)
def test_what_is_no_description_at_all(told, text, line, rule, reason):
    findings = told(text)
    assert len(findings) <= 100
    assert findings[-1][0] == line
    assert findings[-1][2] == rule
    assert reason in findings[-1][3]


class TestNumberOfValues:
    @pytest.fixture(autouse=True)
    def lower_limit(self, monkeypatch):
        assert DESCRIPTION_VALUES == 400_000
        monkeypatch.setattr(nodes, "DESCRIPTION_VALUES", 5_000)

    def test_there_is_a_limit(self, told):
        ((line, _, rule, message, _),) = told("a:\n" + "- b\n" * 10_000)
        # The document and its value are values, too.
        assert (line, rule) == (5_002, "YML002")
        assert "more than 5,000 values" in message

    def test_aliases_that_explode(self, told):
        levels = "".join(f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]\n" for n in range(1, 12))
        ((line, _, rule, message, _),) = told("a0: &a0 [x]\n" + levels)
        # The fourth level holds 9 to the power of 4 values.
        assert (line, rule) == (5, "YML002")
        assert "expanded aliases" in message


def test_aliases_that_do_not(described):
    text = changed("execution_time: 12 us", "execution_time: &cost 12 us").replace("4 us", "*cost")
    assert timer_of(described(text)).execution_time.max == 12_000_000


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(ReadError, match="file not found"):
        read_description(tmp_path / "none.yaml")
    with pytest.raises(ReadError, match="found a directory"):
        read_description(tmp_path)


@pytest.mark.parametrize("name", ["on", "no", "1:30", "1.10", "007", "1e3", ".inf", "2024-01-01"])
def test_names_are_what_is_written(described, name):
    """Also words that older YAML took for something else."""
    assert timer_of(described(changed("name: Timer", f"name: {name}"))).name == name


def test_a_platform_alone_and_an_offset_of_nothing(described):
    text = changed("{platform: single-core}", "single-core")
    hardware = described(text.replace("execution_time: 4 us", "execution_time: 4 us, offset: 0 ms")).hardware
    assert (hardware.platform, hardware.location().line) == ("single-core", 3)


def test_places_of_values(described):
    timer = timer_of(described(GOOD))
    assert (timer.name, timer.location().line, timer.location().column) == ("Timer", 10, 11)
    assert (timer.location("period").column, timer.execution_time.location().column) == (33, 55)
    # What is not stated stands where its section does.
    assert timer.location("offset") == timer.location()
    assert timer.location().text == GOOD.splitlines()[9]


def test_a_chain_of_aliases_that_nests_deeply(told):
    """Each alias adds a level, although the text itself is flat."""
    levels = "".join(f"a{n}: &a{n} [*a{n - 1}]\n" for n in range(1, 800))
    ((line, _, rule, message, _),) = told("a0: &a0 [x]\n" + levels)
    # Level 1 is the document, level 2 the value of a0, level 3 its item: a38 is the first one that is 40 levels deep with its document.
    assert (line, rule) == (39, "YML002")
    assert "nested more than 40 levels deep" in message


def test_merged_keys_and_extensions(described):
    """Own keys win over merged ones, and earlier mappings over later ones (https://yaml.org/type/merge.html)."""
    extended = """\
x-slow: &slow {period: 100 ms, execution_time: 1 ms, offset: 3 ms}
x-core: &core {period: 50 ms, core: Core_0, deadline: 7 ms}
tasks:
  - {name: T, <<: [*slow, *core], deadline: 9 ms, x-owner: {team: brakes}}
"""
    (task,) = described(GOOD + extended).tasks
    milliseconds = 10**9
    assert (task.period, task.offset, task.deadline) == (100 * milliseconds, 3 * milliseconds, 9 * milliseconds)
    assert task.core == "Core_0"
    # A merged value is where it is written.
    assert task.location("period").line == 11


def test_a_mistake_in_a_merged_mapping_is_reported_once(told):
    tasks = "".join(f"  - {{name: T{n}, <<: *slow}}\n" for n in range(3))
    text = GOOD + "x-slow: &slow {period: 1 s, execution_time: 1 ms, prio: 3}\ntasks:\n" + tasks
    assert [(line, message) for line, _, _, message, _ in told(text)] == [(11, "unknown key 'prio'")]


def test_no_path_of_a_chain_is_empty(told):
    text = GOOD + "chains:\n  - {name: c, parallel: [[], [Timer]]}\n"
    assert told(text) == [(12, 26, "YML012", "parallel: expected at least 1 item, found 0", "")]


UNDEFINED = "requirements:\n  - {process: Nothing, response_time: 1 ms}\n"
UNDEFINED_NAME = ("APP001", "undefined process or runnable 'Nothing'")


@pytest.mark.parametrize(
    ("text", "findings"),
    [
        pytest.param(
            changed("middleware:\n", "middleware:\n  policy: RMS\n") + "note: hello\n" + UNDEFINED,
            [
                ("YML012", "policy: expected 'FixedPriorityPreemptive' or 'OSEK', found 'RMS'"),
                ("YML010", "unknown key 'note'"),
                UNDEFINED_NAME,
            ],
            id="an unknown section and a wrong word",
        ),
        pytest.param(
            GOOD
            + "taskz:\n  - {name: T, period: 1 s, execution_time: 1 ms}\n  - {name: U, period: 3}\n"
            + UNDEFINED.replace("Nothing", "T"),
            [("YML010", "unknown key 'taskz'"), ("YML012", "period: '3' has no unit; write a time such as '10 ms'")],
            id="what a misspelled section defines is defined",
        ),
        pytest.param(
            GOOD + "tasks:\n  - {name: T, how_often: 1 s, execution_time: 1 ms}\n" + UNDEFINED,
            [("YML010", "unknown key 'how_often'"), UNDEFINED_NAME],
            id="a key that is missing because it is misspelled",
        ),
        pytest.param(
            GOOD + "things: [{name: Nothing}]\n" + UNDEFINED,
            [("YML010", "unknown key 'things'")],
            id="an unknown list may define names",
        ),
        pytest.param(
            GOOD + "name: other\n" + UNDEFINED,
            [("YML003", "duplicate key 'name' (first defined on line 2)"), UNDEFINED_NAME],
            id="a duplicate key",
        ),
    ],
)
def test_what_is_wrong_besides_is_reported_but_not_its_consequences(tmp_path, text, findings):
    path = tmp_path / "app.yaml"
    path.write_text(text)
    with pytest.raises(ReadError) as caught:
        describe(path)
    assert [(finding.rule, finding.message) for finding in caught.value.findings] == findings
