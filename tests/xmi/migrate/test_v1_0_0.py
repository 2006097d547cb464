"""Measurements, and limits of numbers that became tighter in 1.2.0 and 2.1.0."""

import pytest
from migration import migrated

from amalthea_uros.xmi.tree.notes import NoteKind

PROPERTY = '<customProperties key="{}"><value t="StringObject" value="{}"/></customProperties>'


def measured(properties, measurements):
    return f'<swModel><tasks name="T 1">{properties}</tasks></swModel>{measurements}'


MEASUREMENT = f"""<measurementModel><measurements t="TaskMeasurement" task="T+1?type=Task">{PROPERTY.format("tool", "X")}
    <runtimes value="5" unit="us"/><runtimes value="7" unit="us"/>
    <runtimeDeviation t="TimeBoundaries"><lowerBound value="1" unit="us"/><upperBound value="9" unit="us"/></runtimeDeviation>
  </measurements></measurementModel>"""


def test_comments_on_a_measurement_stay_with_what_was_measured(models):
    content = measured("", MEASUREMENT.replace("<measurements ", "<!-- on the bench --><measurements "))
    roots = migrated(models.files("before", "0.9.9", content), "1.0.0")[0].roots
    assert [task.comments for task in roots[0].find("swModel", "tasks")] == [["<!-- on the bench -->"]]


@pytest.mark.parametrize("text", ["-1", "many", "", "1", "99"])
def test_other_numbers_stay(models, text):
    content = f'<stimuliModel><stimuli t="PeriodicBurstStimulus" name="B" occurrenceCount="{text}"/></stimuliModel>'
    assert models.migrate("1.1.0", "1.2.0", content) == models.read("1.2.0", content)
    assert len(models.messages(NoteKind.TO_CHECK)) == (text == "-1")
