"""0.9.4 -> 0.9.5, as far as the pairs of models do not show it."""

import pytest
from inline_models import written
from migration import migrated

#: The versions.
STEP = ("0.9.4", "0.9.5")


# Call graphs


def process(tag, content):
    return f"<swModel><{tag} name='P'><callGraph>{content}</callGraph></{tag}></swModel>"


def sequence(attributes, content, tag="graphEntries"):
    return f'<{tag} t="CallSequence" {attributes}>{content}</{tag}>'


def group(attributes, content):
    return f'<items t="Group" ordered="true" {attributes}>{content}</items>'


CALL = '<{} t="{}" runnable="R?type=Runnable">{}</{}>'


def old_call(content=""):
    return CALL.format("calls", "TaskRunnableCall", content, "calls")


def new_call(content=""):
    return CALL.format("items", "RunnableCall", content, "items")


@pytest.mark.parametrize("tag", ["tasks", "isrs"])
def test_call_graphs_of_processes(same, tag):
    given = (
        '<graphEntries t="ProbabilitySwitch"><entries probability="1.0">'
        + sequence('name=""', old_call(), "items")
        + "</entries></graphEntries>"
        + '<graphEntries t="ModeSwitch"><defaultEntry>'
        + sequence('name="s"', '<calls t="SetEvent"><counter offset="2"/></calls>', "items")
        + "</defaultEntry></graphEntries>"
        + sequence("", "")
    )
    result = (
        '<items t="ProbabilitySwitch"><entries probability="1.0">'
        + group('name="CallSequence"', new_call())
        + "</entries></items>"
        + '<items t="ModeSwitch"><defaultEntry>'
        + group('name="s"', '<items t="SetEvent"><counter offset="2"/></items>')
        + "</defaultEntry></items>"
        + group('name="CallSequence"', "")
    )
    same(process(tag, given), process(tag, result))


def stimuli(content):
    return f"<stimuliModel>{content}</stimuliModel>"


def clock(name, kind, attributes="", content=""):
    return f'<clocks t="{kind}" name="{name}" {attributes}>{content}</clocks>'


def scenario(clock, kind):
    inner = f'<scenario clock="{clock}?type={kind}"/>'
    return f'<stimuli t="VariableRateStimulus" name="V{clock}">{inner}</stimuli>'


# Snapshots of the development, damaged files, large files


@pytest.mark.parametrize(
    "content",
    [
        process("tasks", "<graphEntries/>" + sequence("", "<calls/>")),
        stimuli('<stimuli><scenario clock="_gone"><recurrence/></scenario></stimuli>'),
        stimuli(
            clock("c", "ClockSinusFunction", "", "<period/><shift/>") * 2 + clock("d", "ClockMultiplierList", "", "<entries/>")
        ),
        stimuli('<clocks t="ClockTriangleFunction" max="1" min="2"/>' + scenario("", "ClockTriangleFunction")),
    ],
)
def test_damaged_content_is_survived(tmp_path, content):
    migrated(written(tmp_path, "0.9.4", content), "0.9.5")
