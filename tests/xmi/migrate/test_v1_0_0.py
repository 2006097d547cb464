"""Measurements, and limits of numbers that became tighter in 1.2.0 and 2.1.0."""

import pytest
from inline_models import InlineModels
from migration import migrated

from amalthea_uros.xmi.migrate.notes import NoteKind

PROPERTY = '<customProperties key="{}"><value t="StringObject" value="{}"/></customProperties>'


@pytest.fixture
def models(tmp_path):
    return InlineModels(tmp_path)


def measured(properties, measurements):
    return f'<swModel><tasks name="T 1">{properties}</tasks></swModel>{measurements}'


MEASUREMENT = f"""<measurementModel><measurements t="TaskMeasurement" task="T+1?type=Task">{PROPERTY.format("tool", "X")}
    <runtimes value="5" unit="us"/><runtimes value="7" unit="us"/>
    <runtimeDeviation t="TimeBoundaries"><lowerBound value="1" unit="us"/><upperBound value="9" unit="us"/></runtimeDeviation>
  </measurements></measurementModel>"""


def test_custom_properties_of_a_measurement_stay_with_what_was_measured(models):
    own = PROPERTY.format("tool", "own")
    found = models.migrate("0.9.9", "1.0.0", measured(own, MEASUREMENT))
    assert found == models.read("1.0.0", measured(own + PROPERTY.format("tool 2", "X"), ""))
    [lost] = [note for note in models.notes if note.kind == NoteKind.LOST]
    assert lost.detail == "of 'T 1': 5 us, 7 us, TimeBoundaries lowerBound 1 us upperBound 9 us"


def test_comments_on_a_measurement_stay_with_what_was_measured(models):
    content = measured("", MEASUREMENT.replace("<measurements ", "<!-- on the bench --><measurements "))
    roots = migrated(models.files("before", "0.9.9", content), "1.0.0")[0].roots
    assert [task.comments for task in roots[0].find("swModel", "tasks")] == [["<!-- on the bench -->"]]


def test_measurements_of_nothing_are_lost_with_a_note(models):
    content = """<measurementModel><measurements t="TaskMeasurement"/>
      <measurements t="RunnableMeasurement" runnable="X?type=Runnable"/></measurementModel>"""
    assert models.migrate("1.0.0", "1.1.0", measured("", content)) == models.read("1.1.0", measured("", ""))
    assert len(models.messages(NoteKind.LOST)) == 2


def test_only_events_of_processes_lose_the_deadline(models):
    text = '<eventModel><events t="ProcessEvent" name="e"{}/><events t="ProcessEvent" name="f"{}/></eventModel>'
    before = text.format(' eventType="deadline"', ' eventType="start"')
    assert models.migrate("0.9.9", "1.0.0", before) == models.read("1.0.0", text.format("", ' eventType="start"'))
    assert len(models.messages(NoteKind.LOST)) == 1


def test_no_occurrences_become_one(models):
    text = """<stimuliModel><stimuli t="PeriodicBurstStimulus" name="B" {0}/>
      <stimuli t="PeriodicBurstStimulus" name="D"/><stimuli t="PeriodicStimulus" name="P"/>
      <stimuli t="ArrivalCurveStimulus" name="A"><entries {1}/><entries numberOfOccurrences="3"/></stimuli></stimuliModel>"""
    before = text.format('occurrenceCount="0"', 'numberOfOccurrences="0"')
    after = text.format('occurrenceCount="1"', 'numberOfOccurrences="1"')
    assert models.migrate("1.1.0", "1.2.0", before) == models.read("1.2.0", after)
    assert len(models.messages(NoteKind.CONVERTED)) == 2
    assert models.messages(NoteKind.TO_CHECK) == ["occurrenceCount is not set: the default was 0 and is now 1"]


@pytest.mark.parametrize("text", ["-1", "many", "", "1", "99"])
def test_other_numbers_stay(models, text):
    content = f'<stimuliModel><stimuli t="PeriodicBurstStimulus" name="B" occurrenceCount="{text}"/></stimuliModel>'
    assert models.migrate("1.1.0", "1.2.0", content) == models.read("1.2.0", content)
    assert len(models.messages(NoteKind.TO_CHECK)) == (text == "-1")


def test_what_2_1_0_does_not_allow_is_to_be_checked(models):
    content = """<swModel><runnables name="R"><executionCondition>
        <entries t="ChannelFillCondition" fillLevel="3"/></executionCondition></runnables></swModel>
      <osModel><semaphores name="S" initialValue="-1" maxValue="-1"/></osModel>
      <mappingModel><memoryMapping/></mappingModel>"""
    assert models.migrate("2.0.0", "2.1.0", content) == models.read("2.1.0", content)
    assert len(models.messages(NoteKind.TO_CHECK)) == 4
