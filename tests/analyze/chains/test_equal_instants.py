"""A read at the very instant of a write: nobody states which comes first, unless one keeps the other from its core."""

import pytest
from hand_made_systems import READ, WRITE, Proc, access, chain, system, ticks

from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.events import ProcessChange, ProcessEvent
from amalthea_uros.perf.software import Label
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import MICROSECOND as US


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
    observed = simulate_system(built(WRITER, READER), Options(duration=400 * US)).chains["flow"]
    assert observed.quantities[ChainQuantity.REDUCED_REACTION_TIME].max == 40 * US


def test_a_writer_that_keeps_the_reader_from_their_core_comes_first():
    writer = Proc("W", (ticks(2), access("L", WRITE)), 40, priority=3)
    reader = Proc("R", (access("L", READ), ticks(4)), 40, priority=2)
    # W writes at 2 us as it ends, R reads then and answers at 6 us.
    assert reaction(analyze_system(built(writer, reader))) == (6 * US, Claim.EXACT)
