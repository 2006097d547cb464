"""The figures of the source case.

S. R. Bappanadu, "Modeling and Timing Analysis of Micro-ROS Application on an Off-Road Vehicle Control Unit", University of Stuttgart,
2022.
"""

from fractions import Fraction
from importlib.util import find_spec
from math import sqrt

import pytest
from support import ROOT

from amalthea_uros import describe
from amalthea_uros.design.changes.change import parse_sweep
from amalthea_uros.services.simulate import simulate, simulate_campaign
from amalthea_uros.simulate.kernel import machine_code
from amalthea_uros.simulate.options import Options
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import Duration

ADVANCED = ROOT / "samples" / "bodas-test-advanced.yaml"
#: For values that the description cannot have: it would refuse the phases.
MODEL = ADVANCED.with_suffix(".amxmi")
SIMPLE = ROOT / "samples" / "bodas-test-simple.yaml"

#: Figure 6.6, in microseconds: minimum, mean, maximum.
FIGURE = {
    "Executor_Task": {
        JobMetric.NET_EXECUTION_TIME: ("12", "12.650", "25"),
        JobMetric.GROSS_EXECUTION_TIME: ("12", "12.650", "25"),
        JobMetric.RESPONSE_TIME: ("12", "12.650", "25"),
        JobMetric.PREEMPTION_TIME: ("0", "0.000", "0"),
        JobMetric.INITIAL_PENDING_TIME: ("0", "0.000", "0"),
        JobMetric.START_TO_START: ("1000", "1000.000", "1000"),
        JobMetric.SLACK_TIME: ("975", "987.349", "988"),
    },
    "Control_Function": {
        JobMetric.NET_EXECUTION_TIME: ("4", "4.000", "4"),
        JobMetric.GROSS_EXECUTION_TIME: ("4", "4.000", "4"),
        JobMetric.RESPONSE_TIME: ("16", "16.650", "29"),
        JobMetric.PREEMPTION_TIME: ("12", "12.650", "25"),
        JobMetric.INITIAL_PENDING_TIME: ("12", "12.650", "25"),
        JobMetric.START_TO_START: ("987", "999.999", "1013"),
        JobMetric.SLACK_TIME: ("971", "983.349", "984"),
    },
}
#: The jobs of five minutes, without the one that ends with them: with it, 15,000 of 300,000 jobs take a message, and the mean slack
#: times are 987.350 and 983.350 us. So the figures are those of 299,999 jobs, and digits after the third one are cut off.
JOBS = 299_999


@pytest.fixture
def interpreted(monkeypatch):
    monkeypatch.setattr(machine_code, "is_worth_it", lambda _seconds, _left: False)


