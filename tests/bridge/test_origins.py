"""What is wrong with a built model is told with the place that caused it."""

import copy
import pickle
from dataclasses import FrozenInstanceError, replace

import pytest

from amalthea_uros import load, save
from amalthea_uros.am import Label, Task
from amalthea_uros.bridge.build import build_model
from amalthea_uros.bridge.extract import extract
from amalthea_uros.diagnostics import Location
from amalthea_uros.errors import WriteError
from amalthea_uros.perf.activities import Call
from amalthea_uros.perf.os import Os, Semaphore, SemaphoreKind
from amalthea_uros.perf.software import Software
from amalthea_uros.perf.software import Task as PerfTask
from amalthea_uros.perf.system import System


def test_what_a_version_does_not_know_points_to_the_line_that_asks_for_it(tmp_path):
    place = Location(tmp_path / "app.yaml", 7, 3, "  - {name: lock}")
    system = System(os=Os(semaphores=(Semaphore(name="lock", kind=SemaphoreKind.MUTEX, origin=place),)))
    model = build_model(system, "2.0.0")
    with pytest.raises(WriteError) as caught:
        save(model, tmp_path / "app.amxmi")
    (finding,) = caught.value.findings
    assert (finding.rule, finding.location, finding.object) == ("XMI100", place, "lock")
    assert "Mutex" in finding.message
    assert not (tmp_path / "app.amxmi").exists()


def test_a_name_that_leads_nowhere_points_to_who_says_it(tmp_path):
    place = Location(tmp_path / "app.yaml", 9, 3)
    task = PerfTask(name="T", stimuli=("never",), activities=(Call(runnable="nothing"),), origin=place)
    with pytest.raises(WriteError) as caught:
        build_model(System(software=Software(tasks=(task, PerfTask(name="T")))))
    assert {(finding.message, finding.location) for finding in caught.value.findings} == {
        ("T: undefined stimulus 'never'", place),
        ("T: undefined runnable 'nothing'", place),
        ("T: duplicate name 'T': two objects of kind process have it", None),
    }


def test_an_object_that_was_read_is_found_in_its_file(tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text(
        '<am:Amalthea xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0" xmlns:xmi="http://www.omg.org/XMI">\n'
        '  <swModel>\n    <labels name="L"/>\n  </swModel>\n</am:Amalthea>\n'
    )
    model = load(path)
    model[Label, "L"].constant = "perhaps"
    with pytest.raises(WriteError) as caught:
        save(model)
    location = caught.value.findings[0].location
    assert (location.path, location.line, location.column, location.text) == (path, 3, 5, '    <labels name="L"/>')


def test_a_part_of_a_built_object_comes_from_where_that_comes_from(tmp_path):
    place = Location(tmp_path / "app.yaml", 4, 1)
    model = build_model(System(software=Software(tasks=(PerfTask(name="T", origin=place),))))
    graph = model[Task, "T"].activity_graph
    assert graph is None or model.documents[0].location_of(graph) == place
    assert model.documents[0].location_of(model.root) is None


LABELS = """<am:Amalthea xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0" xmlns:xmi="http://www.omg.org/XMI">
  <swModel>
    <labels name="é"/> <labels name="L"/>
  </swModel>
</am:Amalthea>
"""


@pytest.fixture
def label(tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text(LABELS)
    return extract(load(path)).system.labels["L"]


def test_an_extracted_object_comes_from_its_place_in_the_file(label, tmp_path):
    assert label.origin == Location(tmp_path / "model.amxmi", 3, 24, '    <labels name="é"/> <labels name="L"/>')
    assert label.origin is label.origin


def test_an_extracted_object_can_be_copied_with_its_origin(label, tmp_path):
    for copied in (copy.deepcopy(label), pickle.loads(pickle.dumps(label)), replace(label, size=8)):
        assert copied.origin == Location(tmp_path / "model.amxmi", 3, 24, '    <labels name="é"/> <labels name="L"/>')


def test_the_origin_of_an_object_cannot_be_changed(label):
    with pytest.raises(FrozenInstanceError):
        label.origin = None


def test_a_new_object_has_no_origin():
    assert PerfTask(name="T").origin is None
