"""What is counted of the answers about many models, and the figures that the page states."""

import re

import pytest
from answers import Answers, count, lines
from support import ROOT, SHARED

CORPUS = SHARED / "corpus"


def test_a_model_with_answers_is_counted():
    found = count([ROOT / "samples" / "bodas-test-advanced.amxmi"])
    assert (found.files, found.complete, found.partial, found.chains, found.with_latency) == (1, 1, 0, 1, 1)
    assert found.processes == found.bounded == found.timed == 3
    assert not found.reasons


def test_reasons_are_counted_without_names():
    found = Answers(files=1, processes=2)
    found.reasons["depends on '...', which could not be analysed"] = 2
    found.files_of["depends on '...', which could not be analysed"] = 1
    assert list(lines(found))[-1] == "    2 in   1 files: depends on '...', which could not be analysed"


@pytest.mark.skipif(not CORPUS.exists(), reason="the published models are not here")
def test_the_figures_of_the_page():
    found = count(sorted(CORPUS.rglob("*.amxmi")))
    page = (ROOT / "docs" / "analysis.md").read_text()
    rows = re.findall(
        r"^\| (?:processes|files|event chains) \| (\d+) \| (\d+) with [a-z ]+(?:, (\d+) with)?", page, re.MULTILINE
    )
    assert rows == [
        (str(found.processes), str(found.bounded), str(found.timed)),
        (str(found.files), str(found.complete), str(found.partial)),
        (str(found.chains), str(found.with_latency), ""),
    ]
