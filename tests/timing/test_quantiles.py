"""Unbounded normal distributions, cut off at quantiles that the user states."""

from dataclasses import replace
from fractions import Fraction

import pytest
from hand_made_systems import Proc, system

import amalthea_uros as amuros
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Demand, Execute
from amalthea_uros.perf.distributions import Gauss, Uniform
from amalthea_uros.report.wording.closing_line import closing_line
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.timing.demand.quantiles import bounded
from amalthea_uros.units import MICROSECOND as US


@pytest.mark.parametrize(
    ("probability", "distance"),
    # One-sided quantiles of the standard normal distribution as published: 1.281552, 2.326348, 5.997807.
    [("0.1", 1.281552), ("0.01", 2.326348), ("1e-9", 5.997807)],
)
def test_the_bounds_are_quantiles_rounded_outwards(probability, distance):
    found = bounded(Gauss(mean=10**9, deviation=10**6), Fraction(probability))
    assert 10**9 + distance * 10**6 - 1 <= found.upper <= 10**9 + distance * 10**6 + 2
    assert found.lower + found.upper == 2 * 10**9


def test_stated_bounds_and_other_distributions_stay():
    assert bounded(Gauss(mean=10, deviation=1, upper=11), Fraction(1, 100)).upper == 11
    assert bounded(Gauss(mean=1, deviation=5), Fraction(1, 100)).lower == 0
    assert bounded(Uniform(lower=1, upper=9), Fraction(1, 100)) == Uniform(lower=1, upper=9)


GAUSS = (Execute(demand=Demand(Gauss(mean=100, deviation=10))),)


def test_only_who_states_a_quantile_gets_bounds():
    built = system(Proc("T", GAUSS, 1000, priority=1))
    unknown = analyze_system(built).processes["T"]
    assert (unknown.verdict, unknown.reason.split(";")[0]) == ("unknown", "a distribution of ticks has no bounds")
    analysis = analyze_system(built, Settings(quantile=Fraction("0.01")))
    # 100 ticks plus 23.26 at 1 MHz.
    assert (analysis.processes["T"].wcrt, analysis.processes["T"].verdict) == (124 * US, "met")
    assert any("a probability of 0.01 each" in sentence for sentence in analysis.assumptions)
    said = "Schedulable: yes, if no execution time is beyond its quantile of 0.01 (--quantile); tightest: T"
    assert closing_line(analysis.summary).startswith(said)


def test_the_simulation_stays_within_the_bounds():
    built, settings = system(Proc("T", GAUSS, 1000, priority=1)), Settings(quantile=Fraction("0.2"))
    seen = amuros.simulate(built, "1 s", settings=settings).processes["T"].response_time
    bound = analyze_system(built, settings).processes["T"]
    assert bound.bcrt <= seen.min <= seen.max <= bound.wcrt


@pytest.mark.parametrize("probability", [Fraction(0), Fraction(1, 2), Fraction(2)])
def test_a_probability_is_between_0_and_one_half(probability):
    with pytest.raises(ValueError, match="quantile"):
        replace(Settings(), quantile=probability)
