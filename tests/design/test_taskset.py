"""Synthetic task sets: published examples in one line each."""

import pytest

import amalthea_uros as amuros
from amalthea_uros.units import MILLISECOND as MS

#: Pairs of period and execution time, in order of priority, and the worst-case response times.
PUBLISHED = {
    # Burns and Wellings, Real-Time Systems and Programming Languages, process sets B and D
    "Burns and Wellings, set B": ([(16, 4), (40, 5), (80, 32)], [4, 9, 58]),
    "Burns and Wellings, set D": ([(7, 3), (12, 3), (20, 5)], [3, 6, 20]),
    # IEEE Computer 23(4), 1990: above the bound of Liu and Layland, and still schedulable
    "Sha and Goodenough 1990": ([(100, 40), (150, 40), (350, 100)], [40, 80, 300]),
    # RTSS 1990, example 1: the worst response is not that of the first job, and longer than the period
    "Lehoczky 1990": ([(70, 26), (100, 62)], [26, 118]),
}


def worst(system):
    return [process.response.worst for process in amuros.analyze(system).processes]


@pytest.mark.parametrize(("pairs", "expected"), PUBLISHED.values(), ids=PUBLISHED)
def test_published_response_times(pairs, expected):
    assert worst(amuros.taskset(pairs, unit="ms", priorities="rate monotonic")) == [time * MS for time in expected]


def test_deadline_monotonic_priorities():
    # Burns and Wellings, deadline-monotonic example: periods say nothing about the order
    rows = [("a", 20, 5, 3), ("b", 15, 7, 3), ("c", 10, 10, 4), ("d", 20, 20, 3)]
    tasks = [amuros.task(name, period=period, deadline=deadline, wcet=wcet, unit="ms") for name, period, deadline, wcet in rows]
    system = amuros.taskset(reversed(tasks), priorities="deadline monotonic")
    assert sorted(worst(system)) == [3 * MS, 6 * MS, 10 * MS, 20 * MS]
    assert amuros.analyze(system).summary.schedulable is amuros.Schedulable.YES


def test_liu_and_layland_1973_theorem_7():
    # EDF: schedulable exactly if the load is at most 1. With fixed priorities, the second task needs 2.5 + 3 * 1 ms after a release
    # together with the first one, which is a certain miss only if the phases are stated.
    pairs = [(2, 1), (5, 2.5)]
    assert amuros.analyze(amuros.taskset(pairs, unit="ms", policy="EDF")).summary.schedulable == "yes"
    assert amuros.analyze(amuros.taskset(pairs, unit="ms", priorities="rate monotonic")).summary.schedulable == "unknown"
    together = [amuros.task(f"T{p}", period=f"{p} ms", wcet=f"{c} ms", offset=0) for p, c in pairs]
    assert amuros.analyze(amuros.taskset(together, priorities="rate monotonic")).summary.schedulable == "no"


def test_nothing_is_assumed_of_priorities():
    # As the lowest, the first needs 1 + 1 ms, or 4 + 2 ms of 5 ms.
    assert amuros.analyze(amuros.taskset([(5, 1), (10, 1)], unit="ms")).summary.schedulable == "yes"
    analysis = amuros.analyze(amuros.taskset([(5, 2), (10, 4)], unit="ms"))
    assert analysis.summary.schedulable == "unknown"
    assert analysis["T1"].reason == "it has no priority; as the lowest it needs up to 6 ms"


def non_preemptive(**offset):
    """A short task, and a long one that it cannot preempt."""
    long = amuros.task("Long", period="10 ms", wcet="4 ms", priority=1, preemption="non-preemptive", **offset)
    return amuros.taskset([amuros.task("Short", period="10 ms", wcet="1 ms", priority=2, **offset), long])


def test_a_phase_that_nobody_stated_can_be_the_worst_one():
    # Released together, the short task runs first. Just after the long one has started, it waits for that one's 4 ms.
    assert amuros.analyze(non_preemptive(offset=0))["Short"].response.worst == 1 * MS
    assert 5 * MS - 1 <= amuros.analyze(non_preemptive())["Short"].response.worst <= 5 * MS


def test_execution_times_can_be_shorter_unless_stated():
    free, exact = (
        amuros.taskset([amuros.task("A", period="5 ms", wcet="1 ms", priority=1)]),
        amuros.taskset([amuros.task("A", period="5 ms", wcet="1 ms", bcet="1 ms", priority=1)]),
    )
    assert [amuros.analyze(system)["A"].response.best for system in (free, exact)] == [0, MS]


def test_sporadic_tasks_and_jitter():
    # Audsley and others 1993: R = C + J + interference, where jitter brings a second job of A into the window of B
    late = amuros.task("A", period="10 ms", wcet="2 ms", jitter="7 ms", priority=2)
    system = amuros.taskset([late, amuros.task("B", min_distance="20 ms", wcet="2 ms", priority=1)])
    assert amuros.analyze(system)["B"].response.worst == (2 + 2 * 2) * MS
    assert amuros.analyze(system)["B"].deadline == 20 * MS


