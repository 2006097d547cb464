"""Whatever the analysis claims about the published systems, their facts do not show the contrary."""

import pytest
from effort import every
from opponent.claims import Tally, refuted
from opponent.observation import Observation
from opponent.vectors import CONSTRUCTS, facts, needs_vectors

from amalthea_uros.services.analyze import analyze_files


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
def test_no_claim_is_refuted(block):
    tally, found = Tally(), {}
    for fact in every(7, list(facts().values())[block::4]):
        analysis = analyze_files(CONSTRUCTS / fact["file"]).analysis
        tally.add_analysis(analysis, frozenset(fact["constructs"]))
        if claims := refuted(analysis, as_observation(fact)):
            found[fact["file"]] = [str(claim) for claim in claims]
    assert found == {}, tally.text()
