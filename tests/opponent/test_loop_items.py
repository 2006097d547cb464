"""Whatever is said about a random application whose loops do more than spin, no simulation of it shows the contrary."""

import pytest
from effort import every
from opponent.executors.claims import false_claims, runs_of
from opponent.executors.loop_items import description_with_items
from opponent.executors.tally import Tally

from amalthea_uros.units import MILLISECOND

pytestmark = pytest.mark.early

RUNS = runs_of(200 * MILLISECOND, [1])


def test_nothing_that_is_observed_is_beyond_a_bound():
    tally = Tally()
    found = {
        seed: said for seed in every(60, range(600)) if (said := false_claims(description_with_items(seed), tally, runs=RUNS))
    }
    assert found == {}
    assert tally.applications > 6
    assert tally.bounded["item of a loop: ping"] > 3
    assert tally.bounded["item of a loop: publish"] > 3
