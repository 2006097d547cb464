"""Chains whose response is the start of a job that reads later: it can come before its stimulus, and then does not answer it."""

import pytest
from hand_made_systems import READ, WRITE, Proc, access, chain, system, ticks

from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Demand, Execute
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.events import ProcessChange, ProcessEvent
from amalthea_uros.perf.software import Label
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import MICROSECOND as US

VARYING = Execute(demand=Demand(Boundaries(lower=2, upper=3)))


def built(before_write):
    """W starts at 4 and at 94 of 180 us and writes up to 3 us later; R starts at 0, 60, 120 and reads 10 us later.

    What W writes at 7 is read at 10 by the job of R that has started before W: the next one starts at 60, 56 us after W. The other
    job of W is answered by the job of R at 120, after 26 us.
    """
    events = [ProcessEvent(name=name, process=name, change=ProcessChange.START) for name in "WR"]
    return system(
        Proc("W", (before_write, access("L", WRITE)), 90, 4, priority=1),
        Proc("R", (ticks(10), access("L", READ)), 60, priority=1, scheduler="s1"),
        labels=(Label(name="L"),),
        events=tuple(events),
        chains=[chain("flow", "W", "R")],
    )


@pytest.mark.parametrize("before_write", [ticks(3), VARYING], ids=["constant", "varying"])
def test_no_bound_counts_on_a_response_before_its_stimulus(before_write):
    found = {value.quantity: value.value for value in analyze_system(built(before_write)).chains["flow"].values}
    assert found.get(LatencyQuantity.MAX_REDUCED_REACTION_TIME, 56 * US) >= 56 * US
    # The response at 60 us shows the job of W that started at 4 us; that at 0 us shows the one before, at -86 us if there was one.
    assert found.get(LatencyQuantity.MAX_REDUCED_DATA_AGE, 86 * US) >= 86 * US
    assert all(value >= 0 for value in found.values())


def test_no_observed_latency_is_negative():
    (observed,) = simulate_system(built(ticks(3)), Options(duration=1800 * US)).chains
    reaction = observed.quantities[ChainQuantity.REDUCED_REACTION_TIME]
    assert (reaction.min, reaction.max) == (26 * US, 56 * US)
    assert observed.quantities[ChainQuantity.REDUCED_DATA_AGE].min >= 0
