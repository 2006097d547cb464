"""Whatever is said about a random model, no play of it shows the contrary, and no limit that is broken in it is met.

`python -m opponent.hunt_models` with `tests` and `tools` on the path looks through more models, and writes the smallest ones that fail.
"""

import pytest
from effort import every
from opponent.models.claims import Tally, false_claims
from opponent.models.generator import random_model
from opponent.models.richer import richer_model

#: Of the richer models, which take longer, the first ones.
SEEDS, RICHER = 1000, 500
BLOCK = 100


@pytest.mark.parametrize("first", range(0, SEEDS, BLOCK))
def test_nothing_false_is_said(first):
    examine(random_model, first)


@pytest.mark.parametrize("first", range(0, RICHER, BLOCK))
def test_nothing_false_is_said_of_richer_models(first):
    examine(richer_model, first)


def examine(make, first):
    tally, found = Tally(), {}
    for seed in every(BLOCK, range(first, first + BLOCK)):
        model = make(seed)
        if said := false_claims(model, tally):
            found[seed] = sorted(model.features), said[:5]
    assert found == {}
    assert tally.limits.total() > 0
