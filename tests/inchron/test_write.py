"""The text of projects: what it looks like, what is refused, and what is read of it."""

from pathlib import Path

import pytest

from amalthea_uros.errors import ReadError, WriteError
from amalthea_uros.inchron.ids import intrinsic_ids
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron.read import parse_project
from amalthea_uros.inchron.write import project_text

#: As the importer of INCHRON forms them for a project with these names (model 40_task_twice of the shared vectors).
ID_OF_T1, ID_OF_ACTIVATE, ID_OF_CALL = "_Idz5qgneVXCEBn2MgI4L+g", "_dOpJdQsaXgyeyIZaG4gVxQ", "_GZpybw3HVV2uziu7y1uORg"


def scheduler(name, *below):
    return ProjectObject("Scheduler", name=name, schedulables=below)


def project(*processes):
    """A project with the given processes below Sch0 of OS."""
    config = ProjectObject(
        "RtosConfig", name="RtosConfig", schedulables=[scheduler("IsrScheduler", scheduler("Sch0", *processes))]
    )
    return ProjectObject("Model", name="Sys", systems=[ProjectObject("GenericSystem", name="OS", rtosConfig=config)])


def process(name, **features):
    return ProjectObject("Process", name=name, **features)


def test_ids_follow_from_names_as_those_of_the_importer_do():
    function = ProjectObject("Function", name="R1")
    call = ProjectObject("FunctionCall", name="Call_R1_0", function=function)
    graph = ProjectObject("CallGraph", graphEntries=[ProjectObject("CallSequence", name="CallSequence_0", calls=[call])])
    event = ProjectObject("TraceEvent", name="Activate", type="Activate")
    task = process("T1", callGraph=graph, traceEvents=[event])
    ids = intrinsic_ids(project(task))
    assert [ids[task], ids[event], ids[call]] == [ID_OF_T1, ID_OF_ACTIVATE, ID_OF_CALL]


def test_objects_with_equal_names_have_different_ids():
    ids = intrinsic_ids(project(process("T"), process("T"), process("T")))
    assert len(set(ids.values())) == len(ids)


def test_parts_that_every_object_has_are_made_and_defaults_left_out():
    text = project_text(project(process("T", priority=7, activationLimit=1)))
    assert '<schedulables xsi:type="model:Process"' in text
    assert 'name="T" priority="7">' in text
    assert "<stackLimit/>" in text
    assert text.startswith('<?xml version="1.0" encoding="UTF-8" standalone="no" ?>\n<root:Root xmi:version="2.0"')
    assert "xmlns:memory" not in text


def test_references_that_mirror_each_other_are_written_at_both_ends():
    clock = ProjectObject("Clock", name="C")
    model = ProjectObject("Model", name="M", clocks=[clock], cpus=[ProjectObject("Cpu", name="P", clock=clock)])
    identity = intrinsic_ids(model)
    cpu = model["cpus"][0]
    text = project_text(model)
    assert f'users="{identity[cpu]}"' in text
    assert f'clock="{identity[clock]}"' in text


@pytest.mark.parametrize(
    ("item", "reason"),
    [
        (ProjectObject("Cpu", name="P"), "clock is missing"),
        (ProjectObject("Cpu", name="P", clock=ProjectObject("Mode", name="m")), "clock cannot be a Mode"),
    ],
)
def test_what_the_metamodel_does_not_allow_is_not_written(item, reason):
    with pytest.raises(WriteError) as caught:
        project_text(ProjectObject("Model", name="M", cpus=[item]))
    assert [finding.rule for finding in caught.value.findings] == ["INC002"]
    assert reason in caught.value.findings[0].message


def test_a_number_that_does_not_fit_is_not_written():
    with pytest.raises(WriteError, match="priority cannot be 2147483648"):
        project_text(project(process("T", priority=2**31)))


def test_what_is_written_is_read_and_written_again_alike():
    text = project_text(project(process("<&\"'\n", priority=-1), process("ü", isr=True)))
    assert project_text(parse_project(Path("p.iprx"), text).model) == text


def edited(before, after):
    return project_text(project(process("T", priority=7))).replace(before, after)


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ('priority="7"', 'priority="high"', "invalid literal"),
        ('priority="7"', f'priority="{10**30}"', "does not fit into 64 bits"),
        ('priority="7"', 'isr="yes"', "neither true nor false"),
        ('priority="7"', 'cpuCores="_nobody"', "no object has that id"),
        ("root:Root", "root:Other", "not an INCHRON project"),
    ],
)
def test_what_is_wrong_is_refused_with_its_place(before, after, message):
    with pytest.raises(ReadError) as caught:
        parse_project(Path("p.iprx"), edited(before, after))
    finding = caught.value.findings[0]
    assert finding.rule == "INC001"
    assert message in finding.message
    assert finding.location.line > 1 or "root" in before


@pytest.mark.parametrize("value", ["inf", "nan", "1e400"])
def test_what_is_not_a_finite_number_is_refused(value):
    frequency = ProjectObject("Frequency", value=1.5, unit="MHz")
    text = project_text(ProjectObject("Model", name="M", clocks=[ProjectObject("Clock", name="C", frequency=frequency)]))
    with pytest.raises(ReadError, match="not a finite number"):
        parse_project(Path("p.iprx"), text.replace('value="1.5"', f'value="{value}"'))


def test_what_the_metamodel_does_not_know_is_left_out_with_a_finding():
    text = edited('priority="7"', 'priority="7" color="red"').replace("<stackLimit/>", "<stackLimit/><shape><inner/></shape>")
    read = parse_project(Path("p.iprx"), text)
    assert [finding.rule for finding in read.findings] == ["INC006", "INC006"]
    assert "Process.color" in read.findings[0].message
    assert project_text(read.model) == project_text(project(process("T", priority=7)))


@pytest.mark.parametrize("text", ["", "no XML", "<!DOCTYPE a><a/>", "<a>", "<a/>", "<a>" * 300])
def test_other_texts_are_refused(text):
    with pytest.raises(ReadError):
        parse_project(Path("p.iprx"), text)
