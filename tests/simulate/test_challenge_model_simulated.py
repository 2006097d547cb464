"""The challenge model of 2017 at 300 MHz: nothing is observed beyond its worst-case response times.

The figures are those of the challenge's published solutions and of pyCPA; the greatest response times of a simulation of the worst
cases come from a simulator that shares no code with this one.
"""

import json
from fractions import Fraction
from functools import cache
from importlib.util import find_spec

import pytest
from support import SHARED

from amalthea_uros import Mode, Options, Settings, analyze_system, extract, load
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import SECOND, Duration

MODEL = SHARED / "corpus" / "WATERS_2017_v072.amxmi"
FIGURES = SHARED / "vectors" / "waters2017.json"
VARIANT = "unimore_300MHz_nomem"
#: As machine code, a run takes less than a second; interpreted, it takes as long as one second of the model.
SAMPLED_DURATION = (4 if find_spec("numba") else 1) * SECOND

pytestmark = pytest.mark.skipif(not (MODEL.exists() and FIGURES.exists()), reason="the challenge is not at hand")


@pytest.fixture(scope="module")
def figures():
    return {task["name"]: task for task in json.loads(FIGURES.read_text())["tasks"]}


@pytest.fixture(scope="module")
def system():
    return extract(load(MODEL)).system


@pytest.fixture(scope="module")
def settings(system):
    return Settings(frequencies=dict.fromkeys(system.cores, Fraction(300_000_000)))


@pytest.fixture(scope="module")
def run(system, settings):
    """The simulation in a mode."""

    @cache
    def simulated(mode):
        duration = SAMPLED_DURATION if mode is Mode.SAMPLED else SECOND
        return simulate_system(system, Options(duration=Duration(duration), mode=mode, settings=settings))

    return simulated


def test_sampled_response_times_are_within_the_worst_case(run, figures):
    found = run(Mode.SAMPLED)
    assert len(found.processes) == len(figures)
    for process in found.processes:
        observed = process.response_time.max / US
        assert observed <= figures[process.name]["wcrt_us"][VARIANT]
        # It comes near: cooperative tasks of low priority meet the worst of all others least often.
        assert observed > 0.4 * figures[process.name]["wcrt_us"][VARIANT]


def test_worst_cases_from_time_0_are_those_of_another_simulator(run, figures):
    for process in run(Mode.WORST).processes:
        expected = figures[process.name]["simulated_max_us"][VARIANT]
        assert float(process.response_time.max / US) == pytest.approx(expected, abs=1e-6)


@pytest.fixture(scope="module")
def bounds(system, settings):
    return analyze_system(system, settings)


@pytest.mark.parametrize("mode", [Mode.SAMPLED, Mode.WORST, Mode.BEST, Mode.AVERAGE])
def test_latencies_are_within_the_bounds(run, bounds, mode):
    for chain in run(mode).chains:
        values = {value.quantity: value.value for value in bounds.chains[chain.name].values}
        assert chain.observations > 0
        for quantity, observed in chain.quantities.items():
            assert observed.max <= values.get(f"max_{quantity}", observed.max)
            assert observed.min >= values.get(f"min_{quantity}", observed.min)
