"""The metrics of jobs: the thesis's application by hand, and all definitions against plain Python."""

from fractions import Fraction
from itertools import pairwise
from math import sqrt
from statistics import pstdev

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from test_thesis import FIGURE, METRICS, cut

from amalthea_uros.simulate.metrics.distributions import MAX_BINS, BinCounts, MetricDistributions
from amalthea_uros.simulate.metrics.jobs import JobMetrics, add_rows
from amalthea_uros.simulate.observations import CountObservation
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.observed.job_times import BETWEEN, OWN, JobColumn
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS

EXECUTOR, CONTROL = 0, 1


def row(process, instance, activation, start, end, running, waiting=0, polling=0, parking=0, preemptions=0, migrations=0):
    return (process, instance, activation, start, end, running, waiting, polling, parking, preemptions, migrations)


def array(rows):
    return np.array(rows, np.int64).reshape(-1, len(JobColumn))


def observed(rows, deadlines=(None,), base=1):
    metrics = [JobMetrics(base) for _ in deadlines]
    add_rows(array(rows), metrics)
    return [each.observations(deadline) for each, deadline in zip(metrics, deadlines, strict=True)]


def thesis_rows(ticks, long_every=20):
    """Executor: every millisecond for 12 us, 25 us if it takes a message; then the control function for 4 us."""
    for k in range(ticks):
        release, executor = k * MS, (25 if k % long_every == 0 else 12) * US
        yield row(EXECUTOR, k, release, release, release + executor, executor)
        yield row(CONTROL, k, release, release + executor, release + executor + 4 * US, 4 * US)


@pytest.mark.parametrize(("task", "metric"), METRICS)
def test_the_table_of_the_thesis(task, metric):
    """Its means show that one job after the last long period is missing, which makes those of slack and distance a little less."""
    process = {"Executor_Task": EXECUTOR, "Control_Function": CONTROL}[task]
    found = observed(list(thesis_rows(19_999)), deadlines=(MS, MS))[process][metric]
    least, mean, most = FIGURE[task][metric]
    assert (found.min, cut(found.mean / US), found.max) == (int(least) * US, mean, int(most) * US)


def test_extremes_are_found_again():
    found = observed(list(thesis_rows(40)), deadlines=(MS, MS))[CONTROL][JobMetric.START_TO_START]
    # After the long executor job in tick 0 the start is 13 us earlier, in tick 20 it is 13 us later.
    assert (found.min, found.max) == (987 * US, 1013 * US)
    assert (found.at_min.instance, found.at_max.instance) == (1, 20)
    assert found.at_max.time == 20 * MS


def test_a_job_in_all_states():
    # Activated at 100, started at 103, ended at 150; of these 47: 20 running, 8 waiting, 5 polling, 4 parking, so 10 ready.
    (found,) = observed([row(0, 0, 100, 103, 150, 20, 8, 5, 4, 3, 1)], deadlines=(60,))
    assert {metric: int(observation.max) for metric, observation in found.items()} == {
        JobMetric.NET_EXECUTION_TIME: 20 + 8 + 5,
        JobMetric.GROSS_EXECUTION_TIME: 47,
        JobMetric.RESPONSE_TIME: 50,
        JobMetric.INITIAL_PENDING_TIME: 3,
        JobMetric.READY_TIME: 10,
        JobMetric.PREEMPTION_TIME: 3 + 10,
        JobMetric.RUNNING_TIME: 20,
        JobMetric.WAITING_TIME: 8,
        JobMetric.POLLING_TIME: 5,
        JobMetric.PARKING_TIME: 4,
        JobMetric.SLACK_TIME: 10,
        JobMetric.LATENESS: -10,
    }


def test_without_a_deadline_there_is_no_lateness():
    (found,) = observed([row(0, 0, 0, 0, 5, 5)])
    assert not found.keys() & {JobMetric.SLACK_TIME, JobMetric.LATENESS}


def test_a_process_without_jobs_has_no_metrics():
    ran, idle = observed([row(0, 0, 0, 0, 5, 5)], deadlines=(None, 10))
    assert ran
    assert idle == {}


