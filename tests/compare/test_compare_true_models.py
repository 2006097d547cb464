"""Logs drawn from within what a model states never contradict it; logs of another system do.

The model states ranges; the logs have values from them that are distributed in quite different ways.
"""

from dataclasses import fields, is_dataclass, replace
from itertools import product
from random import Random

import pytest
from effort import every
from measurements import measurement, series

from amalthea_uros import compare, simulate
from amalthea_uros.perf.distributions import Beta, Boundaries, Bucket, Histogram, Statistics, Uniform
from amalthea_uros.services.subject import open_system
from amalthea_uros.simulate.kernel import machine_code

RANGES = """
amuros: 1
name: ranges
hardware: {platform: single-core}
tasks:
  - {name: Fast, period: 5 ms, priority: 4, execution_time: {min: 100 us, max: 1 ms}, writes: [speed]}
  - {name: Constant, period: 10 ms, priority: 3, execution_time: 1 ms}
  - {name: Middle, period: 10 ms, priority: 2, execution_time: {min: 200 us, max: 3 ms}, reads: [speed], writes: [torque]}
  - {name: Slow, period: 50 ms, priority: 1, execution_time: {min: 1 ms, max: 9 ms}, reads: [torque]}
chains:
  - {name: way, path: [Fast, Middle, Slow]}
"""
EXECUTOR = """
amuros: 1
name: executor
hardware: {platform: single-core}
middleware:
  task_periods: [1 ms, 20 ms]
  executor:
    {name: Executor_Task, period: 1 ms, execution_time: {base: {min: 10 us, max: 80 us}, per_message: {min: 5 us, max: 60 us}}}
application:
  nodes:
    - name: n
      subscriptions:
        - {name: Factor, topic: t, rate: 50 Hz, message_size: 4 B, execution_time: {min: 2 us, max: 50 us}, writes: [factor]}
      timers:
        - {name: Control, period: 1 ms, execution_time: {min: 4 us, max: 90 us}, reads: [factor]}
chains:
  - {name: factor-to-output, path: [Executor_Task, Factor, Control]}
"""
#: What executes between stated bounds with a stated mean.
MEANS = RANGES.replace("max: 1 ms", "avg: 200 us, max: 1 ms").replace("max: 9 ms", "avg: 7 ms, max: 9 ms")


def histogram(*buckets):
    return Histogram(tuple(Bucket(lower=lower, upper=upper, occurrences=count) for lower, upper, count in buckets))


def near_minimum(lower, upper):
    step = (upper - lower) // 50
    return histogram((lower, lower + step, 97), (upper - step, upper, 3))


def at_the_ends(lower, upper):
    return histogram((lower, lower, 1), (upper, upper, 1))


def beta(lower, upper):
    return Beta(alpha=6, beta=1, lower=lower, upper=upper)


def with_mean(lower, average, upper):
    """The two ends only, with a stated mean."""
    share = round(1000 * (average - lower) / (upper - lower))
    return histogram((lower, lower, 1000 - share), (upper, upper, share))


SHAPES = (near_minimum, at_the_ends, beta)


def drawn(item, shape):
    """A part of a system, with another distribution in each range."""
    match item:
        case Boundaries(lower=lower, upper=upper) | Uniform(lower=lower, upper=upper) if lower < upper:
            return shape(lower, upper)
        case Statistics(lower=lower, average=average, upper=upper):
            return with_mean(lower, average, upper)
        case tuple():
            return type(item)(drawn(each, shape) for each in item) if type(item) is tuple else item
    if not is_dataclass(item):
        return item
    return replace(item, **{each.name: drawn(getattr(item, each.name), shape) for each in fields(item) if each.init})


def compared(model, log_of, tmp_path, shape, seed=5, **options):
    """A model compared with a log of a system with another distribution."""
    trace = tmp_path / "run.csv"
    # The executor has 50 times as many jobs.
    duration = "200 ms" if "executor" in model else "1 s"
    simulate(drawn(open_system(log_of).system, shape), duration, seed=seed, trace_paths=[trace])
    return compare(model, trace, **options)


def contradictions(found):
    return [
        (row.object, row.quantity, str(row.statistic), str(row.verdict))
        for row in found.rows
        if row.verdict in ("outside", "refuted")
    ]


@pytest.fixture(autouse=True)
def _interpreted(monkeypatch):
    """To compile the kernel takes longer than all of these runs."""
    monkeypatch.setattr(machine_code, "is_worth_it", lambda _seconds, _left: False)


MODELS = {
    "tasks": RANGES,
    "executor": EXECUTOR,
    "means": MEANS,
    "jitter": RANGES.replace("period: 10 ms, priority: 3", "period: 10 ms, jitter: 4 ms, priority: 3"),
    "sporadic": RANGES.replace("period: 50 ms", "sporadic: {min: 50 ms, max: 90 ms}"),
    "arrivals": EXECUTOR.replace("rate: 50 Hz,", "rate: 50 Hz, jitter: 5 ms,"),
}


@pytest.mark.parametrize(("name", "shape", "seed"), every(7, list(product(MODELS, SHAPES, (5, 6)))))
def test_a_log_from_within_the_stated_ranges_does_not_contradict_them(name, shape, seed, tmp_path):
    found = compared(MODELS[name], MODELS[name], tmp_path, shape, seed)
    assert contradictions(found) == []
    assert found.holds
    assert any(row.verdict == "differs" for row in found.rows)
    assert {row.kind for row in found.compared} == {"process", "runnable", "chain"}


