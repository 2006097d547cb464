"""Constraints on events: values of occurrences made by hand, and of random ones against the definitions."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.perf.constraints import DelayConstraint, EventSynchronization, Matching, RepetitionConstraint
from amalthea_uros.simulate.metrics.event_constraints import AllOccurrences, Repetitions, SubsequentOccurrences, delays


def observed(metrics, occurrences, end, sizes=(1000,)):
    """The quantities of a constraint by occurrences (time, event), given in chunks that do not divide an instant."""
    rows = sorted(occurrences)
    while rows:
        size = sizes[0]
        sizes = (*sizes[1:], size)
        chunk = [row for row in rows if row[0] <= rows[min(size, len(rows)) - 1][0]]
        rows = rows[len(chunk) :]
        times, which = np.array(chunk, np.int64).T
        metrics.add(times, which)
    return list(metrics.quantities(end))


def each(event, *times):
    return [(time, event) for time in times]


#: Occurrences of up to three events, and sizes of chunks.
OCCURRENCES = st.lists(st.tuples(st.integers(0, 40), st.integers(0, 1)), max_size=14)
OF_THREE = st.lists(st.tuples(st.integers(0, 40), st.integers(0, 2)), max_size=14)
SIZES = st.lists(st.integers(1, 5), min_size=1, max_size=4).map(tuple)


# Delays from event 0 to event 1


def delay(matching, occurrences, end=100, sizes=(1000,), **limits):
    constraint = DelayConstraint(name="D", source="a", target="b", matching=matching, **limits)
    return observed(delays(constraint, 1), occurrences, end, sizes)


def test_a_reaction_ends_with_the_first_target_that_is_not_too_early():
    occurrences = each(0, 0, 10) + each(1, 1, 4, 13)
    (upper, lower) = delay(Matching.REACTION, occurrences, lower=2, upper=5)
    assert (upper.limit.is_upper, upper.values.low, upper.values.high, upper.values.high_at) == (True, 3, 4, 0)
    assert (lower.limit.is_upper, lower.limit.limit) == (False, 2)


def test_sources_share_a_target_and_stray_targets_are_ignored():
    (upper,) = delay(Matching.REACTION, each(0, 5, 7) + each(1, 0, 9, 20), upper=5)
    assert (upper.values.low, upper.values.high, upper.values.violation) == (2, 4, "")


def test_a_source_without_target_waits_until_the_end_of_the_run():
    (upper,) = delay(Matching.REACTION, each(0, 5, 7, 30), end=50, upper=5)
    assert (upper.values.high, upper.values.pending) == (None, 45)


def test_one_to_one_the_number_decides():
    (upper,) = delay(Matching.ONE_TO_ONE, each(0, 0, 1, 2) + each(1, 3, 5, 12), upper=8)
    assert (upper.values.low, upper.values.high, upper.values.high_at) == (3, 10, 2)


@pytest.mark.parametrize("occurrences", [each(0, 0) + each(1, 1, 2), each(1, 0) + each(0, 1)])
def test_one_to_one_a_target_does_not_occur_before_its_source(occurrences):
    (upper,) = delay(Matching.ONE_TO_ONE, occurrences, upper=8)
    assert upper.values.violation == "a target occurs before the source that it belongs to"


def test_unique_reactions_go_on_after_a_missed_source_and_a_stray_target():
    # The source at 0 is missed: the target at 12 belongs to the one at 10, and that at 15 to none.
    (upper,) = delay(Matching.UNIQUE_REACTION, each(0, 0, 10, 20) + each(1, 12, 15, 23), upper=5)
    assert (upper.values.violation, upper.values.violated_at) == ("1 without a target, 1 without a source", 0)
    assert (upper.values.low, upper.values.high) == (2, 3)


def test_a_unique_reaction_can_still_come_after_the_end_of_the_run():
    assert [each.values.violation for each in delay(Matching.UNIQUE_REACTION, each(0, 96), upper=5)] == [""]
    assert [each.values.violation for each in delay(Matching.UNIQUE_REACTION, each(0, 94), upper=5)] == ["1 without a target"]


@given(OCCURRENCES, SIZES, st.integers(0, 9), st.integers(0, 20))
def test_reactions_as_they_are_defined(occurrences, sizes, lower, more):
    upper, end = lower + more, 41
    (found, _) = delay(Matching.REACTION, occurrences, end, sizes, lower=lower, upper=upper)
    sources, targets = ([time for time, event in occurrences if event == number] for number in (0, 1))
    # For each source x there is a target y with lower <= y - x <= upper; what is in the future is not known.
    missed = [x for x in sources if not any(lower <= y - x <= upper for y in targets) and x + upper < end]
    late = found.values.high is not None and found.values.high > upper
    assert (late or found.values.pending > upper) == bool(missed)


@given(OCCURRENCES, SIZES, st.integers(0, 9), st.integers(0, 20))
def test_one_to_one_as_it_is_defined(occurrences, sizes, lower, more):
    upper, end = lower + more, 41
    found = delay(Matching.ONE_TO_ONE, occurrences, end, sizes, lower=lower, upper=upper)
    sources, targets = (sorted(time for time, event in occurrences if event == number) for number in (0, 1))
    paired = [y - x for x, y in zip(sources, targets, strict=False)]
    waiting = [end - x for x in sources[len(targets) :]]
    is_missed = len(targets) > len(sources) or not all(lower <= d <= upper for d in paired) or any(w > upper for w in waiting)
    assert is_violated(found) == is_missed


@given(OCCURRENCES, SIZES, st.integers(0, 9), st.integers(0, 20))
def test_unique_reactions_as_they_are_defined(occurrences, sizes, lower, more):
    upper, end = lower + more, 41
    found = delay(Matching.UNIQUE_REACTION, occurrences, end, sizes, lower=lower, upper=upper)
    sources, targets = ([time for time, event in sorted(occurrences) if event == number] for number in (0, 1))
    assert is_violated(found) != any(is_matching(sources, targets, lower, upper, end))


def is_matching(sources, targets, lower, upper, end):
    """Whether each target is that of one source, for each assignment; sources whose limit has not passed need none."""
    if not targets:
        yield all(x + upper >= end for x in sources)
        return
    y, *others = targets
    for number, x in enumerate(sources):
        if lower <= y - x <= upper:
            yield from is_matching(sources[:number] + sources[number + 1 :], others, lower, upper, end)


def is_violated(found):
    """Whether limits are exceeded, or something else is wrong."""
    return any(each.values.violation or is_exceeded(each) for each in found)


def is_exceeded(quantity):
    values, limit = quantity.values, quantity.limit.limit
    if quantity.limit.is_upper and values.pending > limit:
        return True
    value = values.high if quantity.limit.is_upper else values.low
    return value is not None and (value > limit if quantity.limit.is_upper else value < limit)


# Repetitions


def repetition(times, end=100, sizes=(1000,), base=1, **limits):
    constraint = RepetitionConstraint(name="R", event="a", **limits)
    occurrences = each(0, *(time * base for time in times))
    return observed(Repetitions(constraint, base), occurrences, end * base, sizes)


def test_a_repetition_spans_several_occurrences():
    (upper, lower) = repetition([0, 10, 21, 29], end=30, span=2, upper=20, lower=15)
    assert (upper.values.high, upper.values.high_at) == (21, 0)
    assert (lower.values.low, lower.values.low_at) == (19, 10)


def test_a_repetition_that_has_not_ended():
    (upper,) = repetition([0, 10, 20], end=50, span=2, upper=20)
    assert upper.values.pending == 50 - 10


def test_one_occurrence_is_no_repetition():
    (upper,) = repetition([5], upper=20)
    assert (upper.values.high, upper.values.reason) == (None, "it occurred 1 time")


def test_the_jitter_is_about_the_nominal_period_if_one_is_stated():
    # 0, 10, 20, 30 moved by 2, 0, 5, 1: ideal points from 0 on, and 5 after one of them.
    (jitter,) = repetition([2, 10, 25, 31], period=10, jitter=4)
    assert (jitter.limit.quantity, jitter.values.high) == ("jitter", 5)


def test_a_jitter_needs_ideal_points():
    (jitter,) = repetition([2, 10, 25, 31], jitter=4)
    assert (jitter.values.high, bool(jitter.values.reason)) == (None, True)


@given(st.lists(st.integers(0, 20), min_size=2, max_size=9), st.integers(1, 3), st.integers(0, 9), st.integers(0, 9), SIZES)
def test_the_jitter_is_the_least_with_which_ideal_points_exist(distances, span, lower, more, sizes):
    times = list(np.cumsum(distances))
    upper = lower + more
    *_, jitter = repetition(times, end=10**3, sizes=sizes, base=3, span=span, lower=lower, upper=upper, jitter=0)
    if len(times) <= span:
        assert jitter.values.high is None
        return
    assert has_ideal_points(times, span, lower, upper, jitter.values.high)
    assert jitter.values.high == 0 or not has_ideal_points(times, span, lower, upper, jitter.values.high - 1)


def has_ideal_points(times, span, lower, upper, jitter):
    """Whether there are points, each occurrence at most `jitter` after its own, and each `span` after each between the limits."""
    for line in range(span):
        low, high = -(10**6), 10**6
        for time in times[line::span]:
            low, high = max(low, time - jitter), min(high, time)
            if low > high:
                return False
            low, high = low + lower, high + upper
    return True


# Synchronization


def spread(reading, occurrences, end=100, sizes=(1000,), events=2, tolerance=5):
    constraint = EventSynchronization(name="S", events=("a", "b"), tolerance=tolerance)
    metrics = reading(constraint, 1, events=events)
    (found,) = observed(metrics, occurrences, end, sizes)
    return found


def test_subsequent_occurrences_follow_each_other_window_by_window():
    found = spread(SubsequentOccurrences, each(0, 0, 10, 11, 20) + each(1, 2, 14, 19))
    assert (found.values.low, found.values.high, found.values.high_at) == (1, 4, 10)


def test_a_window_that_is_not_complete_at_the_end():
    assert spread(SubsequentOccurrences, each(0, 0, 90) + each(1, 2)).values.pending == 10
    assert spread(AllOccurrences, each(0, 0, 90) + each(1, 2)).values.pending == 10


def test_of_all_windows_the_narrowest_counts():
    # 12 is 2 after 10; 10 and 14 are 2 and 4 away from it. A window for all of them would be 4 wide.
    found = spread(AllOccurrences, each(0, 10, 14) + each(1, 12))
    assert (found.values.high, found.values.high_at) == (2, 10)


@given(OF_THREE, SIZES, st.integers(0, 10))
def test_all_occurrences_as_they_are_defined(occurrences, sizes, tolerance):
    """Each occurrence is in a window as wide as the tolerance with an occurrence of every event."""
    end = 41
    found = spread(AllOccurrences, occurrences, end, sizes, events=3, tolerance=tolerance)
    missed = [time for time, _ in occurrences if narrowest(occurrences, time) > tolerance and end - time > tolerance]
    assert is_exceeded(found) == bool(missed)


def narrowest(occurrences, time):
    """The width of the narrowest window around a time with an occurrence of each of three events."""
    by_event = [[t for t, event in occurrences if event == number] for number in range(3)]
    return min((max(*found, time) - min(*found, time) for found in product(*by_event)), default=10**6)


@given(OF_THREE, SIZES)
def test_subsequent_occurrences_do_not_depend_on_chunks(occurrences, sizes):
    whole = spread(SubsequentOccurrences, occurrences, events=3)
    assert spread(SubsequentOccurrences, occurrences, sizes=sizes, events=3) == whole
