"""The table of docs/inchron.md against what arrives of the published models."""

import sys

import pytest
from effort import IS_THOROUGH
from support import ROOT, SHARED

sys.path.append(str(ROOT / "benchmarks"))
from project_exports import count, lines

CORPUS = SHARED / "corpus"
PAGE = (ROOT / "docs" / "inchron.md").read_text(encoding="utf-8")


def chains_of(paths):
    return count(paths).exported["event chains"]


@pytest.mark.skipif(not CORPUS.exists(), reason="the published models are not at hand")
def test_the_table_counts_what_arrives():
    """A usual run only counts the chains of the smaller files, of which 8 of two files arrive and none of the others."""
    if IS_THOROUGH:
        rows = [row for row in lines(count(sorted(CORPUS.rglob("*.amxmi")))) if row.startswith("|")]
        assert set(rows) <= set(PAGE.splitlines())
        return
    small = [path for path in sorted(CORPUS.rglob("*.amxmi")) if path.stat().st_size < 500_000]
    paths = [path for path in small if b"<eventChains" in path.read_bytes()]
    assert (len(paths), chains_of(paths)) == (4, 8)


def test_a_stimulus_that_the_importer_leaves_out_is_exported():
    # One executor in a loop, whose rounds are an arrival curve; equal files are counted once.
    sample = ROOT / "samples" / "robot-xrce.amxmi"
    found = count([sample, sample])
    assert (found.files, found.failing, found.refused) == (1, 0, 0)
    assert found.stated["stimuli"] == found.exported["stimuli"] == found.imported["stimuli"] + 1
