"""What is written to a project and read again is the same system; what somebody changed in between is not covered by comments."""

import random
import re
from dataclasses import replace
from xml.etree import ElementTree

import pytest
from click.testing import CliRunner
from effort import IS_THOROUGH, every
from support import ROOT, SHARED

from amalthea_uros.cli.main import cli
from amalthea_uros.errors import AmurosError
from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.services.export import export
from amalthea_uros.services.simulate import simulate
from amalthea_uros.services.subject import open_system

SAMPLES = sorted((ROOT / "samples").glob("*.yaml"))
CONSTRUCTS = every(4, sorted(SHARED.glob("vectors/constructs*/*.amxmi")))
#: A burst without a number of activations, and a task with two allocations.
UNCLEAR = [*SHARED.glob("vectors/am2inc/31_burst_count0_ok.amxmi"), *SHARED.glob("vectors/am2inc/40_task_twice.amxmi")]


@pytest.mark.parametrize("path", [*SAMPLES, *CONSTRUCTS], ids=lambda path: path.stem)
def test_a_project_means_the_same_as_what_it_was_made_of(path, tmp_path):
    first, again = tmp_path / "first.iprx", tmp_path / "again.iprx"
    text = export(path, first).text
    opened = open_system(first)
    assert opened.system == open_system(path).system
    assert [finding.rule for finding in opened.findings] == []
    # A model spells units in its own way, such as 0 ms; a project that is exported again has those of its values.
    assert path.suffix == ".amxmi" or export(first, again).text == text


@pytest.mark.parametrize("path", UNCLEAR, ids=lambda path: path.stem)
def test_what_a_project_can_only_say_clearly_stays_unclear(path, tmp_path):
    export(path, tmp_path / "project.iprx")
    assert open_system(tmp_path / "project.iprx").system == open_system(path).system


@pytest.mark.parametrize("sample", every(5, SAMPLES), ids=lambda path: path.stem)
def test_the_analysis_of_a_project_has_the_results_of_the_description(sample, tmp_path):
    export(sample, tmp_path / "project.iprx")
    given, read = (analyze_files(path).analysis for path in (sample, tmp_path / "project.iprx"))
    # Findings have places of the file, and some are about defaults that only a description can leave out.
    assert {each.message for each in read.findings} <= {each.message for each in given.findings}
    assert replace(read, findings=()) == replace(given, findings=())


@pytest.mark.parametrize("sample", every(5, SAMPLES), ids=lambda path: path.stem)
def test_the_simulation_of_a_project_has_the_events_and_figures_of_the_description(sample, tmp_path):
    export(sample, tmp_path / "project.iprx")
    given, read = (simulate(path, "200 ms", seed=3, trace=True) for path in (sample, tmp_path / "project.iprx"))
    assert replace(read, findings=(), trace=None, origin=None) == replace(given, findings=(), trace=None, origin=None)
    events, others = given.trace.to_dict(), read.trace.to_dict()
    assert {name for name in events if events[name].tolist() != others[name].tolist()} == set()


def test_a_project_becomes_an_amalthea_model(tmp_path):
    sample = ROOT / "samples" / "bodas-test-advanced.yaml"
    export(sample, tmp_path / "project.iprx")
    export(tmp_path / "project.iprx", tmp_path / "model.amxmi")
    assert open_system(tmp_path / "model.amxmi").system == open_system(sample).system


#: Two tasks on a core at 1 MHz, 3 and 2 ms long, and a chain through the label that both access.
DESCRIPTION = """\
amuros: 1
name: small
hardware: {platform: generic, cores: [{name: Core, frequency: 1 MHz}]}
tasks:
  - {name: First, period: 10 ms, priority: 2, execution_time: {min: 1 ms, max: 3 ms}, writes: [speed]}
  - {name: Second, period: 20 ms, priority: 1, execution_time: 2 ms, reads: [speed]}
requirements:
  - {process: Second, response_time: 8 ms}
"""


@pytest.fixture
def project(tmp_path):
    """The project of the description, as a file to change."""
    (tmp_path / "app.yaml").write_text(DESCRIPTION)
    path = tmp_path / "project.iprx"
    export(tmp_path / "app.yaml", path)
    return path


def response_of(path, name):
    response = next(each.response for each in analyze_files(path).analysis.processes if each.name == name)
    return None if response is None else response.worst


