"""Every object and attribute knows its line and column."""

from migration import model
from support import DATA

import amalthea_uros as amuros
from amalthea_uros.am import ActivityGraph, Label, Runnable


def position(element, attribute=""):
    return tuple(element.document.source.position_of(element, attribute))


def test_an_object_and_its_attributes():
    model = amuros.load(DATA / "brake.amxmi")
    assert position(model[Runnable, "Act"]) == (18, 5)
    assert position(model[Runnable, "Act"], "callback") == (18, 54)


def test_columns_count_characters(tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text((DATA / "brake.amxmi").read_text().replace('displayName=""', 'displayName="漢字 😀 é"'))
    label = amuros.load(path)[Label, "Pedal"]
    line = path.read_text().splitlines()[18]
    assert position(label, "constant") == (19, line.index("constant") + 1)
    assert position(label.size) == (20, 7)


def test_beyond_the_line_at_which_libxml2_stops_counting(tmp_path):
    path = tmp_path / "long.amxmi"
    lines = 70_000
    labels = "\n" * lines + "".join(f'    <labels name="L{i}"\n     constant="maybe"/>\n' for i in range(3))
    path.write_text((DATA / "brake.amxmi").read_text().replace("  </swModel>", f"{labels}  </swModel>"))
    model = amuros.load(path)
    assert position(model[Label, "L2"]) == (22 + lines + 4, 5)
    assert position(model[Label, "L2"], "constant") == (22 + lines + 5, 6)
    (finding,) = model.findings
    assert (finding.location.line, finding.location.column) == (22 + lines + 1, 6)
    assert "3 times" in finding.message


def test_the_text_of_a_line_is_kept_once(tmp_path):
    # All of a file may stand in one line, and a finding about each of its objects carries that.
    model = amuros.load(DATA / "brake.amxmi")
    document = model.documents[0]
    lines = [document.location_of(element).text for element in (model[Runnable, "Act"], model[Runnable, "Act"])]
    assert lines[0] is lines[1]


def test_a_finding_about_several_references_is_at_the_first_of_the_file(tmp_path):
    path = tmp_path / "model.amxmi"
    there, missing = ("S?type=PeriodicStimulus", "X?type=PeriodicStimulus")
    lines = [
        f'<tasks name="T1" stimuli="{there}"/>',
        f'<isrs name="I" stimuli="{missing}"/>',
        f'<tasks name="T2" stimuli="{missing}"/>',
    ]
    stimulus = '<stimuliModel><stimuli xsi:type="am:PeriodicStimulus" name="S"/></stimuliModel>'
    path.write_text(model("3.3.0", "<swModel>\n" + "\n".join(lines) + f"\n</swModel>{stimulus}"))
    (finding,) = amuros.load(path).findings
    assert "2 references, this is the first" in finding.message
    assert finding.location.text == lines[1]


def test_an_attribute_of_a_new_object_is_not_that_of_its_container():
    model = amuros.load(DATA / "brake.amxmi")
    document = model.documents[0]
    act = model[Runnable, "Act"]
    act.activity_graph = ActivityGraph()
    new = document.location_of(act.activity_graph, "callback")
    assert (new.line, new.column) == (18, 5)