def test_what_does_not_depend_on_the_ranges_is_still_compared_strictly(tmp_path):
    """Slow is below Constant and never delays it; Fast, above it, does."""
    model = RANGES.replace("execution_time: {min: 100 us, max: 1 ms}", "execution_time: 500 us")
    found = compared(model, model.replace("execution_time: 1 ms", "execution_time: 600 us"), tmp_path, at_the_ends)
    assert ("Constant", "response_time", "mean", "outside") in contradictions(found)
    assert ("Constant", "net_execution_time", "mean", "outside") in contradictions(found)


@pytest.mark.parametrize(
    ("was", "now", "expected"),
    [
        # The model states 3 ms at most.
        ("max: 3 ms", "max: 4 ms", ("Middle", "net_execution_time", "max", "refuted")),
        ("min: 1 ms", "min: 100 us", ("Slow", "net_execution_time", "min", "refuted")),
        ("Slow, period: 50 ms", "Slow, period: 100 ms", ("Slow", "activate_to_activate", "max", "refuted")),
    ],
)
def test_what_is_beyond_the_stated_ranges_refutes_them(was, now, expected, tmp_path):
    assert was in RANGES
    found = compared(RANGES, RANGES.replace(was, now), tmp_path, at_the_ends)
    assert expected in contradictions(found)
    assert found.is_failed


def test_a_mean_beside_the_stated_one_is_outside(tmp_path):
    """The model states a mean of 200 us; the log has the middle of the range, 550 us."""
    found = compared(MEANS, RANGES, tmp_path, at_the_ends)
    assert ("Fast", "net_execution_time", "mean", "outside") in contradictions(found)
    assert found.is_failed


def test_a_mean_beside_that_of_a_stated_distribution_is_outside(tmp_path):
    """A histogram with a mean of 280 us; the log has 820 us, within its bounds."""
    buckets = "{histogram: [{min: 100 us, max: 100 us, count: %d}, {min: 1 ms, max: 1 ms, count: %d}]}"
    stated, measured = (RANGES.replace("{min: 100 us, max: 1 ms}", buckets % counts) for counts in ((8, 2), (2, 8)))
    found = compared(stated, measured, tmp_path, at_the_ends)
    assert ("Fast", "net_execution_time", "mean", "outside") in contradictions(found)
    assert contradictions(compared(stated, stated, tmp_path, at_the_ends)) == []


@pytest.mark.parametrize("seed", every(7, range(20)))
def test_a_few_values_of_a_stated_distribution_differ_by_chance(seed):
    """Of 2 %, five or a hundred values often have none: their mean and their extremes are those of chance."""
    random = Random(seed)
    rare = RANGES.replace(
        "{min: 100 us, max: 1 ms}", "{histogram: [{min: 100 us, max: 100 us, count: 98}, {min: 1 ms, max: 1 ms, count: 2}]}"
    )
    for count in (5, 100):
        values = random.choices([100, 1000], [98, 2], k=count)
        found = compare(rare, measurement(series("Fast", "net_execution_time", values)), duration="500 ms")
        assert contradictions(found) == []


# A player that shares no code with the product: two tasks on a core, in steps of 1 us.


def played(low, high, random, draw, jobs=200):
    """The response times of two tasks; of the more urgent one every 5 ms, of the other one every 10 ms, both from 0 on."""
    urgent, other = [], []
    for _ in range(jobs):
        first, second, rest = draw(random, *low), draw(random, *low), draw(random, *high)
        urgent += [first, second]
        # It runs after the first urgent job, and is preempted by the second one.
        end = first + rest
        other.append(end if end <= 5000 else end + second)
        assert end + second < 10_000
    return urgent, other


DRAWS = {
    "ends": lambda random, low, high: random.choice([low, high]),
    "near minimum": lambda random, low, high: low + round((high - low) * random.random() ** 8),
    "beta": lambda random, low, high: round(random.betavariate(8, 2) * (high - low)) + low,
}


@pytest.mark.parametrize(("draw", "seed"), every(4, list(product(DRAWS, range(5)))))
def test_what_another_player_draws_from_the_ranges_does_not_contradict_them(seed, draw):
    model = """
amuros: 1
name: two
hardware: {platform: single-core}
tasks:
  - {name: Urgent, period: 5 ms, priority: 2, execution_time: {min: 100 us, max: 2 ms}}
  - {name: Other, period: 10 ms, priority: 1, execution_time: {min: 500 us, max: 5 ms}}
"""
    urgent, other = played((100, 2000), (500, 5000), Random(seed), DRAWS[draw])
    measured = measurement(series("Urgent", "response_time", urgent), series("Other", "response_time", other))
    found = compare(model, measured)
    assert contradictions(found) == []
    assert found.holds
    assert any(row.verdict == "differs" for row in found.rows)
    # One job of 7.2 ms is beyond all that the model allows: 5 ms, and twice 2 ms after the second activation of Urgent.
    late = measurement(series("Other", "response_time", [*other, 9001]))
    assert ("Other", "response_time", "max", "refuted") in contradictions(compare(model, late))