def test_times_that_somebody_changed_are_those_of_the_project(project):
    # Second waits for First, which takes 3 ms, and takes 2 ms itself.
    assert response_of(project, "Second") == 5 * 10**9
    project.write_text(project.read_text().replace('value="3000"', 'value="4000"'))
    assert response_of(project, "Second") == 6 * 10**9


def test_a_limit_that_somebody_changed_is_that_of_the_project(project):
    project.write_text(project.read_text().replace('<upperLimit value="8" unit="ms"/>', '<upperLimit value="4" unit="ms"/>'))
    limits = open_system(project).system.constraints.requirements
    assert [each.limit.value for each in limits] == [4 * 10**9]


def test_hardware_that_somebody_changed_is_that_of_the_project(project):
    project.write_text(project.read_text().replace('<frequency value="1"/>', '<frequency value="2"/>'))
    opened = open_system(project)
    assert [clock.frequency for clock in opened.system.hardware.clocks] == [2_000_000]
    assert [finding.rule for finding in opened.findings] == ["INC008"]
    assert response_of(project, "Second") == 5 * 10**9 // 2


def test_a_process_that_is_not_understood_makes_response_times_unknown(project):
    text = project.read_text()
    other = '<systems xsi:type="model:ThreadXSystem" intrinsicId="_x" name="Other"/>'
    project.write_text(text.replace("<systems ", f"{other}\n    <systems ", 1))
    assert response_of(project, "Second") is None
    assert "INC006" in [finding.rule for finding in open_system(project).findings]


@pytest.mark.parametrize(
    ("before", "inserted"),
    [
        ("<cores ", '<hypervisor xsi:type="model:HyperVisorConfig" intrinsicId="_x" name="H"/>'),
        (
            "<cores ",
            '<peripherals xsi:type="p:Timer" xmlns:p="http://inchron.com/realtime/root/3.5.0/model/peripheral" name="P"/>',
        ),
    ],
    ids=["hypervisor", "peripheral"],
)
def test_what_may_take_time_of_a_processor_makes_response_times_unknown(project, before, inserted):
    project.write_text(project.read_text().replace(before, f"{inserted}{before}", 1))
    assert response_of(project, "First") is None
    assert response_of(project, "Second") is None


@pytest.mark.parametrize("feature", ['server="true"', 'maxThreads="2"', 'idleTask="true"'])
def test_a_process_with_more_than_its_call_graph_has_no_known_demand(project, feature):
    project.write_text(project.read_text().replace(' name="First"', f' name="First" {feature}', 1))
    assert response_of(project, "First") is None
    assert response_of(project, "Second") is None


def with_other_characters(text, chance):
    place, length = chance.randrange(len(text)), chance.choice([0, 1, 3, 30])
    inserted = chance.choice(["", "x", '"', "<", "0", "-", "99999999999", " ", text[place : place + 40]])
    return text[:place] + inserted + text[place + length :]


def with_other_elements(text, chance):
    """The text with an element that is missing, elsewhere or twice, or with a value that belongs to another one."""
    prefixes = re.findall(r'xmlns:(\w+)="([^"]+)"', text)
    for prefix, uri in prefixes:
        ElementTree.register_namespace(prefix, uri)
    root = ElementTree.fromstring(text)
    above = {part: whole for whole in root[0].iter() for part in whole}
    one, other = chance.sample(list(above), 2)
    match chance.randrange(4):
        case 0:
            above[one].remove(one)
        case 1:
            above[one].append(one)
        case 2:
            one.append(ElementTree.Element(other.tag, other.attrib))
        case _:
            names, values = sorted(one.attrib), [*other.attrib.values(), "", "-1", "NaN", "9223372036854775807"]
            one.attrib.update({chance.choice(names): chance.choice(values)} if names else {})
    result = ElementTree.tostring(root, encoding="unicode")
    # Prefixes that only values of xsi:type have are not declared by the writer of XML.
    missing = [f'xmlns:{prefix}="{uri}"' for prefix, uri in prefixes if f"xmlns:{prefix}=" not in result]
    return result.replace("<root:Root", " ".join(["<root:Root", *missing]), 1)


#: Done with damaged projects in turn, with another project and a folder to write to.
COMMANDS = [
    "analyze {project}",
    "simulate {project} --duration 10ms",
    "check {project}",
    "info {project}",
    "diff {other} {project}",
    "report {project} -o {folder}/report.html -o {folder}/report.md",
    "export {project} -o {folder}/model.amxmi",
    "export {project} -o {folder}/again.iprx",
]


