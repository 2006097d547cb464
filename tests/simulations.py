"""A simulation made by hand: two tasks and a chain of the thesis's application, 300 jobs each."""

from fractions import Fraction

from amalthea_uros._internal.by_name import Results
from amalthea_uros.simulate.observations import (
    ChainObservation,
    CoreObservation,
    CountObservation,
    MetricObservation,
    ObservedOccurrence,
    ProcessObservation,
    RouteObservation,
    TimeHistogram,
)
from amalthea_uros.simulate.options import Mode
from amalthea_uros.simulate.results import ObservedVerdict, Simulation
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import SECOND


def observation(low, mean, high, histogram=None):
    """300 values in picoseconds; the least one in job 0, the greatest one in job 20."""
    return MetricObservation(
        count=300,
        min=Fraction(low),
        mean=Fraction(mean),
        max=Fraction(high),
        std=2.5 * US,
        at_min=ObservedOccurrence(instance=0, time=Fraction(0)),
        at_max=ObservedOccurrence(instance=20, time=Fraction(20 * MS)),
        histogram=histogram,
    )


def process(name, response, **others):
    running = observation(4 * US, 4 * US, 4 * US)
    values = {
        "is_isr": False,
        "core": "Core",
        "priority": 1,
        "jobs": 300,
        "load": Fraction(4, 1000),
        "metrics": {JobMetric.RESPONSE_TIME: observation(*response), JobMetric.RUNNING_TIME: running},
        "preemptions": CountObservation(total=7, min=0, max=2),
        "migrations": CountObservation(total=0, min=0, max=0),
    }
    return ProcessObservation(name=name, **(values | others))


EXECUTOR = process(
    "Executor",
    (12 * US, 12_650_000, 25 * US),
    load=Fraction(127, 10_000),
    deadline=MS,
    is_implicit=True,
    verdict=ObservedVerdict.OK,
)
CONTROL = process("Control", (16 * US, 16_650_000, 29 * US), deadline=MS, verdict=ObservedVerdict.OK)


def latencies(low, reaction, age):
    histogram = TimeHistogram(start=Fraction(0), width=Fraction(10 * MS), counts=(100, 200))
    return {
        ChainQuantity.REDUCED_REACTION_TIME: observation(low * MS, 10_516_650_000, reaction * MS, histogram),
        ChainQuantity.REDUCED_DATA_AGE: observation(low * MS, 20_016_650_000, age * MS),
    }


ROUTE = RouteObservation(
    text="Executor_start -[data memory]-> Control_finish",
    quantities=latencies(1, 20, 39),
    stimuli=301,
    responses=900,
    unanswered=1,
    longest_unanswered=Fraction(2 * MS),
)
CHAIN = ChainObservation(name="way", quantities=ROUTE.quantities, routes=(ROUTE,))
SIMULATION = Simulation(
    duration=300 * SECOND,
    seed=7,
    mode=Mode.SAMPLED,
    cores=Results([CoreObservation(name="Core", load=Fraction(167, 10_000)), CoreObservation(name="Idle", load=Fraction(0))]),
    processes=Results([EXECUTOR, CONTROL]),
    chains=Results([CHAIN]),
    assumptions=("registers keep the last value",),
)
