"""Files that hold less than a model."""

import itea
import pytest
from migration import migrated

from amalthea_uros import load
from amalthea_uros.xmi.tree.notes import NoteKind


@pytest.mark.parametrize(
    ("root", "place", "type_name"),
    [
        ("sw:Runnable", ("swModel", "runnables"), ""),
        ("hw:Bus", ("hwModel", "networkTypes"), "Bus"),
        ("hw:MemType", ("hwModel", "memoryTypes"), ""),
        ("stimuli:Single", ("stimuliModel", "stimuli"), "Single"),
        ("events:StimulusEvent", ("eventModel", "events"), "StimulusEvent"),
        ("hw:Quartz", ("hwModel", "system", "quartzes"), ""),
        ("hw:Core", ("hwModel", "system", "ecus", "microcontrollers", "cores"), ""),
    ],
)
def test_a_part_becomes_a_whole_model(tmp_path, root, place, type_name):
    (path,) = itea.write(tmp_path, "1.3.0", m__amxmi=itea.model("1.3.0", "", root=root, attributes='name="X"'))
    models, notes = migrated([path], "0.7.1")
    (part,) = models.trees[0].root.find(*place)
    assert (part.type, part.name) == (type_name, "X")
    assert NoteKind.LOST not in {note.kind for note in notes}
    assert [finding.rule for finding in load(path).findings if finding.rule not in ("XMI008", "XMI009")] == []


def test_a_pin_alone_means_nothing(tmp_path):
    (path,) = itea.write(tmp_path, "1.3.0", m__amxmi=itea.model("1.3.0", "", root="hw:ComplexPin", attributes='name="X"'))
    models, notes = migrated([path], "3.3.0")
    assert models.trees[0].root.children == []
    assert [note.message for note in notes if note.kind is NoteKind.LOST] == [
        "root of a file that is part of an object in no file"
    ]


def test_references_into_it_are_kept(tmp_path):
    whole, part = itea.write(
        tmp_path,
        "1.2.0",
        m__amxmi='<swModel><tasks name="T"><callGraph><graphEntries xsi:type="sw:CallSequence"><calls xsi:type="sw:TaskRunnableCall">'
        '<runnable href="r.amxmi-sw#_1"/></calls></graphEntries></callGraph></tasks></swModel>',
        r__amxmi_sw=itea.model("1.2.0", "", root="sw:Runnable", attributes='name="R" xmi:id="_1"'),
    )
    model = load(whole)
    assert [document.path.name for document in model.documents] == ["m.amxmi", "r.amxmi-sw"]
    (call,) = (element for element in model.walk() if type(element).__name__ == "RunnableCall")
    assert call.runnable.document.path == part
