"""0.9.3 -> 0.9.4, as far as the pairs of models do not show it."""

import pytest
from inline_models import of_kind, text_property, written
from migration import meaning, migrated, opened

from amalthea_uros.xmi.migrate.chain import migrate
from amalthea_uros.xmi.tree.notes import NoteKind, StepNotes

#: The versions.
STEP = ("0.9.3", "0.9.4")


# Mode labels

MODES = (
    '<modes {}name="m 1"><literals name="on x"/><literals name="off"/></modes><modes {}name="n"><literals name="on x"/></modes>'
)
OLD_MODES = MODES.format("", "")
NEW_MODES = MODES.format('t="EnumMode" ', 't="EnumMode" ')


def software(content, old=True):
    return f"<swModel>{OLD_MODES if old else NEW_MODES}{content}</swModel>"


def test_a_label_without_initial_value_has_the_mode_that_an_older_version_stated(tmp_path):
    paths = written(tmp_path, "0.9.3", software('<modeLabels name="a"/>'))
    models, notes = opened(*paths), StepNotes()
    (label,), mode = models.parts("swModel", "modeLabels"), models.parts("swModel", "modes")[1]
    models.set_aside[label, "mode"] = [mode]
    migrate(models, "0.9.4", notes)
    assert label.references == {"mode": [mode]}
    assert not models.set_aside
    assert not of_kind(notes.all, NoteKind.LOST)


# Conditions


def test_mode_switches_of_tasks_and_interrupts(same):
    def model(process, condition, old):
        switch = f'<graphEntries t="ModeSwitch"><entries name="e"><condition>{condition}</condition></entries></graphEntries>'
        labels = '<modeLabels name="l" {}/>'
        stated = 'initialValue="m+1/off?type=ModeLiteral"' if old else 'mode="m+1?type=EnumMode" initialValue="off"'
        return software(f"{labels.format(stated)}<{process} name='P'><callGraph>{switch}</callGraph></{process}>", old)

    given = '<entries t="ModeValue" valueProvider="l?type=ModeLabel" value="m+1/off?type=ModeLiteral"/>'
    result = '<entries t="ModeCondition" label="l?type=ModeLabel" value="off" relation="EQUAL"/>'
    for process in ("tasks", "isrs"):
        same(model(process, given, old=True), model(process, result, old=False))


def stimulus(content):
    labels = "".join(f'<modeLabels name="{name}" displayName="d"/>' for name in "abc")
    return f'<swModel>{labels}</swModel><stimuliModel><stimuli t="SingleStimulus" name="S">{content}</stimuli></stimuliModel>'


def old_list(tag, *entries):
    return f"<{tag}ModeValueList>{''.join(entries)}</{tag}ModeValueList>"


def value(label, literal, single=True):
    kind = ' t="ModeValue"' if single else ""
    return f'<entries{kind} valueProvider="{label}?type=ModeLabel" value="x/{literal}?type=ModeLiteral"/>'


def all_of(*entries, kind="ModeValueConjunction"):
    return f'<entries t="{kind}">{"".join(entries)}</entries>'


def condition(label, literal, relation="EQUAL", single=True):
    kind = ' t="ModeCondition"' if single else ""
    return f'<entries{kind} label="{label}?type=ModeLabel" value="{literal}" relation="{relation}"/>'


def conditions(*entries):
    return f"<executionCondition>{''.join(entries)}</executionCondition>"


@pytest.fixture
def becomes(tmp_path):
    """Assert what the lists of a stimulus become, apart from the modes of the labels."""

    def check(given, expected):
        models, notes = migrated(written(tmp_path, "0.9.3", stimulus(given)), "0.9.4")
        for label in models.parts("swModel", "modeLabels"):
            label.drop("mode")
        assert meaning(models) == meaning(opened(*written(tmp_path, "0.9.4", stimulus(expected))))
        return notes

    return check


def test_what_disables_alone_is_excluded(becomes):
    becomes(old_list("disabling", value("a", "1")), conditions(condition("a", "1", "NOT_EQUAL")))
    becomes(
        old_list("disabling", value("a", "1"), value("b", "2")),
        conditions(
            all_of(
                condition("a", "1", "NOT_EQUAL", False),
                condition("b", "2", "NOT_EQUAL", False),
                kind="ModeConditionConjunction",
            )
        ),
    )


def test_a_conjunction_that_disables_is_kept_as_text(becomes):
    given = old_list("disabling", value("c", "3"), all_of(value("a", "1", False), value("b", "2", False)))
    text = "c == 3 OR (a == 1 AND b == 2)"
    notes = becomes(given, text_property("disablingModeValueList", text))
    assert len(of_kind(notes, NoteKind.KEPT)) == 1


# Snapshots of the development, damaged files, large files


def test_what_is_new_already_is_left_alone(tmp_path):
    def model(alias):
        types = f'<typeDefinitions t="BaseTypeDefinition" name="t">{alias}</typeDefinitions>'
        label = '<modeLabels name="a" mode="m+1?type=EnumMode" initialValue="off"/>'
        lists = '<setModeValueList><entries label="a?type=ModeLabel" value="off"/></setModeValueList>'
        new = lists + conditions(condition("a", "off", "NOT_EQUAL"), condition("a", "off"))
        return software(types + label, old=False) + f'<stimuliModel><stimuli name="S">{new}</stimuli></stimuliModel>'

    result, notes = migrated(written(tmp_path, "0.9.4", model('<dataMapping platformName="C"/>')), "0.9.4")
    expected, _ = migrated(written(tmp_path, "0.9.4", model('<aliases target="C"/>')), "0.9.4")
    assert meaning(result) == meaning(expected)
    assert not of_kind(notes, NoteKind.CONVERTED)


@pytest.mark.parametrize(
    "content",
    [
        software('<modeLabels name="a" initialValue="on"/><modeLabels name="b" initialValue="_none"/>'),
        software('<modeLabels name="a" initialValue="m+1?type=Mode"/>'),
        software('<runnables><deadline/><deadline/><runnableItems t="ModeLabelAccess"/></runnables>'),
        stimulus(old_list("disabling", "<entries/>", all_of(), all_of("<entries/>")) + old_list("enabling", "<entries/>")),
        stimulus("<setModeValueList><entries/></setModeValueList>" + old_list("enabling") * 2 + old_list("disabling") * 2),
        stimulus(old_list("disabling", '<entries t="ModeValue" valueProvider="gone?type=ModeLabel"/>')),
        "<swModel><typeDefinitions><dataMapping/></typeDefinitions></swModel>",
    ],
)
def test_damaged_content_is_survived(tmp_path, content):
    migrated(written(tmp_path, "0.9.3", content), "0.9.4")
