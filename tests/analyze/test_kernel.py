"""The hot loops as machine code give what they give as Python."""

import dataclasses

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from amalthea_uros._internal.compiled import Compiled, compiled
from amalthea_uros.analyze.response_times import kernel, schedule
from amalthea_uros.analyze.response_times.schedule import PeriodicTask
from amalthea_uros.timing.demand.multiframe import DemandFrame, MultiframeDemand

np = pytest.importorskip("numpy")
pytest.importorskip("numba")

ROWS = st.lists(
    st.tuples(st.integers(1, 10**12), st.integers(0, 10**11), st.sampled_from([0, 0, 10**9]), st.integers(0, 10**9)), max_size=6
)


def as_machine_code(function):
    found = Compiled(function.__wrapped__, cost=1)
    found.compile()
    return found


LOOPS = (kernel.demand_in, kernel.least_fixed_point, kernel.greatest_fixed_point, kernel.dispatch)
DEMAND_IN, LEAST_FIXED_POINT, GREATEST_FIXED_POINT, DISPATCH = map(as_machine_code, LOOPS)


@given(rows=ROWS, window=st.integers(1, 10**13), fixed=st.integers(1, 10**10), data=st.data())
def test_the_same_numbers(rows, window, fixed, data):
    columns = np.array(rows, dtype=np.int64).reshape(-1, 4)
    periods, jitters, distances, demands = (np.ascontiguousarray(columns[:, index]) for index in range(4))
    count, limited = data.draw(st.integers(0, len(rows))), bool(distances.any())
    demand = (window, periods, jitters, distances, demands, count, limited)
    assert DEMAND_IN(*demand) == kernel.demand_in.__wrapped__(*demand)
    point = (fixed, fixed, periods, jitters, distances, demands, count, limited)
    if (demands / periods).sum() < 0.9:
        assert LEAST_FIXED_POINT(*point) == kernel.least_fixed_point.__wrapped__(*point)
        least = (fixed, 10 * fixed, periods, demands, count)
        assert GREATEST_FIXED_POINT(*least) == kernel.greatest_fixed_point.__wrapped__(*least)


@given(
    rows=st.lists(
        st.tuples(st.sampled_from([4, 6, 10, 12]), st.integers(0, 7), st.integers(0, 3), st.integers(1, 3), st.integers(0, 2)),
        min_size=1,
        max_size=4,
    )
)
def test_the_same_schedule(rows):
    tasks = [
        PeriodicTask(
            name=str(index),
            period=period,
            offset=offset,
            demand=MultiframeDemand(
                (DemandFrame(worst=wcet, best=wcet), DemandFrame(worst=1, best=0, prescaler=prescaler, offset=start))
            ),
            priority=-index // 2,
        )
        for index, (period, offset, wcet, prescaler, start) in enumerate(rows)
    ]
    assume(sum(task.demand.mean_worst / task.period for task in tasks) <= 1)
    recorded = [index % 2 == 0 for index in range(len(tasks))]
    found = []
    for function in (Compiled(kernel.dispatch.__wrapped__, 0), DISPATCH):
        schedule.dispatch = function
        found.append(schedule.schedule(tasks, 100, MultiframeDemand.worst_of, recorded))
    schedule.dispatch = kernel.dispatch
    for python, machine, task, is_recorded in zip(*found, tasks, recorded, strict=True):
        assert [column.tolist() for column in dataclasses.astuple(python)] == [c.tolist() for c in dataclasses.astuple(machine)]
        if is_recorded:
            executed = [0] * len(python.releases)
            for job, begin, end in python.execution_slices.tolist():
                executed[job] += end - begin
            assert executed == [task.demand.worst_of(job + 1) for job in range(len(executed))]


@pytest.mark.parametrize(
    ("is_kept", "cost", "calls"),
    # New machine code pays after 2.5 s of work, and what is kept from an earlier run after half a second.
    [(False, 1_000_000, 3), (True, 400_000, 2)],
)
def test_only_what_is_used_much_is_compiled(monkeypatch, is_kept, cost, calls):
    monkeypatch.setattr("amalthea_uros._internal.machine_code.CompilationEffort.is_kept", lambda _: is_kept)

    @compiled(cost=cost)
    def double(number):
        return number * 2

    seen = []
    monkeypatch.setattr(double, "compile", lambda: seen.append("compiled"))
    assert all(double(number) == 2 * number for number in range(1, calls))
    assert not seen
    assert (double(calls), seen) == (2 * calls, ["compiled"])


def test_without_numba_everything_stays_python(monkeypatch):
    monkeypatch.setattr("amalthea_uros._internal.machine_code.find_spec", lambda _: None)

    @compiled(cost=10**9)
    def double(number):
        return number * 2

    double.compile()
    assert (double(2), double.is_compiled) == (4, False)
