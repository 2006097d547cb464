"""2.1.0 -> 2.0.0."""

import pytest
from inline_models import InlineModels

from amalthea_uros.xmi.migrate.notes import NoteKind


@pytest.fixture
def models(tmp_path):
    return InlineModels(tmp_path)


def condition(content):
    return f'<swModel><runnables name="R"><executionCondition>{content}</executionCondition></runnables></swModel>'


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ('maxValue="3"', 'maxValue="3"'),
        ('maxValue="1"', 'maxValue="1"'),
        ("", 'maxValue="1"'),
    ],
)
def test_a_limit_that_is_not_stated_is_1(models, before, after):
    content = '<osModel><semaphores name="S" {}/></osModel>'
    assert models.migrate("2.1.0", "2.0.0", content.format(before)) == models.read("2.0.0", content.format(after))
    assert len(models.messages(NoteKind.DEFAULTED)) == (before == "")


@pytest.mark.parametrize("tag", ["tasks", "isrs", "runnables"])
def test_local_mode_labels_are_an_error(models, tag):
    before = f"""<swModel>
    <modes xsi:type="am:NumericMode" name="m"/><modeLabels name="G" mode="m?type=NumericMode"/>
    <{tag} name="X"><localLabels name="L" mode="m?type=NumericMode"/><activityGraph>
    <items xsi:type="am:ModeLabelAssignment" globalLabel="G?type=ModeLabel"/>
    <items xsi:type="am:LocalModeLabelAssignment"><valueSource xsi:type="am:IntegerConst" value="1"/></items>
    <items xsi:type="am:RunnableCall"><context><valueSource xsi:type="am:IntegerConst" value="1"/></context></items>
    </activityGraph></{tag}></swModel>
    <eventModel><events xsi:type="am:ModeLabelEvent" name="E" entity="G?type=ModeLabel"/></eventModel>"""
    after = f"""<swModel>
    <modes xsi:type="am:NumericMode" name="m"/><modeLabels name="G" mode="m?type=NumericMode"/>
    <{tag} name="X"><activityGraph><items xsi:type="am:RunnableCall"/></activityGraph></{tag}></swModel><eventModel/>"""
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
        '<entries xsi:type="am:LocalModeCondition" relation="EQUAL"/>',
        '<entries xsi:type="am:ModeValueCondition" relation="LESS_THAN_OR_EQUAL" value="1"/>',
        '<entries xsi:type="am:ModeLabelCondition" relation="GREATER_THAN_OR_EQUAL"/>',
        '<entries xsi:type="am:ChannelFillCondition" relation="EQUAL" fillLevel="1"/>',
        '<entries xsi:type="am:ConditionConjunction"><entries xsi:type="am:LocalModeCondition"/></entries>',
    ],
)
def test_new_conditions_are_an_error(models, content):
    models.migrate("2.1.0", "2.0.0", condition(content))
    assert len(models.messages(NoteKind.LOST)) == 1


@pytest.mark.parametrize(
    "content",
    [
        '<entries xsi:type="am:ModeValueCondition" relation="LESS_THAN" value="1"/>',
        '<entries xsi:type="am:ChannelFillCondition" fillLevel="1"/>',
    ],
)
def test_older_conditions_stay(models, content):
    assert models.migrate("2.1.0", "2.0.0", condition(content)) == models.read("2.0.0", condition(content))
    assert models.notes == []
