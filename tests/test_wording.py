"""Pages, messages, docstrings and names use the field's words: see `wording.yaml`."""

from collections import defaultdict
from pathlib import Path

import pytest
import wording

#: The uses of words that have a better one, by page or room.
USES = defaultdict(list)
for use in wording.all_uses():
    USES[wording.place(use)].append(use)


@pytest.mark.parametrize("place", sorted(USES))
def test_words_that_have_a_better_one_become_fewer(place):
    uses, still = USES[place], wording.words()["still"].get(place, 0)
    assert len(uses) <= still, "\n".join(map(str, uses))


def test_what_has_become_clean_stays_clean():
    assert {place for place in wording.words()["still"] if place not in USES} == set()


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