def test_preemptions_and_migrations_are_counted():
    metrics = JobMetrics(1)
    add_rows(array([row(0, 0, 0, 0, 5, 5, preemptions=2), row(0, 1, 9, 9, 20, 5, preemptions=3, migrations=1)]), [metrics])
    assert metrics.preemptions == CountObservation(total=5, min=2, max=3)
    assert metrics.migrations == CountObservation(total=1, min=0, max=1)


def test_units_of_a_clock_are_exact_picoseconds():
    # A tick of 300 MHz takes 10,000/3 ps: with three units in a picosecond, 10,000 units.
    (found,) = observed([row(0, 0, 0, 0, 10_000, 10_000), row(0, 1, 30_000, 30_000, 50_000, 20_000)], base=3)
    response = found[JobMetric.RESPONSE_TIME]
    assert (response.min, response.mean, response.max) == (Fraction(10_000, 3), Fraction(5_000), Fraction(20_000, 3))
    assert response.at_max.time == 10_000
    assert response.std == pytest.approx(5_000 / 3)
    edges = [round(edge) for edge in response.histogram.edges]
    assert len(set(edges)) == len(edges)


def test_the_sum_exceeds_64_bits():
    metrics, end = JobMetrics(3), 3 * 300 * 10**12
    rows = array([row(0, k, 0, end - 7, end, 7) for k in range(50_000)])
    add_rows(rows, [metrics])
    assert metrics.observations(None)[JobMetric.RESPONSE_TIME].mean == 300 * 10**12
    assert metrics.total(JobMetric.RESPONSE_TIME) == 50_000 * end > 2**63


def test_small_variations_of_great_values_have_an_accurate_deviation():
    values = np.array([[10**15 + k % 2 for k in range(10_000)]])
    found = MetricDistributions(size=1, base=1, with_histograms=())
    found.add(values, values[0], values[0])
    assert found.observation(0).std == pytest.approx(0.5)


# All definitions, in plain Python

times = st.integers(0, 2**40)


@st.composite
def jobs(draw):
    """The jobs of three processes in the order of their ends."""
    found = []
    for instance in range(draw(st.integers(0, 20))):
        process, activation, pending = draw(st.integers(0, 2)), draw(times), draw(times)
        states = draw(st.tuples(times, times, times, times, times))
        start = activation + pending
        found.append(row(process, instance, activation, start, start + sum(states), *states[:4], draw(st.integers(0, 9))))
    return sorted(found, key=lambda each: each[JobColumn.END])


def literal(rows):
    found = {metric: [] for metric in (*OWN, *BETWEEN)}
    for _, _, activation, start, end, running, waiting, polling, parking, *_ in rows:
        ready = end - start - running - waiting - polling - parking
        for metric, value in (
            (JobMetric.NET_EXECUTION_TIME, end - start - ready - parking),
            (JobMetric.GROSS_EXECUTION_TIME, end - start),
            (JobMetric.RESPONSE_TIME, end - activation),
            (JobMetric.INITIAL_PENDING_TIME, start - activation),
            (JobMetric.READY_TIME, ready),
            (JobMetric.PREEMPTION_TIME, start - activation + ready),
            (JobMetric.RUNNING_TIME, running),
            (JobMetric.WAITING_TIME, waiting),
            (JobMetric.POLLING_TIME, polling),
            (JobMetric.PARKING_TIME, parking),
        ):
            found[metric].append(value)
    for one, other in pairwise(rows):
        found[JobMetric.ACTIVATE_TO_ACTIVATE].append(other[JobColumn.ACTIVATION] - one[JobColumn.ACTIVATION])
        found[JobMetric.START_TO_START].append(other[JobColumn.START] - one[JobColumn.START])
        found[JobMetric.END_TO_END].append(other[JobColumn.END] - one[JobColumn.END])
        found[JobMetric.END_TO_START].append(other[JobColumn.START] - one[JobColumn.END])
    return found


