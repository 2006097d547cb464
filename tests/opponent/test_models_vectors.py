"""What is said about the published models with further constructs is not refuted by their facts, nor by plays of them.

Their facts come from another player: this one finds the same, or a play of its own that goes further.
"""

import json
from pathlib import Path

import pytest
from effort import every
from opponent.models.claims import Tally, is_determined, played_otherwise, refuted, wrong_answers
from opponent.models.facts import Facts, facts_of
from opponent.models.reading import UnplayableError, read
from support import SHARED

from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.services.simulate import simulate

FOLDER = SHARED / "vectors" / "constructs2"
ENTRIES = {entry["file"]: entry for entry in json.loads((FOLDER / "facts.json").read_text())} if FOLDER.exists() else {}
EQUAL = [name for name, entry in ENTRIES.items() if entry["simulate"] == "equal"]

needs_models = pytest.mark.skipif(not ENTRIES, reason="the models are not at hand")
#: Blocks of names, for several workers.
BLOCKS = range(6)


def published(name: str) -> Facts:
    """The facts about a model, as those of a play."""
    entry = ENTRIES[name]
    greatest, least = {}, {}
    for process, known in entry["processes"].items():
        greatest["process", process, "response_time"] = known["occurs_max_ps"]
        least["process", process, "response_time"] = known["occurs_min_ps"]
    for chain, known in entry["chains"].items():
        for quantity, value in known.items():
            (greatest if quantity.startswith("max") else least)["chain", chain, quantity] = value
    spread = {key: (least[key], greatest[key]) for key in least if key in greatest}
    return Facts(
        played=None,
        chains=(),
        delays=(),
        greatest=greatest,
        least=least,
        spread=spread,
        loose=dict(spread),
        constraints=(),
        lost=frozenset(),
        is_complete=False,  # type: ignore[arg-type]
    )


@needs_models
@pytest.mark.parametrize("block", BLOCKS)
def test_no_claim_is_refuted_and_no_limit_is_met(block):
    found = {}
    for name in every(7, list(ENTRIES)[block :: len(BLOCKS)]):
        analysis = analyze_files(FOLDER / name).analysis
        broken = {limit["name"] for limit in ENTRIES[name]["never_met"]}
        met = [item.name for item in analysis.requirements if item.name in broken and item.verdict is Verdict.MET]
        if said := [*refuted(analysis, published(name)), *met]:
            found[name] = said
    assert found == {}


@needs_models
@pytest.mark.parametrize("block", BLOCKS)
def test_plays_refute_nothing_either(block):
    found = {}
    for name in every(17, list(ENTRIES)[block :: len(BLOCKS)]):
        path = FOLDER / name
        try:
            facts = facts_of(path.read_bytes())
        except UnplayableError:
            continue
        if said := wrong_answers(path, facts, (), Tally(), frozenset(ENTRIES[name]["constructs"])):
            found[name] = said[:5]
    assert found == {}


@needs_models
@pytest.mark.parametrize("name", every(4, EQUAL))
def test_simulated_response_times_are_those_of_the_plays(name):
    simulation = simulate(FOLDER / name, ENTRIES[name]["play_length_ps"])
    assert list(played_otherwise(simulation, published(name))) == []


@needs_models
@pytest.mark.parametrize("name", every(4, EQUAL))
def test_both_players_agree_where_nothing_is_open(name):
    path = FOLDER / name
    facts, known = facts_of(path.read_bytes(), until=ENTRIES[name]["play_length_ps"]), published(name)
    if not is_determined(facts):
        return
    different = {
        key: (known.spread[key], facts.spread[key])
        for key in known.spread
        if not (facts.spread[key][0] <= known.least[key] and known.greatest[key] <= facts.spread[key][1])
    }
    assert different == {}


@needs_models
def test_nearly_all_of_them_are_played():
    assert len([path for path in sorted(FOLDER.glob("*.amxmi")) if is_readable(path)]) >= 110


def is_readable(path: Path) -> bool:
    try:
        read(path.read_bytes())
    except UnplayableError:
        return False
    return True
