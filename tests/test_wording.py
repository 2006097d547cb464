"""Pages, messages, docstrings and names use the field's words: see `wording.yaml`."""

from collections import defaultdict
from pathlib import Path

import pytest
import wording


@pytest.fixture(scope="module")
def uses():
    """The uses of words that have a better one, by page; those of the package together."""
    found = defaultdict(list)
    for use in wording.all_uses():
        found[wording.place(use)].append(use)
    return found


def test_words_that_have_a_better_one_become_fewer(uses):
    still = wording.words()["still"]
    more = [use for place, here in uses.items() if len(here) > still.get(place, 0) for use in here]
    assert not more, "\n".join(map(str, more))


def test_what_has_become_clean_stays_clean(uses):
    assert wording.words()["still"].keys() <= uses.keys()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("'''What a round executes.'''", ["What", "round"]),
        ("'''Sums are rounded up, as round trips, by round-robin.'''", []),
        ("'''See `play`.'''", []),
        ("found = 'a word'", ["found"]),
        ("# Nobody is told.", ["told"]),
        ("raise KeyError('lies in the way')", ["lies in"]),
        ("KEY = 'round'", []),
    ],
)
def test_words_are_found_where_people_read_them(tmp_path, monkeypatch, text, words):
    monkeypatch.setattr(wording, "ROOT", tmp_path)
    path = Path(tmp_path, "module.py")
    path.write_text(text)
    assert sorted(use.word for use in wording.uses_in_module(path)) == sorted(words)
