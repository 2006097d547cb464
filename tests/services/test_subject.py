"""Whatever describes a system can be analyzed and simulated, with the same result."""

import pytest
import yaml
from support import ROOT

import amalthea_uros as amuros
from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.uros import described

YAML = ROOT / "samples" / "bodas-test-advanced.yaml"
MODEL = ROOT / "samples" / "executor.amxmi"

SUBJECTS = {
    "a path of a description": lambda: YAML,
    "a path as text": lambda: str(YAML),
    "the text of a description": YAML.read_text,
    "the content of a description": lambda: yaml.safe_load(YAML.read_text()),
    "a system": lambda: amuros.describe(YAML).system,
    "a built model": lambda: amuros.build(YAML).model,
}


@pytest.mark.parametrize("subject", SUBJECTS.values(), ids=SUBJECTS)
def test_the_same_system_gives_the_same_result(subject):
    # 12 us of the executor, 13 us for the message, 4 us of its own: S. R. Bappanadu 2022, section 6.1
    assert amuros.analyze(subject())["Control_Function"].response.worst == amuros.parse_time("29 us")
    assert amuros.simulate(subject(), "20 ms")["Control_Function"].response_time.max == amuros.parse_time("29 us")


@pytest.mark.parametrize("subject", [[MODEL], (str(MODEL),), amuros.load(MODEL)], ids=["list", "tuple", "model"])
def test_models(subject):
    assert amuros.analyze(subject).processes.names == ("Executor_Task", "Control_Function", "Message_Factor")


def test_changes_are_made_first():
    changed = amuros.analyze(YAML, changes=["Control_Function.period=10ms"])
    assert changed["Control_Function"].min_interarrival == amuros.parse_time("10 ms")


def test_findings_about_the_subject_are_findings_of_the_analysis():
    model = amuros.load(MODEL)
    model[amuros.am.Task, "Message_Factor"].stimuli = [amuros.am.CustomStimulus(name="elsewhere")]
    found = [finding.rule for finding in amuros.extract(model).findings]
    assert found
    assert set(found) <= {finding.rule for finding in amuros.analyze(model).findings}


def content(**changes):
    return yaml.safe_load(YAML.read_text()) | changes


WRONG_DESCRIPTIONS = {
    "a text with a wrong key": ("amuros: 1\nnme: x\n", ["<text>:2:1", "<text>:1:1"]),
    "a model as text": ("<?xml version='1.0'?>\n<am:Amalthea/>", ["<text>:1:1"]),
    "nothing": ({}, ["<content>"]),
    "a value of the wrong kind": (content(name=["x"]), ["name"]),
    "a key that is no text": ({3: "x"}, ["<content>"]),
    "what YAML cannot hold": (content(name={1, 2}), ["name"]),
    "an unknown name": (content(chains=[{"name": "c", "path": ["Executor_Task", "Nope"]}]), ["chains[0].path[1]"]),
}


@pytest.mark.parametrize(("subject", "places"), WRONG_DESCRIPTIONS.values(), ids=WRONG_DESCRIPTIONS)
def test_wrong_descriptions_are_findings_with_places(subject, places):
    with pytest.raises(amuros.ReadError) as raised:
        amuros.analyze(subject)
    assert {str(finding.location) for finding in raised.value.findings} == set(places)


def test_content_that_contains_itself_is_refused():
    endless = {}
    endless["endless"] = endless
    with pytest.raises(amuros.ReadError, match="nested more than"):
        amuros.analyze(endless)


def test_decimals_are_exact_as_in_a_file():
    hardware = {"platform": "single-core", "frequency": "1 MHz"}
    processes = [{"name": "T", "period": "1 ms", "execution_time": "10 us", "priority": 1}]
    description = {"amuros": 1, "name": "small", "hardware": hardware, "tasks": processes}
    assert amuros.analyze(description)["T"].response.worst == amuros.parse_time("10 us")


@pytest.mark.parametrize("subject", [None, 3, b"x", [3], [MODEL, None]], ids=repr)
@pytest.mark.parametrize("function", [amuros.analyze, lambda subject: amuros.simulate(subject, "1 ms")])
def test_anything_else_is_a_type_error_that_lists_what_is_accepted(function, subject):
    with pytest.raises(TypeError, match=r"the path of an app.yaml .* a Model, or a System such as taskset"):
        function(subject)


@pytest.mark.parametrize(
    ("duration", "message"),
    [
        (1.5, "the number 1.5 has no unit; write a text such as '1.5 ms', or a Duration"),
        (10**9, "write a text such as '1000000000 ps'"),
        (None, "expected a time such as '10 ms', not None"),
    ],
    ids=repr,
)
def test_wrong_durations(duration, message):
    with pytest.raises(amuros.InvalidArgumentError, match=f"the duration: .*{message}"):
        amuros.simulate(YAML, duration)


def test_tasks_are_no_system_yet():
    with pytest.raises(TypeError, match=r"taskset\(\) makes a System of tasks"):
        amuros.analyze([amuros.task("A", period="5 ms", wcet="1 ms")])


def test_no_paths_and_no_changes():
    with pytest.raises(amuros.InvalidArgumentError, match="no path given"):
        amuros.analyze([])
    with pytest.raises(TypeError, match="expected changes such as"):
        amuros.what_if(YAML, None)


def test_a_description_is_assembled_once(monkeypatch):
    assembled, assemble = [], described.assemble
    monkeypatch.setattr(described, "assemble", lambda *parts, **how: assembled.append(parts) or assemble(*parts, **how))
    analyze_files(YAML, with_missing=True)
    assert len(assembled) == 1
