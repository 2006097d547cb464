"""What the published conversions lose, and a migration beyond them does not."""

import itea
import pytest
from inline_models import written
from migration import migrated

from amalthea_uros.xmi.tree.notes import NoteKind

SOFTWARE = '<swModel><tasks name="T">{}</tasks><labels name="L" initialValue="5"/></swModel>'


def root_of(tmp_path, target, **files):
    models, notes = migrated(itea.write(tmp_path, **files), target)
    return models.trees[0].root, notes


def kinds(notes, message):
    return [note.kind for note in notes if note.message == message]


@pytest.mark.parametrize("target", ["0.7.0"])
def test_up_to_the_published_conversions_it_is_lost(tmp_path, target):
    root, notes = root_of(tmp_path, target, number="1.2.0", m__amxmi=SOFTWARE.format("<deadline/>"))
    assert kinds(notes, "initial value of a label") == [NoteKind.LOST]
    assert root.find("swModel", "labels", "customProperties") == []
    assert [limit.get("value") for limit in root.find("constraintsModel", "requirements", "limit", "limitValue")] == ["0"]


def test_the_initial_value_of_a_label_is_kept(tmp_path):
    root, notes = root_of(tmp_path, "3.3.0", number="1.2.0", m__amxmi=SOFTWARE.format(""))
    (kept,) = root.find("swModel", "labels", "customProperties")
    assert (kept.get("key"), kept.child("value").get("value")) == ("initialValue", "5")
    assert kinds(notes, "initial value of a label") == [NoteKind.KEPT]


def test_a_deadline_without_value_is_no_requirement(tmp_path):
    root, _ = root_of(tmp_path, "3.3.0", number="1.2.0", m__amxmi=SOFTWARE.format("<deadline/>"))
    assert root.find("constraintsModel", "requirements") == []


def test_a_task_of_a_software_model_alone_is_cooperative(tmp_path):
    text = itea.model("1.2.0", '<tasks name="T"/>', root="sw:SWModel")
    root, notes = root_of(tmp_path, "3.3.0", number="1.2.0", m__amxmi=text)
    assert [task.get("preemption") for task in root.find("swModel", "tasks")] == ["cooperative"]
    assert NoteKind.DEFAULTED in {note.kind for note in notes if note.attribute == "" and "cooperative" in note.message}


def test_the_custom_properties_of_an_allocation_come_back(tmp_path):
    content = (
        '<swModel><tasks name="T"/></swModel><mappingModel><processAllocation xsi:type="mapping:TaskAllocation" '
        'process="T?type=sw.Task"><customProperties key="k"><value xsi:type="common:StringObject" value="v"/></customProperties>'
        "</processAllocation></mappingModel>"
    )
    root, _ = root_of(tmp_path, "3.3.0", number="1.3.0", m__amxmi=content)
    (kept,) = root.find("mappingModel", "taskAllocation", "customProperties")
    assert (kept.get("key"), kept.child("value").type) == ("k", "StringObject")


def test_measured_runtimes_are_kept(tmp_path):
    content = (
        '<swModel><runnables name="R"/></swModel><measurementModel><measurements runnable="R?type=Runnable">'
        '<runtimes value="5" unit="us"/></measurements></measurementModel>'
    )
    models, notes = migrated(written(tmp_path, "0.9.9", content), "3.3.0")
    (kept,) = models.parts("swModel", "runnables", "customProperties")
    assert kept.child("value").get("value") == "5 us"
    assert NoteKind.LOST not in {note.kind for note in notes}