@pytest.mark.parametrize("damaged", [with_other_characters, with_other_elements])
def test_no_exception_escapes_for_damaged_projects(project, damaged, tmp_path):
    chance, text, runner, ends = random.Random(1), project.read_text(), CliRunner(), set()
    (tmp_path / "other.iprx").write_text(text)
    for number in range(500 if IS_THOROUGH else 24):
        project.write_text(damaged(text, chance))
        command = COMMANDS[number % len(COMMANDS)].format(project=project, other=tmp_path / "other.iprx", folder=tmp_path)
        outcome = runner.invoke(cli, command.split())
        assert isinstance(outcome.exception, AmurosError | SystemExit | None), (command, outcome.exc_info)
        ends.add("refused" if isinstance(outcome.exception, AmurosError) else outcome.exit_code)
    # Some are understood in spite of the damage, so that more than the reader of files is tried.
    assert {0, "refused"} <= ends


@pytest.mark.parametrize(
    ("ends", "limit", "more", "verdicts"),
    [
        # First takes 1 to 3 ms and starts at once, Second waits for it and ends within 5 ms.
        ("Activate Terminate", 5, "", ["met", "met"]),
        ("Activate Terminate", 4, "", ["met", "missed"]),
        ("Activate Start", 3, "", ["met", "met"]),
        ("Activate Start", 2, "", ["met", "missed"]),
        ("Start Terminate", 9, "", ["unknown", "unknown"]),
        ("Activate Terminate", 5, '<interval><lowerLimit value="1" unit="ms"/>', ["unknown", "unknown"]),
        ("Activate Terminate", 5, ' trigger="{start}"', ["unknown", "unknown"]),
    ],
)
def test_limits_between_events_of_a_process_are_understood(project, ends, limit, more, verdicts):
    text = project.read_text()
    events = [
        dict(re.findall(r'<traceEvents intrinsicId="(\S+)" name="(\w+)"', part)) for part in text.split("<schedulables ")[-2:]
    ]
    inserted = ""
    for number, names in enumerate(events):
        start, end = ({name: identity for identity, name in names.items()}[each] for each in ends.split())
        inside = more if more.startswith("<") else "<interval><lowerLimit/>"
        inserted += (
            f'<requirements xsi:type="requirement:EventTimingRequirement" intrinsicId="_q{number}" name="own{number}" start="{start}" '
            f'end="{end}"{"" if more.startswith("<") else more.format(start=start)}>{inside}'
            f'<upperLimit value="{limit}" unit="ms"/></interval></requirements>'
        )
    project.write_text(text.replace("<requirements ", f"{inserted}<requirements ", 1))
    found = {each.name: str(each.verdict) for each in analyze_files(project).analysis.requirements}
    assert [found["own0"], found["own1"]] == verdicts


@pytest.mark.parametrize(
    ("kind", "content"),
    [
        ("NetSlackTimeRequirement", 'process="{First}"><interval/><deadlineDelta/>'),
        ("LoadRequirement", 'limit="0.99">'),
        ("RtosFailureRequirement", 'enabledRtosFailures="IsrLost">'),
        ("CallNestingRequirement", 'limit="99">'),
        ("ResponseTimeRequirement", 'process="{First}" successIfOutsideOfInterval="true"><interval/>'),
    ],
)
@pytest.mark.parametrize("group", ["", '<requirements xsi:type="requirement:GroupOfRequirements" intrinsicId="_g" name="g">'])
def test_nothing_is_known_of_a_requirement_that_is_not_understood(project, kind, content, group):
    text = project.read_text()
    first = re.search(r'<schedulables xsi:type="model:Process" intrinsicId="(\S+)" name="First"', text)[1]
    own = (
        f'<requirements xsi:type="requirement:{kind}" intrinsicId="_q" name="own" {content.format(First=first)}</requirements>'
    )
    inserted = group + own + ("</requirements>" if group else "")
    project.write_text(text.replace("<requirements ", f"{inserted}<requirements ", 1))
    analyzed = analyze_files(project)
    assert {each.name: str(each.verdict) for each in analyzed.analysis.requirements} == {
        "own": "unknown",
        "Second_response_time": "met",
    }
    assert [each.object for each in analyzed.findings if each.rule == "INC006"] == ["own"]
