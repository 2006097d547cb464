"""Every object and attribute knows its line and column."""

from support import DATA

import amalthea_uros as amuros
from amalthea_uros.am import Label, Runnable


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
    labels = "\n".join(f'    <labels name="L{i}"\n     constant="maybe"/>' for i in range(70_000))
    text = (DATA / "brake.amxmi").read_text()
    path.write_text(text.replace("  </swModel>", f"{labels}\n  </swModel>"))
    model = amuros.load(path)
    assert position(model[Label, "L69999"]) == (22 + 2 * 69_999, 5)
    assert position(model[Label, "L69999"], "constant") == (23 + 2 * 69_999, 6)
    (finding,) = model.findings
    assert (finding.location.line, finding.location.column) == (23, 6)
    assert "70000 times" in finding.message


def test_the_text_of_a_line_is_kept_once(tmp_path):
    # All of a file may stand in one line, and a finding about each of its objects carries that.
    model = amuros.load(DATA / "brake.amxmi")
    document = model.documents[0]
    lines = [document.location_of(element).text for element in (model[Runnable, "Act"], model[Runnable, "Act"])]
    assert lines[0] is lines[1]