def chained(communication):
    tasks = [
        amuros.task(name, period="10 ms", wcet="1 ms", bcet="1 ms", offset=0, priority=priority, communication=communication)
        for name, priority in (("A", 2), ("B", 1))
    ]
    return amuros.analyze(amuros.taskset(tasks, chains={"a-b": ["A", "B"]})).chains["a-b"]


def test_chains():
    # From the start of a job of A to the end of the first job of B that used its data. Implicit: B starts when A has ended, after 1 ms.
    # LET: A writes at the end of its period, 10 ms; the job of B that reads it waits 1 ms for A and takes 1 ms.
    first, age = amuros.LatencyQuantity.MIN_FIRST_TO_FIRST, amuros.LatencyQuantity.MAX_REDUCED_DATA_AGE
    assert chained("implicit").value(first).value == 2 * MS
    assert chained("LET").value(first).value == 12 * MS
    assert chained("implicit").value(age).value < chained("LET").value(age).value


def test_several_cores():
    tasks = [amuros.task(name, period="5 ms", wcet="4 ms", core=name, priority=1) for name in ("X", "Y")]
    analysis = amuros.analyze(amuros.taskset(tasks))
    assert analysis.processors.names == ("X", "Y")
    assert [process.response.worst for process in analysis.processes] == [4 * MS, 4 * MS]


def test_a_task_set_can_be_simulated_and_built():
    system = amuros.taskset([(5, 1), (10, 2)], unit="ms", priorities="rate monotonic")
    assert amuros.simulate(system, "100 ms", mode="worst")["T2"].response_time.max == 3 * MS
    assert worst(amuros.build_model(system)) == worst(system)


ROWS = [{"name": "A", "period": 5, "wcet": 1, "priority": 2}, {"name": "B", "period": 10, "wcet": 2.5, "priority": 1}]


def test_rows_of_tables():
    # B waits for one job of A: 2.5 + 1. None and NaN are not stated.
    system = amuros.taskset([row | {"jitter": None, "deadline": float("nan")} for row in ROWS], unit="ms")
    assert worst(system) == [MS, 3.5 * MS]
    assert amuros.analyze(system)["A"].deadline == 5 * MS


def test_data_frames():
    pandas = pytest.importorskip("pandas")
    # Where a priority is missing, pandas makes numbers with a fraction of the others.
    rows = [*ROWS, {"name": "C", "period": 20, "wcet": 1, "core": "other"}]
    found = amuros.analyze(amuros.taskset(pandas.DataFrame(rows).fillna({"core": "main"}), unit="ms"))
    assert [(each.wcrt, each.priority) for each in found.processes] == [(MS, 2), (3.5 * MS, 1), (MS, None)]


def test_numbers_of_numpy():
    numpy = pytest.importorskip("numpy")
    pairs = numpy.array([[5, 1], [10, 2]])
    assert worst(amuros.taskset(pairs, unit="ms", priorities="rate monotonic")) == [MS, 3 * MS]
    a = amuros.task("A", period=numpy.int64(5 * MS), wcet=numpy.float32(1.5), priority=numpy.int64(3), unit="ps")
    assert (type(a.period), a.period, a.wcet, type(a.priority)) == (int, 5 * MS, 2, int)


