"""What rules share: exact quantities, graphs, lists of names; and that no rule fails whatever a model lacks."""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros._internal.graphs import bottom_up, circles
from amalthea_uros._internal.plural import counted
from amalthea_uros.metamodel.classes import (
    DataSize,
    DataSizeUnit,
    DiscreteValueBoundaries,
    DiscreteValueConstant,
    DiscreteValueGaussDistribution,
    DiscreteValueHistogram,
    DiscreteValueHistogramEntry,
    Frequency,
    FrequencyDomain,
    ProcessingUnit,
    Task,
    Time,
    TimeBoundaries,
    TimeConstant,
    TimeHistogram,
    TimeHistogramEntry,
)
from amalthea_uros.metamodel.magnitudes import bits, picoseconds
from amalthea_uros.validate.quantities import bounds, clock
from amalthea_uros.validate.wording import joined, listed


@pytest.mark.parametrize(
    ("time", "value"),
    [
        (Time(2, "s"), 2 * 10**12),
        (Time(2, "ms"), 2 * 10**9),
        (Time(2, "us"), 2 * 10**6),
        (Time(2, "ns"), 2000),
        (Time(2, "ps"), 2),
        (Time(-2, "ps"), -2),
        (Time(None, "ms"), 0),
        (Time(2), None),
        (Time(2, "_undefined_"), None),
        (None, None),
    ],
)
def test_times(time, value):
    assert picoseconds(time) == value


@pytest.mark.parametrize(
    ("frequency", "value"),
    [
        (Frequency(0.1, "Hz"), Fraction(1, 10)),
        (Frequency(333.3, "MHz"), Fraction(333_300_000)),
        (Frequency(2.0, "GHz"), Fraction(2 * 10**9)),
        (Frequency(5.0, "kHz"), Fraction(5000)),
        (Frequency(0.0, "MHz"), None),
        (Frequency(-1.0, "MHz"), None),
        (Frequency(float("inf"), "MHz"), None),
        (Frequency(float("nan"), "MHz"), None),
        (Frequency(None, "MHz"), None),
        (Frequency(1.0), None),
        (None, None),
    ],
)
def test_clocks(frequency, value):
    assert clock(ProcessingUnit(frequency_domain=FrequencyDomain(default_value=frequency))) == value


def test_every_unit_of_data_has_a_size():
    assert [unit for unit in DataSizeUnit if bits(DataSize(1, unit)) is None] == [DataSizeUnit.UNDEFINED]


@pytest.mark.parametrize(
    ("size", "value"),
    [
        (DataSize(1, "B"), 8),
        (DataSize(1, "kB"), 8000),
        (DataSize(1, "KiB"), 8192),
        (DataSize(3, "bit"), 3),
        (DataSize(3), None),
        (None, None),
    ],
)
def test_sizes(size, value):
    assert bits(size) == value


@pytest.mark.parametrize(
    ("deviation", "expected"),
    [
        (DiscreteValueConstant(value=3), (3, 3)),
        (DiscreteValueConstant(), (0, 0)),
        (DiscreteValueBoundaries(lower_bound=2, upper_bound=5), (2, 5)),
        (DiscreteValueGaussDistribution(upper_bound=5), (None, 5)),
        (
            DiscreteValueHistogram(
                entries=[
                    DiscreteValueHistogramEntry(lower_bound=4, upper_bound=5),
                    DiscreteValueHistogramEntry(lower_bound=2, upper_bound=3),
                ]
            ),
            (2, 5),
        ),
        (DiscreteValueHistogram(), (None, None)),
        (TimeConstant(value=Time(1, "ns")), (1000, 1000)),
        (TimeConstant(), (None, None)),
        (TimeBoundaries(lower_bound=Time(1, "ns"), upper_bound=Time(1, "us")), (1000, 10**6)),
        # An entry of which nothing is known may go beyond all others.
        (TimeHistogram(entries=[TimeHistogramEntry(lower_bound=Time(1, "ns")), TimeHistogramEntry()]), (None, None)),
        (None, (None, None)),
    ],
)
def test_bounds(deviation, expected):
    assert bounds(deviation) == expected


def test_lists():
    assert joined([]) == ""
    assert joined(["a"]) == "a"
    assert joined(["a", "b", "c"]) == "a, b and c"
    assert joined("abcdef", most=6) == "a, b, c, d, e and f"
    assert joined("abcdefg", most=5) == "a, b, c, d, e and 2 more"
    assert listed([Task(name="T"), Task()]) == "'T' and ''"


@pytest.mark.parametrize(("number", "text"), [(0, "0 ports"), (1, "1 port"), (2, "2 ports")])
def test_numbers_with_a_noun(number, text):
    assert counted(number, "port") == text


GRAPHS = st.dictionaries(st.integers(0, 7), st.lists(st.integers(0, 7), max_size=3), max_size=8)


def reached(start, graph):
    """Everything that a number leads to."""
    found, pending = set(), [start]
    while pending:
        for part in graph.get(pending.pop(), ()):
            if part not in found:
                found.add(part)
                pending.append(part)
    return found


@given(GRAPHS, st.lists(st.integers(0, 7), max_size=3))
def test_parts_come_before_wholes(graph, starts):
    order = bottom_up(starts, lambda item: graph.get(item, []))
    assert len(order) == len(set(order))
    assert set(order) == set(starts).union(*(reached(start, graph) for start in starts))
    for position, item in enumerate(order):
        for part in graph.get(item, []):
            # Only in a circle a part may come later.
            assert order.index(part) < position or item in reached(part, graph) | {part}


@given(GRAPHS)
def test_circles_are_what_leads_back_to_itself(graph):
    found = circles(range(8), lambda item: graph.get(item, []))
    back = {item: {other for other in reached(item, graph) if item in reached(other, graph)} for item in range(8)}
    assert {frozenset(circle) for circle in found} == {frozenset(circle) for circle in back.values() if circle}
    assert sum(map(len, found)) == sum(bool(circle) for circle in back.values())
