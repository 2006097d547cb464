"""2.1.0 -> 2.0.0."""

import pytest

from amalthea_uros.xmi.tree.notes import NoteKind


def condition(content):
    return f'<swModel><runnables name="R"><executionCondition>{content}</executionCondition></runnables></swModel>'


@pytest.mark.parametrize("tag", ["tasks", "isrs", "runnables"])
def test_local_mode_labels_are_an_error(models, tag):
    before = f"""<swModel>
    <modes t="NumericMode" name="m"/><modeLabels name="G" mode="m?type=NumericMode"/>
    <{tag} name="X"><localLabels name="L" mode="m?type=NumericMode"/><activityGraph>
    <items t="ModeLabelAssignment" globalLabel="G?type=ModeLabel"/>
    <items t="LocalModeLabelAssignment"><valueSource t="IntegerConst" value="1"/></items>
    <items t="RunnableCall"><context><valueSource t="IntegerConst" value="1"/></context></items>
    </activityGraph></{tag}></swModel>
    <eventModel><events t="ModeLabelEvent" name="E" entity="G?type=ModeLabel"/></eventModel>"""
    after = f"""<swModel>
    <modes t="NumericMode" name="m"/><modeLabels name="G" mode="m?type=NumericMode"/>
    <{tag} name="X"><activityGraph><items t="RunnableCall"/></activityGraph></{tag}></swModel><eventModel/>"""
    assert models.migrate("2.1.0", "2.0.0", before) == models.read("2.0.0", after)
    assert sorted(message.partition(":")[0] for message in models.messages(NoteKind.LOST)) == [
        "assignment between a mode label and a local one",
        "assignment to a local mode label",
        "context of a runnable call",
        "event of a mode label",
        "local mode label",
    ]


@pytest.mark.parametrize(
    "content",
    [
        '<entries t="LocalModeCondition" relation="EQUAL"/>',
        '<entries t="ModeValueCondition" relation="LESS_THAN_OR_EQUAL" value="1"/>',
        '<entries t="ModeLabelCondition" relation="GREATER_THAN_OR_EQUAL"/>',
        '<entries t="ChannelFillCondition" relation="EQUAL" fillLevel="1"/>',
        '<entries t="ConditionConjunction"><entries t="LocalModeCondition"/></entries>',
    ],
)
def test_new_conditions_are_an_error(models, content):
    models.migrate("2.1.0", "2.0.0", condition(content))
    assert len(models.messages(NoteKind.LOST)) == 1