def test_decimal_numbers_are_those_that_were_written():
    # 1/10 has no finite binary fraction: rounded up, three times 0.1 of 0.3 would be more than all.
    system = amuros.taskset([(0.3, 0.1), (0.3, 0.1), (0.3, 0.1)], unit="ms", priorities="rate monotonic")
    assert worst(system) == [MS // 10, 2 * MS // 10, 3 * MS // 10]


def test_deadlines_after_the_period():
    # Lehoczky 1990, example 1: the worst response is 118, in the fifth job of the busy window
    for deadline, expected in ((118, "yes"), (117, "unknown")):
        system = amuros.taskset([(70, 26), (100, 62, deadline)], unit="ms", priorities="rate monotonic")
        assert amuros.analyze(system).summary.schedulable == expected


def test_critical_sections():
    # Sha, Rajkumar and Lehoczky 1990: blocked at most once, by the longest section of lower priority whose ceiling is not lower.
    # H: 2 + 3; M: 3 + H 2 + 3; L: 5 + 2 + 3. The resource Q of L does not delay H, which is above its ceiling.
    rows = [
        {"name": "H", "period": 10, "wcet": 2, "critical_sections": {"R": 1}},
        {"name": "M", "period": 20, "wcet": 3, "critical_sections": {"Q": 1}},
        {"name": "L", "period": 40, "wcet": 5, "critical_sections": {"R": 3, "Q": "2 ms"}},
    ]
    system = amuros.taskset(rows, unit="ms", priorities="rate monotonic")
    for found, exact in zip(worst(system), (5, 8, 10), strict=True):
        assert exact * MS - 1 <= found <= exact * MS  # blocking begins before the activation
    assert worst(amuros.build_model(system)) == worst(system)


def test_the_period_of_a_task_of_any_phase_can_change():
    # 100 + 2 * 40 + 2 * 40 becomes 100 + 40 + 40
    system = amuros.taskset([(100, 40), (150, 40), (350, 100)], unit="ms", priorities="rate monotonic")
    assert amuros.what_if(system, {"T1.period": "300 ms", "T2.period": "300 ms"}).after["T3"].wcrt == 180 * MS


def a_task(**values):
    return amuros.task("A", **({"wcet": "1 ms"} | values))


WRONG = {
    "no activation": (lambda: a_task(), "A: expected either a period, or the min_distance"),
    "two activations": (lambda: a_task(period="5 ms", min_distance="5 ms"), "either a period"),
    "no unit": (lambda: a_task(period="5"), "A: period: '5' has no unit"),
    "a float": (
        lambda: a_task(period=5.0),
        "period: the number 5.0 has no unit; write a text such as '5.0 ms', or",
    ),
    "period 0": (lambda: a_task(period=0), "period: 0 s is not positive"),
    "a negative time": (lambda: a_task(period="5 ms", offset="-1 ms"), "offset: -1 ms is negative"),
    "bcet above wcet": (lambda: a_task(period="5 ms", bcet="2 ms"), "the bcet 2 ms exceeds the wcet 1 ms"),
    "a sporadic task with jitter": (lambda: a_task(min_distance="5 ms", jitter="1 ms"), "has no offset and no jitter"),
    "LET without offset": (lambda: a_task(period="5 ms", communication="LET"), "need an offset"),
    "an unknown preemption": (lambda: a_task(period="5 ms", preemption="never"), "expected one of preemptive, cooperative"),
    "numbers without unit": (lambda: amuros.taskset([(5, 1)]), "state the unit of all numbers, e.g. unit='ms'"),
    "an unknown unit": (lambda: amuros.taskset([(5, 1)], unit="msec"), "'msec' is not a unit of time; known units: ps"),
    "not a number": (lambda: amuros.taskset([(float("nan"), 1)], unit="ms"), "expected a time such as '10 ms', not nan"),
    "a priority that is a text": (lambda: a_task(period="5 ms", priority="high"), "the priority: expected a whole number"),
    "a priority with a fraction": (lambda: a_task(period="5 ms", priority=1.5), "expected a whole number, not 1.5"),
    "a name that is a number": (lambda: amuros.task(1, period="5 ms", wcet="1 ms"), "the name of a task must be a text"),
    "a core that is a number": (lambda: a_task(period="5 ms", core=0), "A: the core must be a text, not 0"),
    "sections above wcet": (
        lambda: a_task(period="5 ms", critical_sections={"R": "2 ms"}),
        "take 2 ms, more than the wcet 1 ms",
    ),
    "a resource of two cores": (
        lambda: amuros.taskset(
            [amuros.task(c, period="5 ms", wcet="1 ms", core=c, critical_sections={"R": "1 ms"}) for c in "XY"]
        ),
        "the resource 'R' is used on X and Y",
    ),
    "an unknown column": (lambda: amuros.taskset([{"perod": 5, "wcet": 1}], unit="ms"), "'perod'; did you mean 'period'?"),
    "a column that is missing": (lambda: amuros.taskset([{"period": 5}], unit="ms"), "T1: the wcet is missing"),
    "rows without unit": (
        lambda: amuros.taskset([{"period": 5, "wcet": 1}]),
        "or state the unit of all numbers, e.g. unit='ms'",
    ),
    "an unknown policy": (lambda: amuros.taskset([], policy="RM"), "expected one of fixed priority, EDF"),
    "unknown priorities": (lambda: amuros.taskset([], priorities="RM"), "expected one of rate monotonic, deadline mono"),
    "a name twice": (lambda: amuros.taskset([a_task(period="5 ms")] * 2), "duplicate task 'A'"),
    "priorities twice": (
        lambda: amuros.taskset([a_task(period="5 ms", priority=1)], priorities="rate monotonic"),
        "'A' states a priority already",
    ),
    "an undefined task": (
        lambda: amuros.taskset([(5, 1)], unit="ms", chains={"c": ["T1", "T2"]}),
        "chain 'c': undefined task 'T2'; known: T1",
    ),
    "a task twice in a chain": (lambda: amuros.taskset([(5, 1)], unit="ms", chains={"c": ["T1", "T1"]}), "occurs twice"),
    "a chain that is a text": (lambda: amuros.taskset([(5, 1)], unit="ms", chains={"c": "T1"}), "expected a list of tasks"),
}


@pytest.mark.parametrize(("make", "message"), WRONG.values(), ids=WRONG)
def test_wrong_values(make, message):
    with pytest.raises(amuros.InvalidArgumentError) as raised:
        make()
    assert message in str(raised.value)


@pytest.mark.parametrize(
    "given", [None, "ab", {"A": (5, 1)}, [(5,)], [5], amuros.task("A", period="5 ms", wcet="1 ms")], ids=repr
)
def test_what_is_no_task_set(given):
    with pytest.raises(TypeError, match="expected tasks made by task"):
        amuros.taskset(given, unit="ms")
    with pytest.raises(TypeError, match="expected the names of chains"):
        amuros.taskset([(5, 1), (6, 1)], unit="ms", chains=[["T1", "T2"]])