@given(jobs(), st.lists(st.integers(0, 20)))
def test_all_metrics_are_as_defined_in_any_chunks(rows, cuts):
    metrics = [JobMetrics(1) for _ in range(3)]
    edges = [0, *sorted(cuts), len(rows)]
    for first, end in pairwise(edges):
        add_rows(array(rows[first:end]), metrics)
    for process, each in enumerate(metrics):
        own = [job for job in rows if job[JobColumn.PROCESS] == process]
        found = each.observations(None)
        for metric, values in literal(own).items():
            if not values:
                assert metric not in found
                continue
            one = found[metric]
            assert (one.count, one.min, one.max, one.total) == (len(values), min(values), max(values), sum(values))
            assert one.std == pytest.approx(pstdev(values), rel=1e-6)
            jobs_of_values = own[-len(values) :]
            first = jobs_of_values[values.index(max(values))]
            assert (one.at_max.instance, one.at_max.time) == (first[JobColumn.INSTANCE], first[JobColumn.ACTIVATION])


# Histograms

anything = st.lists(st.integers(-(2**60), 2**60) | st.integers(-50, 50), min_size=1, max_size=50)


def counted(values, cuts=()):
    histogram, edges = BinCounts(), sorted({0, *cuts, len(values)})
    for first, end in pairwise(edges):
        histogram.add(np.array(values[first:end], np.int64), min(values[:end]), max(values[:end]))
    return histogram


@given(anything)
def test_each_value_is_in_its_bin(values):
    histogram = counted(values)
    assert len(histogram.counts) <= MAX_BINS
    for number, count in enumerate(histogram.counts.tolist()):
        start = (histogram.first + number) * histogram.width
        assert count == sum(start <= value < start + histogram.width for value in values)


@given(anything, st.lists(st.integers(1, 49)))
def test_a_histogram_does_not_depend_on_chunks_or_order(values, cuts):
    one, other = counted(values), counted(values[::-1], [cut for cut in cuts if cut < len(values)])
    assert (one.width, one.first, one.counts.tolist()) == (other.width, other.first, other.counts.tolist())


@given(anything)
def test_a_histogram_is_no_coarser_than_needed(values):
    histogram = counted(values)
    digits = str(histogram.width)
    assert digits[0] in "12"
    assert not digits[1:].strip("0")
    if histogram.width > 1:
        narrower = histogram.width // (2 if digits[0] == "2" else 5)
        assert max(values) // narrower - min(values) // narrower >= MAX_BINS


@pytest.mark.parametrize(
    ("span", "width"), [(1023, 1), (1024, 2), (2047, 2), (2048, 10), (10_239, 10), (10_240, 20), (20_479, 20), (20_480, 100)]
)
def test_the_width_of_bins_is_a_round_number_of_units(span, width):
    # 1,024 bins from 0 to the span; 2 * 1,024 and 10 * 1,024 are the first numbers that are too many for a width.
    histogram = BinCounts(unit=3)
    histogram.add(np.array([0, 3 * span + 2]), 0, 3 * span + 2)
    assert histogram.width == 3 * width


def test_the_bins_of_a_clock_of_300_mhz_are_whole_picoseconds():
    (found,) = observed([row(0, k, 0, 0, 10_000 * k, 10_000 * k) for k in range(1, 4000)], base=3)
    histogram = found[JobMetric.RESPONSE_TIME].histogram
    assert histogram.width == 20_000
    assert all(edge.denominator == 1 for edge in histogram.edges)


@given(anything, anything)
def test_merged_distributions_are_those_of_all_values(some, others):
    def distribution(values):
        found = MetricDistributions(size=1, base=1, with_histograms=(0,))
        array = np.array([values], np.int64)
        found.add(array, array[0], array[0])
        return found

    merged, whole = distribution(some), distribution(some + others)
    merged.merge(distribution(others))
    one, other = merged.observation(0), whole.observation(0)
    assert (one.count, one.min, one.mean, one.max) == (other.count, other.min, other.mean, other.max)
    assert one.histogram == other.histogram
    assert one.std == pytest.approx(sqrt(sum((v - other.mean) ** 2 for v in some + others) / one.count), rel=1e-6, abs=1e-3)
