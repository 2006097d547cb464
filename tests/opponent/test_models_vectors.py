"""What is said about the published models is not refuted by their facts, nor by plays of them.

The facts come from another player: this one finds the same, or a play of its own that goes further.
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
from amalthea_uros.units import Duration

#: Models with every construct, and those with further ones.
FOLDERS = [SHARED / "vectors" / folder for folder in ("constructs", "constructs2")]
ENTRIES = {
    folder / entry["file"]: entry
    for folder in FOLDERS
    if folder.exists()
    for entry in json.loads((folder / "facts.json").read_text())
}
FIRST = [path for path in ENTRIES if path.parent == FOLDERS[0]]
FURTHER = [path for path in ENTRIES if path.parent == FOLDERS[1]]
EQUAL = [path for path in FURTHER if ENTRIES[path]["simulate"] == "equal"]

needs_models = pytest.mark.skipif(not ENTRIES, reason="the models are not at hand")
#: Blocks of models, for several workers.
BLOCKS = range(6)


def of_block(block: int, step: int) -> list[Path]:
    """Some of the models of each folder."""
    return [path for paths in (FIRST, FURTHER) for path in every(step, paths[block :: len(BLOCKS)])]


def published(path: Path) -> Facts:
    """The facts about a model, as those of a play, in picoseconds."""
    unit, microsecond = ("us", 10**6) if path in FIRST else ("ps", 1)
    greatest, least, determined = {}, {}, set()
    for process, known in ENTRIES[path]["processes"].items():
        key = "process", process, "response_time"
        greatest[key] = known[f"occurs_max_{unit}"] * microsecond
        least[key] = known[f"occurs_min_{unit}"] * microsecond
        determined |= {key} if known.get("determined") else set()
    for chain, known in ENTRIES[path]["chains"].items():
        for quantity, value in known.items():
            if quantity != "determined" and value is not None:
                key = "chain", chain, quantity
                (greatest if quantity.startswith("max") else least)[key] = value * microsecond
                determined |= {key} if known.get("determined") else set()
    spread = {key: (least[key], greatest[key]) for key in least if key in greatest}
    return Facts(
        played=None,  # type: ignore[arg-type]
        chains=(),
        delays=(),
        greatest=greatest,
        least=least,
        spread=spread,
        loose=dict(spread),
        constraints=(),
        lost=frozenset(),
        is_complete=False,
        determined=frozenset(determined),
    )


@needs_models
@pytest.mark.parametrize("block", BLOCKS)
def test_no_claim_is_refuted_and_no_limit_is_met(block):
    found = {}
    for path in of_block(block, 10):
        analysis = analyze_files(path).analysis
        broken = {limit["name"] for limit in ENTRIES[path].get("never_met", ())}
        met = [item.name for item in analysis.requirements if item.name in broken and item.verdict is Verdict.MET]
        if said := [*refuted(analysis, published(path)), *met]:
            found[path.name] = said
    assert found == {}


@needs_models
@pytest.mark.parametrize("block", BLOCKS)
def test_plays_refute_nothing_either(block):
    found = {}
    for path in of_block(block, 40):
        try:
            facts = facts_of(path.read_bytes())
        except UnplayableError:
            continue
        if said := wrong_answers(path, facts, (), Tally(), frozenset(ENTRIES[path]["constructs"])):
            found[path.name] = said[:5]
    assert found == {}


@needs_models
@pytest.mark.parametrize("block", BLOCKS)
def test_simulated_response_times_are_those_of_the_plays(block):
    found = {}
    for path in every(7, EQUAL[block :: len(BLOCKS)]):
        simulation = simulate(path, Duration(ENTRIES[path]["play_length_ps"]))
        if said := list(played_otherwise(simulation, published(path))):
            found[path.name] = said
    assert found == {}


@needs_models
@pytest.mark.parametrize("block", BLOCKS)
def test_both_players_agree_where_nothing_is_open(block):
    found = {}
    for path in [*every(40, FIRST[block :: len(BLOCKS)]), *every(20, EQUAL[block :: len(BLOCKS)])]:
        facts = facts_of(path.read_bytes(), until=ENTRIES[path].get("play_length_ps"))
        if said := list(different(facts, published(path), is_determined(facts) and path in FURTHER)):
            found[path.name] = said
    assert found == {}


def different(mine: Facts, known: Facts, has_same_length: bool):
    """Where what is certain for one of the players is impossible for the other."""
    for key in known.determined:
        found = mine.least.get(key), mine.greatest.get(key)
        # Of a chain, each quantity is known from one side.
        if any(f is not None and f != k.get(key, f) for f, k in zip(found, (known.least, known.greatest), strict=True)):
            yield f"{key}: always {known.least.get(key)}..{known.greatest.get(key)}, but {found} occurs"
    for key in known.spread if has_same_length else known.spread.keys() & mine.determined:
        least, greatest = mine.spread[key]
        if not (least <= known.least[key] and known.greatest[key] <= greatest):
            yield f"{key}: always {least}..{greatest}, but {known.spread[key]} is known to occur"


@needs_models
def test_nearly_all_of_them_are_played():
    assert all(map(is_readable, every(10, FIRST)))
    assert sum(map(is_readable, FURTHER)) >= 110


def is_readable(path: Path) -> bool:
    try:
        read(path.read_bytes())
    except UnplayableError:
        return False
    return True
