"""Whatever is said about a random application on a wire that loses messages, no simulation of it shows the contrary."""

import pytest
from effort import every
from opponent.executors.claims import false_claims, runs_of
from opponent.executors.lossy import description_with_losses
from opponent.executors.tally import Tally

from amalthea_uros.units import SECOND

pytestmark = pytest.mark.early

RUNS = runs_of(SECOND, [1])[1:]


def test_nothing_that_is_observed_is_beyond_a_bound():
    tally, drawn = Tally(), every(200, range(600))
    found = {seed: said for seed in drawn if (said := false_claims(description_with_losses(seed), tally, runs=RUNS))}
    assert found == {}
    assert tally.applications == len(list(drawn))
    assert tally.bounded["messages are lost"] > 5
