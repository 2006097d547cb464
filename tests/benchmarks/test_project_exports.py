"""What is counted of models as INCHRON projects, and the figures that the page states."""

import pytest
from project_exports import count, lines
from support import ROOT, SHARED

CORPUS = SHARED / "corpus"


def test_a_stimulus_that_the_importer_leaves_out_is_exported():
    # One executor in a loop, whose rounds are an arrival curve; equal files are counted once.
    sample = ROOT / "samples" / "robot-xrce.amxmi"
    found = count([sample, sample])
    assert (found.files, found.failing, found.refused) == (1, 0, 0)
    assert found.stated["stimuli"] == found.exported["stimuli"] == found.imported["stimuli"] + 1


@pytest.mark.skipif(not CORPUS.exists(), reason="the published models are not here")
def test_the_figures_of_the_page():
    page = (ROOT / "docs" / "inchron.md").read_text()
    _, _, *table = lines(count(sorted(CORPUS.rglob("*.amxmi"))))
    assert "\n".join(table) in page
