"""What processes need on each kind of core, if the model does not say which one executes them."""

from dataclasses import replace
from fractions import Fraction

from hand_made_systems import Proc, system, ticks

from amalthea_uros.analyze.needs import WITHOUT_WAITS
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Demand, Execute, WaitEvent, Waiting
from amalthea_uros.perf.distributions import Constant
from amalthea_uros.perf.hardware import Clock, Core, Hardware, Structure
from amalthea_uros.perf.mapping import Mapping
from amalthea_uros.report.documents.needs import needs_table
from amalthea_uros.units import MICROSECOND as US

#: Two kinds of cores at 1 MHz and 2 MHz, of which one has two cores, and one whose clock is not stated.
CLOCKS = (Clock(name="1 MHz", frequency=Fraction(10**6)), Clock(name="2 MHz", frequency=Fraction(2 * 10**6)), Clock(name="?"))
CORES = (
    Core(name="c0", type="small", clock="1 MHz"),
    Core(name="c1", type="small", clock="1 MHz"),
    Core(name="c2", type="big", clock="2 MHz"),
    Core(name="c3", type="big", clock="?"),
)
HARDWARE = Hardware(clocks=CLOCKS, structures=(Structure(name="ECU", cores=CORES),))


def unallocated(*processes, hardware=HARDWARE):
    return replace(system(*processes), hardware=hardware, mapping=Mapping())


def needs(built, name="T"):
    return analyze_system(built).processes[name].needs


def on(found):
    """The type of each kind with best, mean and worst, and the load or the least clock."""
    return [
        (each.core_type, len(each.cores), each.best, each.mean, each.worst, each.load, each.least_frequency) for each in found
    ]


def test_an_execution_time_and_a_load_on_each_kind_of_core():
    # 10 to 30 ticks every 100 us.
    assert on(needs(unallocated(Proc("T", (ticks(30, best=10),), 100)))) == [
        ("small", 2, 10 * US, 20 * US, 30 * US, Fraction(30, 100), None),
        ("big", 1, 5 * US, 10 * US, 15 * US, Fraction(15, 100), None),
        # 30 ticks per 100 us are 300,000 per second.
        ("big", 1, 10, 20, 30, None, 300_000),
    ]


def test_ticks_that_depend_on_the_type_of_core():
    body = (Execute(demand=Demand(Constant(8), by_core_type=(("big", Constant(4)),))),)
    assert [each.worst for each in needs(unallocated(Proc("T", body, 100)))] == [8 * US, 2 * US, 4]
    assert [(each.core_type, each.worst) for each in needs(unallocated(Proc("T", body, 100), hardware=Hardware()))] == [
        (None, 8),
        ("big", 4),
    ]


def test_a_type_without_ticks_is_unknown_there():
    body = (Execute(demand=Demand(None, by_core_type=(("big", Constant(4)),))),)
    small, *_ = needs(unallocated(Proc("T", body, 100)))
    assert (small.worst, small.reason) == (None, "ticks have no value for the core 'c0'")


def test_without_a_rate_there_is_no_load():
    assert on(needs(unallocated(Proc("T", (ticks(30),)), hardware=Hardware()))) == [(None, 0, 30, 30, 30, None, None)]


def test_who_waits_passively_executes_the_rest():
    # A wait that may keep the core adds an unknown load.
    for waiting, load in ((Waiting.PASSIVE, Fraction(3, 100)), (Waiting.ACTIVE, None), (None, None)):
        body = (ticks(1), WaitEvent(events=("go",), waiting=waiting), ticks(2))
        first, *_ = needs(unallocated(Proc("T", body, 100)))
        assert (first.worst, first.load, first.reason) == (3 * US, load, WITHOUT_WAITS)


def test_a_known_core_needs_no_alternatives():
    assert needs(system(Proc("T", (ticks(3),), 100, priority=1))) == ()


def test_together_they_need_the_sum():
    built = unallocated(Proc("A", (ticks(30),), 100), Proc("B", (ticks(50),), 200))
    rows = [row[1:] for row in needs_table(analyze_system(built).processes).rows if row[0] == "together"]
    # 30 % + 25 %, half of that at 2 MHz, and 300,000 + 250,000 ticks per second.
    assert [(row[0], row[6]) for row in rows] == [("small", "55 %"), ("big", "27.5 %"), ("big", "100 % at 550 kHz")]
