"""A read at the very instant of a write: nobody states which comes first, unless one keeps the other from its core."""

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
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import Duration


def reaction(analysis):
    """The maximum reduced reaction time, and its claim."""
    value = next(v for v in analysis.chains["flow"].values if v.quantity is LatencyQuantity.MAX_REDUCED_REACTION_TIME)
    return value.value, value.claim


EVENTS = (
    ProcessEvent(name="written", process="W", change=ProcessChange.START),
    ProcessEvent(name="answered", process="R", change=ProcessChange.TERMINATE),
)


def built(writer, reader):
    return system(writer, reader, labels=(Label(name="L"),), events=EVENTS, chains=[chain("flow", "written", "answered")])


#: R reads 4 us after its release, and W writes then: just after the end of R, or on another core.
WRITER = Proc("W", (access("L", WRITE), ticks(1)), 40, priority=1)
READER = Proc("R", (ticks(4), access("L", READ)), 40, priority=2)


@pytest.mark.parametrize(
    "writer",
    [WRITER, Proc("W", WRITER.body, 40, 4, priority=1, scheduler="s1")],
    ids=["after the end of the reader", "on another core"],
)
def test_a_read_may_come_just_before_a_write_of_the_same_instant(writer):
    analysis = analyze_system(built(writer, READER))
    # Written at 4 us, read at 44 us, answered at once.
    assert reaction(analysis) == (40 * US, Claim.BOUND)
    assert "order is not specified" in analysis.chains["flow"].why


def test_what_a_simulation_observes_of_such_a_chain_is_within_the_bound():
    observed = simulate_system(built(WRITER, READER), Options(duration=Duration(400 * US))).chains["flow"]
    assert observed.quantities[ChainQuantity.REDUCED_REACTION_TIME].max == 40 * US


def test_a_writer_that_keeps_the_reader_from_their_core_comes_first():
    writer = Proc("W", (ticks(2), access("L", WRITE)), 40, priority=3)
    reader = Proc("R", (access("L", READ), ticks(4)), 40, priority=2)
    # W writes at 2 us as it ends, R reads then and answers at 6 us.
    assert reaction(analyze_system(built(writer, reader))) == (6 * US, Claim.EXACT)


# Chains whose response is the start of a job that reads later: it can come before its stimulus, and then does not answer it.


VARYING = Execute(demand=Demand(Boundaries(lower=2, upper=3)))


def overtaking(before_write):
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
    found = {value.quantity: value.value for value in analyze_system(overtaking(before_write)).chains["flow"].values}
    assert found.get(LatencyQuantity.MAX_REDUCED_REACTION_TIME, 56 * US) >= 56 * US
    # The response at 60 us shows the job of W that started at 4 us; that at 0 us shows the one before, at -86 us if there was one.
    assert found.get(LatencyQuantity.MAX_REDUCED_DATA_AGE, 86 * US) >= 86 * US
    assert all(value >= 0 for value in found.values())


def test_no_observed_latency_is_negative():
    (observed,) = simulate_system(overtaking(ticks(3)), Options(duration=Duration(1800 * US))).chains
    reaction = observed.quantities[ChainQuantity.REDUCED_REACTION_TIME]
    assert (reaction.min, reaction.max) == (26 * US, 56 * US)
    assert observed.quantities[ChainQuantity.REDUCED_DATA_AGE].min >= 0
