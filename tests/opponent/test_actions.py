"""Whatever is said about random applications and robots with actions, no simulation of it shows the contrary."""

import pytest
from effort import every
from opponent.executors.actions import description_with_actions, robot_with_actions
from opponent.executors.claims import false_claims, runs_of
from opponent.executors.tally import Tally

from amalthea_uros.units import MILLISECOND

pytestmark = pytest.mark.early

RUNS = runs_of(300 * MILLISECOND, [1])


def test_nothing_that_is_observed_of_an_application_is_beyond_a_bound():
    tally = Tally()
    found = {
        seed: said for seed in every(60, range(600)) if (said := false_claims(description_with_actions(seed), tally, runs=RUNS))
    }
    assert found == {}
    assert tally.applications > 6
    assert tally.bounded["handle: action server"] > 3


def test_nothing_that_is_observed_of_a_robot_is_beyond_a_bound():
    tally = Tally()
    found = {seed: said for seed in every(20, range(80)) if (said := false_claims(robot_with_actions(seed), tally, runs=RUNS))}
    assert found == {}
    assert tally.applications > 3
    assert tally.bounded["handle: action client"] + tally.bounded["handle: action server"] > 0