def mean(metric, task, jobs):
    """The mean over the first jobs in microseconds, if the first job takes a message, and then every 20th one."""
    executing = Fraction(12 * jobs + 13 * -(-jobs // 20), jobs)
    is_executor = task == "Executor_Task"
    # The control function starts when the executor ends: after 25 us in the first job, after 25 or 12 us in the last one.
    last, first = (25 if jobs % 20 == 1 else 12), 25
    return {
        JobMetric.NET_EXECUTION_TIME: executing if is_executor else Fraction(4),
        JobMetric.GROSS_EXECUTION_TIME: executing if is_executor else Fraction(4),
        JobMetric.RESPONSE_TIME: executing if is_executor else executing + 4,
        JobMetric.PREEMPTION_TIME: Fraction(0) if is_executor else executing,
        JobMetric.INITIAL_PENDING_TIME: Fraction(0) if is_executor else executing,
        JobMetric.START_TO_START: Fraction(1000) if is_executor else 1000 + Fraction(last - first, jobs - 1),
        JobMetric.SLACK_TIME: 1000 - (executing if is_executor else executing + 4),
    }[metric]


def cut(microseconds):
    """Three decimals, the others cut off."""
    thousandths = int(microseconds * 1000)
    return f"{thousandths // 1000}.{thousandths % 1000:03d}"


METRICS = [(task, metric) for task, metrics in FIGURE.items() for metric in metrics]


@pytest.mark.parametrize(("task", "metric"), METRICS)
def test_the_means_of_figure_6_6_are_those_of_299999_jobs(task, metric):
    assert cut(mean(metric, task, JOBS)) == FIGURE[task][metric][1]


def check_figure(simulation, jobs):
    """The extremes are those of the figure; the means are those of so many jobs."""
    for task, metric in METRICS:
        found, (least, _, most) = simulation[task].metrics[metric], FIGURE[task][metric]
        assert (found.min, found.max) == (int(least) * US, int(most) * US), (task, metric)
        assert found.mean == mean(metric, task, jobs) * US, (task, metric)


def test_figure_6_6_in_a_short_run(interpreted):
    """The message comes in the first job: the mean distance of two starts is below 1 ms if the first job is longer than the last."""
    jobs = 999
    simulation = simulate(ADVANCED, Duration(jobs * MS), changes=["Message_Factor.phase=0ms"])
    assert [simulation[task].jobs for task in FIGURE] == [jobs, jobs]
    check_figure(simulation, jobs)


@pytest.mark.early
@pytest.mark.skipif(find_spec("numba") is None, reason="five minutes take long without numba")
def test_figure_6_6():
    simulation = simulate(ADVANCED, Duration(JOBS * MS), changes=["Message_Factor.phase=0ms"])
    check_figure(simulation, JOBS)
    for task, metric in METRICS:
        assert cut(simulation[task].metrics[metric].mean / US) == FIGURE[task][metric][1]
    # 1.27 % and 0.40 %.
    loads = [round(float(simulation[task].load) * 100, 2) for task in FIGURE]
    assert loads == [1.27, 0.40]
    # With the last job, the means are those of an endless run.
    whole = simulate(ADVANCED, "300 s", changes=["Message_Factor.phase=0ms"])
    slack = [whole[task].metrics[JobMetric.SLACK_TIME].mean for task in FIGURE]
    assert slack == [987_350_000, 983_350_000]
    assert whole["Executor_Task"].load == Fraction(1265, 100_000)


def test_the_simple_model(interpreted):
    """Figure 6.5, table 6.1."""
    response = simulate(SIMPLE, "100 ms")["Control_Function"].metrics[JobMetric.RESPONSE_TIME]
    assert (response.min, response.mean, response.max) == (16 * US, 16 * US, 16 * US)


# Table 6.5: measured on the controller, while the phase of the message against the tasks went through 0 to 20 ms.

MEASURED = (970, 10320, 19978)


def swept(path, sweep):
    """The minimum, the mean and the maximum of the latency over all runs of a sweep, in microseconds."""
    options, chain = Options(duration=Duration(100 * MS)), f"factor-to-output.{ChainQuantity.REDUCED_REACTION_TIME}"
    rows = simulate_campaign(path, options, sweeps=[parse_sweep(sweep)], workers=1).rows
    lows, means, highs = ([row[f"{chain}.{column}_ps"] for row in rows] for column in ("min", "avg", "max"))
    return min(lows) / US, sum(means) / len(means) / US, max(highs) / US


@pytest.mark.parametrize(
    ("ends", "expected"),
    [
        # In the best case the callback runs in the millisecond of the message, in the worst one it waits for 19 ms; then comes the next
        # control function, after the executor that takes the next message in the worst case. Means are in the middle of the phases:
        # 1 ... 20 ms, and from start to finish 16 us, or 29 us in the one phase in which the next message is in the way.
        ("", (1016, 10_516.65, 20_029)),
        # Without the executor job, 25 us.
        ("from: finish, ", (991, 10_491.65, 20_004)),
        # And without what is before the end of the control function: the definition with the least deviation.
        ("from: finish, to: activation, ", (975, 10_475, 19_975)),
    ],
)
def test_table_6_5_over_all_phases(ends, expected, tmp_path, interpreted):
    path = tmp_path / "app.yaml"
    path.write_text(ADVANCED.read_text().replace("reaction: 25 ms", f"{ends}reaction: 25 ms"))
    found = swept(path, "Message_Factor.phase=0ms..19ms/1ms")
    assert found == pytest.approx(expected)
    deviations = [abs(value / measured - 1) for value, measured in zip(found, MEASURED, strict=True)]
    assert max(deviations) < 0.05


def test_table_6_5_swept_in_steps_of_half_a_millisecond(interpreted):
    """A message that comes between two activations of the executor waits for the next one; the chain begins there."""
    assert swept(MODEL, "Message_Factor.phase=0.5ms..20ms/0.5ms") == pytest.approx((1016, 10_516.65, 20_029))


def test_table_6_5_with_an_agent_that_drifts(interpreted):
    """Every 20.05 ms: of 400 messages, 20 are taken in each phase of the tasks, and the latencies are 1 ... 20 ms and 16 us.

    A message that waits for 20 ms is late by 13 us, because the executor takes the next one 20 ms later, except for the last one of
    these 20, after which the phase changes.
    """
    changes = ["Message_Factor.phase=0ms", "Message_Factor.arrival_period=20.05ms"]
    chain = simulate(MODEL, Duration(400 * 20_050 * US), changes=changes).chains[0]
    latency = chain.quantities[ChainQuantity.REDUCED_REACTION_TIME]
    assert (latency.count, latency.min, latency.max) == (400, 1016 * US, 20_029 * US)
    assert latency.mean == (10_516 + Fraction(13 * 19, 400)) * US


def test_table_6_5_with_an_agent_that_jitters(interpreted):
    """Each message comes at any time of its 20 ms: the latencies are 1 ... 20 ms, each with the same probability."""
    duration, seed = Duration(8_000 * MS), 3
    chain = simulate(ADVANCED, duration, seed=seed, changes=["Message_Factor.arrival_jitter=20ms"]).chains[0]
    latency = chain.quantities[ChainQuantity.REDUCED_REACTION_TIME]
    # The deviation of the mean of n values that are uniform over 20 ms.
    assert float(latency.mean / US) == pytest.approx(10_516.65, abs=4 * 20_000 / sqrt(12 * latency.count))
    assert (latency.min, latency.max) == (1016 * US, 20_029 * US)
    histogram = latency.histogram
    starts = [histogram.start + number * histogram.width for number in range(len(histogram.counts))]
    bins = list(zip(starts, histogram.counts, strict=True))
    per_millisecond = [sum(count for start, count in bins if round(start / MS) == k) for k in range(1, 21)]
    assert sum(per_millisecond) == latency.count
    expected = latency.count / 20
    # Four standard deviations of the number of messages in one of 20 phases.
    assert all(abs(count - expected) < 4 * sqrt(expected) for count in per_millisecond)


def test_the_chain_starts_where_the_executor_takes_the_message():
    """The description says so by its first element."""
    chain = describe(ADVANCED).system.events.chains[0]
    assert chain.stimulus == "Executor_Task_start"
