"""Whatever the analysis claims about random and published systems, no play of them shows the contrary.

`python -m opponent.hunt` with `tests` on the path looks through more systems, and prints the smallest ones that fail.
"""

import pytest
from effort import every
from opponent.claims import Tally, false_claims, refuted
from opponent.generator import random_system
from opponent.observation import Observation
from opponent.systems import constructs_of
from opponent.to_perf import to_perf
from opponent.vectors import CONSTRUCTS, facts, needs_vectors, plain_systems

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.services.subject import open_system

SEEDS = 1000
BLOCK = 50
PLAYS = 2

#: The greatest share of unknown results that is acceptable in systems with a construct; in general, and where it is higher.
MOST_UNKNOWN = 0.25
EXCEPTIONS: dict[str, float] = {}


@pytest.mark.parametrize("first", range(0, SEEDS, BLOCK))
def test_no_claim_is_refuted(first):
    found = {}
    for seed in every(12, range(first, first + BLOCK)):
        if claims := false_claims(random_system(seed), PLAYS):
            found[seed] = [str(claim) for claim in claims]
    assert found == {}


def test_most_results_are_known():
    tally = Tally()
    for seed in every(2, range(200)):
        system = random_system(seed)
        tally.add_analysis(analyze_system(to_perf(system)), constructs_of(system))
    too_many = {name: share for name, share in tally.shares().items() if share > EXCEPTIONS.get(name, MOST_UNKNOWN)}
    assert too_many == {}, tally.text()


# Whatever the analysis claims about the published systems, their facts do not show the contrary.


def as_observation(fact) -> Observation:
    """The facts about a system; the quantities of a chain are determined together."""
    processes = fact["processes"]
    chain = fact["chains"].get("chain", {"determined": False})
    latencies = {quantity: value for quantity, value in chain.items() if quantity != "determined" and value is not None}
    determined = {name for name, known in processes.items() if known["determined"]}
    return Observation(
        worst={name: known["occurs_max_us"] for name, known in processes.items()},
        best={name: known["occurs_min_us"] for name, known in processes.items()},
        chain=latencies,
        determined=frozenset(determined | (set(latencies) if chain["determined"] else set())),
    )


@needs_vectors
@pytest.mark.parametrize("block", range(4))
def test_no_claim_about_a_published_system_is_refuted(block):
    tally, found = Tally(), {}
    for fact in every(7, list(facts().values())[block::4]):
        analysis = analyze_files(CONSTRUCTS / fact["file"]).analysis
        tally.add_analysis(analysis, frozenset(fact["constructs"]))
        if claims := refuted(analysis, as_observation(fact)):
            found[fact["file"]] = [str(claim) for claim in claims]
    assert found == {}, tally.text()


# The systems that the player plays are those that the product analyses.


@needs_vectors
def test_a_converted_system_is_the_one_extracted_from_its_model():
    systems = every(3, list(plain_systems().items()))
    different = [name for name, plain in systems if to_perf(plain) != open_system([CONSTRUCTS / name]).system]
    assert different == []
