"""Whatever the analysis claims about a random system, no play of it shows the contrary.

`python -m opponent.hunt` with `tests` on the path looks through more systems, and prints the smallest ones that fail.
"""

import pytest
from opponent.claims import Tally, false_claims
from opponent.generator import random_system

SEEDS = 1000
BLOCK = 50
PLAYS = 2


@pytest.mark.parametrize("first", range(0, SEEDS, BLOCK))
def test_no_claim_is_refuted(first):
    tally, found = Tally(), {}
    for seed in range(first, first + BLOCK):
        if claims := false_claims(random_system(seed), PLAYS, tally):
            found[seed] = [str(claim) for claim in claims]
    assert found == {}, tally.text()
