"""Sensitivity where a latency does not grow with the execution times."""

from dataclasses import replace
from fractions import Fraction

import pytest
from test_chain_systems import END, START, at, read, system, ticks, write

from amalthea_uros.analyze.sensitivity import sensitivity
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.constraints import Constraints, LatencyConstraint, LatencyKind
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import MICROSECOND as US


def test_a_factor_covers_all_smaller_ones():
    # Reader starts after Other, 3 us and the time of Other after each release of Writer, which writes after 4 us. While Other takes
    # less than 1 us, Reader misses the data and uses them 10 us later, after 13 us + Other + 0.1 us: above 0.7 us, that is more than
    # 13.8 us. From 1 us on, the latency is short again.
    built = system(
        [
            ("Writer", 100, [ticks(40), write("x")], "one", 0),
            ("Other", 100, [ticks(5)], "two", 30),
            ("Reader", 100, [read("x"), ticks(1)], "two", 30),
        ],
        (at("Writer", START), at("Reader", END)),
        cores=("one", "two"),
        unit=US // 10,
    )
    limit = LatencyConstraint(name="limit", chain="chain", kind=LatencyKind.REACTION, maximum=138 * US // 10)
    built = replace(built, constraints=Constraints(constraints=(limit,)))
    analysis = analyze_system(built)
    assert [str(each.verdict) for each in analysis.requirements] == ["met"]
    assert analyze_system(built, Settings(factors={"Other": Fraction(8, 5)})).summary.schedulable != "yes"
    assert float(sensitivity(analysis).processes["Other"]) == pytest.approx(1.4, rel=2e-3)
