"""Whatever is said about a random application with executors in loops, no simulation of it shows the contrary.

`python -m opponent.hunt_executors --help` says how to look through more applications.
"""

import re

import pytest
import yaml
from effort import every
from opponent.executors.calls import different_calls
from opponent.executors.claims import false_claims, runs_of
from opponent.executors.descriptions import random_description
from opponent.executors.tally import Tally
from support import ROOT

from amalthea_uros.units import MILLISECOND

pytestmark = pytest.mark.early

#: Of which the table in docs/simulation.md is made.
SAMPLE = range(60)
RUNS = runs_of(200 * MILLISECOND, [1])
FOUND = sorted((ROOT / "tests" / "opponent" / "executors" / "found").glob("*.yaml"))
PAGE = (ROOT / "docs" / "simulation.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def sample():
    tally, found = Tally(), {}
    for seed in SAMPLE:
        if said := false_claims(random_description(seed), tally, heartbeats=False, runs=RUNS):
            found[seed] = said[:5]
    return tally, found


def test_nothing_that_is_observed_is_beyond_a_bound(sample):
    tally, found = sample
    assert found == {}
    assert tally.applications > 50
    assert tally.bounded["all"] > 200


def test_the_page_says_how_close_to_their_bounds_observed_values_are(sample):
    """If it does not: the right table is in the message."""
    tally, _ = sample
    told = re.search(r"^\| construct \|.*?\n\n", PAGE, re.DOTALL | re.MULTILINE)
    assert told is not None
    assert told[0].strip() == tally.short_table(), f"\n{tally.short_table()}\n"


def test_every_call_is_that_of_a_player():
    tally = Tally()
    assert {seed: said for seed in every(40, range(3000)) if (said := different_calls(seed, tally))} == {}
    assert tally.calls["executors"] > 50
    assert tally.calls["applications"] > 50


@pytest.mark.parametrize(
    "seed",
    [128, 257, 561, 606, 1586, 3956, 9920],
    ids=[
        "turn-of-a-thread",
        "session-that-is-free",
        "queue-of-equals",
        "stored-by-others",
        "messages-for-others",
        "read-and-not-called",
        "arrives-during-a-take",
    ],
)
def test_calls_that_once_differed(seed):
    assert different_calls(seed, Tally()) == []


@pytest.mark.parametrize("path", FOUND, ids=lambda path: path.stem)
def test_what_was_once_said_falsely_of_a_description(path):
    assert false_claims(yaml.safe_load(path.read_text()), runs=runs_of(300 * MILLISECOND, [1])) == []


@pytest.mark.parametrize(
    "seed",
    [5688, 6578, 10012, 10177],
    ids=["one-stream", "without-take", "back-from-the-agent", "timeouts"],
)
def test_what_was_once_said_falsely_of_a_random_description(seed):
    assert false_claims(random_description(seed), runs=runs_of(500 * MILLISECOND, [])) == []
