"""The hot loops as machine code give what they give as Python."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.analyze import kernel
from amalthea_uros.compiled import Compiled, compiled

np = pytest.importorskip("numpy")
pytest.importorskip("numba")

ROWS = st.lists(
    st.tuples(st.integers(1, 10**12), st.integers(0, 10**11), st.sampled_from([0, 0, 10**9]), st.integers(0, 10**9)), max_size=6
)


def as_machine_code(function):
    found = Compiled(function.__wrapped__)
    found.compile()
    return found


DEMAND_IN, FIXED_POINT, LEAST_RESPONSE = map(as_machine_code, (kernel.demand_in, kernel.fixed_point, kernel.least_response))


@given(rows=ROWS, window=st.integers(1, 10**13), fixed=st.integers(1, 10**10), data=st.data())
def test_the_same_numbers(rows, window, fixed, data):
    columns = np.array(rows, dtype=np.int64).reshape(-1, 4)
    periods, jitters, distances, costs = (np.ascontiguousarray(columns[:, index]) for index in range(4))
    count, limited = data.draw(st.integers(0, len(rows))), bool(distances.any())
    demand = (window, periods, jitters, distances, costs, count, limited)
    assert DEMAND_IN(*demand) == kernel.demand_in.__wrapped__(*demand)
    point = (fixed, fixed, periods, jitters, distances, costs, count, limited)
    if (costs / periods).sum() < 0.9:
        assert FIXED_POINT(*point) == kernel.fixed_point.__wrapped__(*point)
        least = (fixed, 10 * fixed, periods, costs, count)
        assert LEAST_RESPONSE(*least) == kernel.least_response.__wrapped__(*least)


def test_only_what_is_called_often_is_compiled(monkeypatch):
    monkeypatch.setattr("amalthea_uros.compiled.CALLS_BEFORE", 2)
    seen = []

    @compiled
    def double(number):
        return number * 2

    monkeypatch.setattr(double, "compile", lambda: seen.append("compiled"))
    assert [double(1), double(2), *seen] == [2, 4]
    assert [double(3), *seen] == [6, "compiled"]


def test_without_numba_everything_stays_python(monkeypatch):
    monkeypatch.setattr("amalthea_uros.compiled.find_spec", lambda _: None)

    @compiled
    def double(number):
        return number * 2

    double.compile()
    assert double(2) == 4
