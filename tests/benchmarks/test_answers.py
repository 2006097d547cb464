"""What is counted of the answers about many models, and the figures that the page states."""

import re
from collections import Counter

import pytest
from answers import Answers, count, lines
from effort import IS_THOROUGH
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


#: How a reason begins or goes on, and its row on the page; the first one that fits counts.
KINDS = {
    "it is not allocated": "it is not allocated to a scheduler",
    "it has no stimulus": "it has no stimulus",
    "depends on": "depends on another process",
    "has no policy": "its scheduler has no policy",
    "it is triggered by": "it is triggered by another process",
    "as the lowest": "as the lowest, or in the worst order, it has no bound",
    "in the worst order": "as the lowest, or in the worst order, it has no bound",
    "overload": "overload",
    "the rate of the stimulus": "the rate of the stimulus is unbounded",
    "a distribution of ticks": "a distribution of ticks has no bounds",
    "it waits for": "it waits for events",
    "there is no analysis for the policy": "there is no analysis for the policy",
}


def kinds(answers):
    """The processes of each row."""
    found = Counter()
    for reason, number in answers.reasons.items():
        found[next(row for part, row in KINDS.items() if part in reason)] += number
    return found


@pytest.mark.skipif(not CORPUS.exists(), reason="the published models are not here")
def test_the_figures_of_the_page():
    found = count(sorted(CORPUS.rglob("*.amxmi")), with_proposals=IS_THOROUGH)
    page = (ROOT / "docs" / "analysis.md").read_text()
    rows = re.findall(
        r"^\| (?:processes|files|event chains) \| (\d+) \| (\d+) with [a-z ]+(?:, (\d+) with)?", page, re.MULTILINE
    )
    assert rows == [
        (str(found.processes), str(found.bounded), str(found.timed)),
        (str(found.files), str(found.complete), str(found.partial)),
        (str(found.chains), str(found.with_latency), ""),
    ]
    proposed = re.search(r"analysis of (\d+) of these files ends, (\d+) processes .*; they state (\d+) values", page)
    assert proposed is not None
    assert not IS_THOROUGH or tuple(map(int, proposed.groups())) == (found.commands, found.bounded + found.gained, found.stated)
    every = re.search(r"Of all (\d+) models with\s+processes, .* the analysis of (\d+) has", page)
    assert every is not None
    assert int(every[1]) == found.with_processes
    assert not IS_THOROUGH or int(every[2]) == found.answered
    table = re.findall(r"^\| ([a-z][^|]*) \| \d+ \| (\d+) \| ", page, re.MULTILINE)
    assert {reason: int(number) for reason, number in table if int(number)} == kinds(found)
