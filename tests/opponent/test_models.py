"""Whatever is said about a random model, no play of it shows the contrary, and no limit that is broken in it is met.

`python -m opponent.hunt_models` with `tests` and `tools` on the path looks through more models, and writes the smallest ones that fail.
"""

import pytest
from effort import every
from opponent.models.claims import Tally, false_claims
from opponent.models.generator import random_model

SEEDS = 1000
BLOCK = 100


@pytest.mark.parametrize("first", range(0, SEEDS, BLOCK))
def test_nothing_false_is_said(first):
    tally, found = Tally(), {}
    for seed in every(BLOCK, range(first, first + BLOCK)):
        model = random_model(seed)
        if said := false_claims(model, tally):
            found[seed] = sorted(model.features), said[:5]
    assert found == {}
    assert tally.limits.total() > 0
