"""What was read is written back: every file to the letter, and what EMF wrote also in canonical form."""

import pytest
from lxml import etree
from support import DATA, corpus, hand_written

import amalthea_uros as amuros

LOCAL = [pytest.param(path, id=path.name) for path in sorted(DATA.glob("*.amxmi"))]


def saved(model, folder, **options):
    target = folder / "saved.amxmi"
    amuros.save(model, target, **options)
    return target.read_bytes()


@pytest.mark.parametrize("path", [*LOCAL, *corpus(), *hand_written()])
def test_an_unchanged_model_is_written_to_the_letter_also_if_it_was_touched(path, tmp_path):
    model = amuros.load(path)
    assert saved(model, tmp_path) == path.read_bytes()
    model.documents[0].changes.modified.update(model.walk())
    assert saved(model, tmp_path) == path.read_bytes()


@pytest.mark.parametrize("path", [*LOCAL, *corpus("EMF style")])
def test_canonical_form_is_what_emf_writes(path, tmp_path):
    assert saved(amuros.load(path), tmp_path, canonical=True) == path.read_bytes()


@pytest.mark.parametrize("path", hand_written())
def test_canonical_form_is_stable_and_means_the_same(path, tmp_path):
    model = amuros.load(path)
    first = saved(model, tmp_path, canonical=True)
    again = amuros.load(tmp_path / "saved.amxmi")
    assert saved(again, tmp_path, canonical=True) == first
    assert [type(e) for e in again.walk()] == [type(e) for e in model.walk()]
    # Told with another XML parser: EMF writes neither the first literal of an enumeration nor an `xsi:type` that says nothing.
    after = {value for element in etree.fromstring(first).iter("*") for value in element.attrib.values()}
    xsi_type = "{http://www.w3.org/2001/XMLSchema-instance}type"
    before = {v for e in etree.parse(path).getroot().iter("*") for k, v in e.attrib.items() if k != xsi_type}
    assert {value for value in before - after if value not in ("_all_", "_undefined_") and not value.isdigit()} == set()
