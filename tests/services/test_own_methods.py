"""Methods of users beside the analysis; none of their values decides a verdict."""

from importlib.metadata import EntryPoint

import pytest

import amalthea_uros as amuros
from amalthea_uros.services import own_methods

SYSTEM = amuros.taskset(
    [
        amuros.task(name, period=period, wcet=wcet, bcet=wcet, offset=0, unit="ms")
        for name, period, wcet in (("A", 5, 1), ("B", 10, 2))
    ],
    chains={"a-b": ["A", "B"]},
    priorities="rate monotonic",
)


def method(bounds):
    return amuros.AnalysisMethod("mine", "a paper", lambda _: bounds)


def test_bounds_are_compared_with_the_analysis():
    # A ends after 1 ms, B after 1 + 2 ms; both exact, as all releases are known.
    found = amuros.method_bounds(SYSTEM, [method({"A": "1 ms", "B": "4 ms"})])
    assert [str(row.standing) for row in found.rows] == ["equal", "looser"]
    (refuted,) = amuros.method_bounds(SYSTEM, [method({"B": amuros.Duration.of("2 ms")})]).rows
    assert refuted.standing == "refuted: below the exact value"
    (none,) = amuros.method_bounds(SYSTEM, [method({"a-b.max_data_age": None})]).rows
    assert (none.quantity, none.standing) == ("max_data_age", "no bound")
    assert amuros.method_bounds(SYSTEM, [method({"a-b": "1 s"})]).rows[0].quantity == "max_reaction_time"


def test_the_table_says_that_nothing_follows():
    found = amuros.method_bounds(amuros.analyze(SYSTEM), [method({"B": "4 ms"})])
    assert "No verdict follows from methods of users" in str(found)
    assert found.to_records() == [
        {
            "method": "mine",
            "object": "B",
            "quantity": "response time",
            "value_ps": 4 * 10**9,
            "analyzed_ps": 3 * 10**9,
            "claim": "exact",
            "comparison": "looser",
        }
    ]


METHODS = [method({"A": "1 ms"})]


def test_packages_bring_methods(monkeypatch):
    entry = EntryPoint("mine", f"{__name__}:METHODS", own_methods.GROUP)
    monkeypatch.setattr(own_methods, "installed", lambda group: [entry] if group == "amuros.methods" else [])
    assert [row.object for row in amuros.method_bounds(SYSTEM).rows] == ["A"]


@pytest.mark.parametrize(
    ("bounds", "message"),
    [
        (lambda _: {"A": 5}, "mine: A: the number 5 has no unit"),
        (lambda _: {"C": "5 ms"}, "unknown process or chain"),
        (lambda _: {"a-b.min_first_to_first": "5 ms"}, "unknown latency 'min_first_to_first'"),
        (lambda _: 1 / 0, "the method 'mine' failed: ZeroDivisionError"),
    ],
)
def test_methods_that_fail(bounds, message):
    with pytest.raises(amuros.InvalidArgumentError, match=message):
        amuros.method_bounds(SYSTEM, [amuros.AnalysisMethod("mine", "a paper", bounds)])
