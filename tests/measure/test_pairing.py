"""Markers of starts and ends, pairs of them and latencies: by hand, and against a state machine that reads the events in order."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.measure.chains import reactions
from amalthea_uros.measure.markers import Marker, parse_marker, refuse_overlap
from amalthea_uros.measure.pairing import paired_by_number, paired_in_order
from amalthea_uros.measure.series import Counts
from amalthea_uros.timing.basics.quantities import ChainQuantity as Q
from amalthea_uros.trace.can.frames import EXTENDED

START, END = False, True


def in_order(*events, segments=None):
    times = np.array([time for time, _ in events], np.int64)
    segment = np.array(segments or [0] * len(events), np.int64)
    return paired_in_order(times, segment, np.array([is_end for _, is_end in events], bool))


def by_number(*events, modulus=256, segments=None):
    times, ends, numbers = (np.array(column) for column in zip(*events, strict=True))
    segment = np.array(segments or [0] * len(events), np.int64)
    return paired_by_number(times.astype(np.int64), segment, ends.astype(bool), numbers.astype(np.int64) % modulus, modulus)


def durations(pairs):
    return (pairs.ends - pairs.starts).tolist()


def test_each_start_has_the_end_after_it():
    pairs = in_order((0, START), (5, END), (100, START), (108, END))
    assert durations(pairs) == [5, 8]
    assert pairs.follows.tolist() == [False, True]
    assert pairs.counts == Counts()


def test_the_edges_are_incomplete():
    assert in_order((1, END), (10, START), (14, END), (20, START)).counts == Counts(incomplete=2)


def test_a_second_start_without_end_drops_the_one_that_is_open():
    pairs = in_order((0, START), (10, START), (14, END), (20, START), (25, END))
    assert durations(pairs) == [4, 5]
    assert pairs.counts == Counts(incomplete=1)
    assert pairs.follows.tolist() == [False, True]


def test_a_distance_across_a_missing_event_is_none_of_consecutive_jobs():
    pairs = in_order((0, START), (4, END), (10, START), (20, START), (25, END))
    assert pairs.follows.tolist() == [False, False]


def test_nothing_is_paired_across_a_gap():
    pairs = in_order((0, START), (4, END), (10, START), (14, END), (20, START), (24, END), segments=[0, 0, 0, 1, 1, 1])
    assert pairs.starts.tolist() == [0, 20]
    assert pairs.counts == Counts(incomplete=2)
    assert pairs.follows.tolist() == [False, False]


def test_a_step_back_of_the_clock_ends_what_is_open():
    pairs = in_order((100, START), (50, END), (60, START), (64, END))
    assert durations(pairs) == [4]
    assert pairs.counts == Counts(incomplete=2, reordered=1)


def test_a_number_pairs_jobs_that_overlap():
    pairs = by_number((0, START, 0), (5, START, 1), (12, END, 1), (20, END, 0))
    assert sorted(durations(pairs)) == [7, 20]
    assert pairs.counts == Counts()


def test_missing_numbers_are_lost():
    pairs = by_number((0, START, 0), (4, END, 0), (10, START, 3), (14, END, 3), (20, START, 4), (24, END, 4))
    assert durations(pairs) == [4, 4, 4]
    assert pairs.counts == Counts(lost=2)
    assert pairs.follows.tolist() == [False, False, True]


def test_a_gap_shows_by_the_numbers_how_much_is_lost():
    events = [(0, START, 0), (4, END, 0), (50, START, 5), (54, END, 5)]
    assert by_number(*events, segments=[0, 0, 1, 1]).counts == Counts(lost=4)


def test_a_repeated_number_counts_once():
    pairs = by_number((0, START, 0), (1, START, 0), (4, END, 0), (5, END, 0))
    assert durations(pairs) == [4]
    assert pairs.counts == Counts(duplicated=2)


def test_a_counter_of_few_bits_wraps_many_times():
    events = [event for job in range(1000) for event in ((10 * job, START, job), (10 * job + 3, END, job))]
    pairs = by_number(*events, modulus=16)
    assert durations(pairs) == [3] * 1000
    assert pairs.follows.tolist() == [False] + [True] * 999
    assert pairs.counts == Counts()


def test_a_counter_that_starts_again_is_another_run():
    first = [event for job in range(100) for event in ((10 * job, START, job), (10 * job + 3, END, job))]
    again = [(5000 + time, is_end, number) for time, is_end, number in first]
    pairs = by_number(*first, *again, modulus=2**32)
    assert len(pairs.starts) == 200
    assert pairs.counts == Counts()
    assert pairs.follows.tolist().count(False) == 2


def test_without_events_there_are_no_pairs():
    assert durations(in_order()) == []
    empty = np.empty(0, np.int64)
    assert durations(paired_by_number(empty, empty, empty.astype(bool), empty, 256)) == []


@st.composite
def logs(draw):
    """Jobs in the order of time, of which some events are lost, repeated, or swapped with a neighbour."""
    number = draw(st.integers(1, 30))
    events = []
    for job in range(number):
        for is_end in (START, END):
            fate = draw(st.sampled_from(["kept"] * 6 + ["lost", "twice"]))
            time = 100 * job + (draw(st.integers(1, 90)) if is_end else 0)
            events += [] if fate == "lost" else [(time, is_end, job)] * (2 if fate == "twice" else 1)
    for place in draw(st.lists(st.integers(0, max(len(events) - 2, 0)), max_size=3)):
        events[place : place + 2] = reversed(events[place : place + 2])
    return events


@given(logs())
def test_every_event_is_a_part_of_a_pair_or_counted(events):
    columns = np.array([(time, is_end) for time, is_end, _ in events], np.int64).reshape(-1, 2).T
    pairs = paired_in_order(columns[0], np.zeros(len(events), np.int64), columns[1].astype(bool))
    assert 2 * len(pairs.starts) + pairs.counts.incomplete == len(events)
    assert (pairs.ends >= pairs.starts).all()
    # One event after the other.
    found, opened, last = [], None, None
    for time, is_end, _ in events:
        if last is not None and time < last:
            opened = None
        if is_end and opened is not None:
            found.append((opened, time))
        opened, last = (None if is_end else time), time
    assert list(zip(pairs.starts.tolist(), pairs.ends.tolist(), strict=True)) == found


@given(logs(), st.sampled_from([16, 256, 2**32]))
def test_with_numbers_no_pair_is_of_two_jobs(events, modulus):
    if not events:
        return
    pairs = by_number(*events, modulus=modulus)
    jobs = {(time, is_end): job for time, is_end, job in events}
    for start, end in zip(pairs.starts.tolist(), pairs.ends.tolist(), strict=True):
        assert jobs[start, START] == jobs[end, END]
    complete = {job for _, is_end, job in events if is_end} & {job for _, is_end, job in events if not is_end}
    if pairs.counts.reordered == 0:
        assert len(pairs.starts) == len(complete)


S, R = False, True


def measured(*events, modulus=None, segments=None):
    times = np.array([event[0] for event in events], np.int64)
    is_response = np.array([event[1] for event in events], bool)
    numbers = None if modulus is None else np.array([event[2] % modulus for event in events], np.int64)
    segment = np.array(segments or [0] * len(events), np.int64)
    found = list(reactions("chain", times, segment, is_response, numbers, modulus))
    values = {each.quantity: None if each.values is None else each.values.tolist() for each in found}
    return values, found[0].counts


def test_without_numbers_a_response_shows_the_latest_stimulus_before_it():
    values, counts = measured((0, S), (10, S), (14, R), (18, R), (20, S), (27, R))
    # The first response answers both stimuli before it.
    assert values == {Q.REDUCED_REACTION_TIME: [14, 4, 7], Q.REDUCED_DATA_AGE: [4, 8, 7]}
    assert counts.incomplete == 0


def test_with_numbers_a_response_shows_its_own_stimulus():
    # The second stimulus comes before the response, which still shows the first one.
    values, _ = measured((0, S, 0), (10, S, 1), (14, R, 0), (25, R, 1), modulus=256)
    assert values[Q.REDUCED_DATA_AGE] == [14, 15]
    assert values[Q.REDUCED_REACTION_TIME] == [14, 15]
    # An event just after the first stimulus waits for the second one.
    assert values[Q.REACTION_TIME] == [25]
    # The first response is the newest until the second one.
    assert values[Q.DATA_AGE] == [25]


def test_stimuli_without_a_response_are_counted():
    _, counts = measured((0, S), (5, R), (10, S), (20, S))
    assert counts.incomplete == 2


def test_nothing_is_measured_across_a_gap():
    values, counts = measured((0, S), (50, R), segments=[0, 1])
    assert values == {Q.REDUCED_REACTION_TIME: None}
    assert counts.incomplete == 1
    values, counts = measured(
        (0, S, 0), (4, R, 0), (10, S, 1), (50, R, 1), (60, S, 2), (66, R, 2), modulus=256, segments=[0] * 3 + [1] * 3
    )
    assert values[Q.REDUCED_REACTION_TIME] == [4, 6]
    assert counts.incomplete == 1


def test_lost_stimuli_are_counted_and_no_event_waits_across_them():
    values, counts = measured((0, S, 0), (4, R, 0), (30, S, 3), (34, R, 3), (40, S, 4), (44, R, 4), modulus=256)
    assert counts.lost == 2
    # From 0 to 34 it is not known which event waited.
    assert values[Q.REACTION_TIME] == [14]


def test_a_repeated_stimulus_counts_once():
    values, counts = measured((0, S, 0), (1, S, 0), (4, R, 0), modulus=256)
    assert values[Q.REDUCED_REACTION_TIME] == [4]
    assert counts.duplicated == 1


def test_the_fastest_chain_is_assumed_where_nothing_is_known():
    """Without numbers, no latency is longer than the true one."""
    events = [(0, S, 0), (20, S, 1), (25, R, 0), (40, S, 2), (45, R, 1), (65, R, 2)]
    true, _ = measured(*events, modulus=256)
    least, _ = measured(*events)
    for quantity, values in least.items():
        assert max(values) <= max(true[quantity])


@pytest.mark.parametrize(
    ("text", "marker"),
    [
        ("123", Marker(0x123)),
        ("0x123", Marker(0x123)),
        ("0x18000001", Marker(0x18000001 | EXTENDED)),
        # candump writes identifiers of 29 bits with eight digits, however small they are.
        ("00000123", Marker(0x123 | EXTENDED)),
        ("800", Marker(0x800 | EXTENDED)),
        ("123#01", Marker(0x123, (1,))),
        ("can0:123#01xx0A", Marker(0x123, (1, None, 10), "can0")),
    ],
)
def test_a_marker_is_written_as_candump_shows_it(text, marker):
    assert parse_marker(text) == marker
    assert parse_marker(str(marker)) == marker


@pytest.mark.parametrize("text", ["", "x", "123#1", "123#", "20000000", "can0:", "123##01", "1234567890"])
def test_other_text_is_refused(text):
    with pytest.raises(ValueError, match=r"29 bits|an example"):
        parse_marker(text)


def test_the_first_bytes_decide():
    marker = parse_marker("123#01xx03")
    assert marker.fits(bytes([1, 9, 3]))
    assert marker.fits(bytes([1, 9, 3, 4]))
    assert not marker.fits(bytes([1, 9]))
    assert not marker.fits(bytes([1, 9, 4]))


@pytest.mark.parametrize(("one", "other"), [("123", "123"), ("123", "123#01"), ("can0:123", "123"), ("123#xx01", "123#02")])
def test_a_frame_cannot_be_start_and_end(one, other):
    with pytest.raises(ValueError, match="a frame can be both"):
        refuse_overlap(parse_marker(one), parse_marker(other))


@pytest.mark.parametrize(
    ("one", "other"), [("123", "124"), ("123", "00000123"), ("can0:123", "can1:123"), ("123#01", "123#02")]
)
def test_markers_that_differ_are_told_apart(one, other):
    refuse_overlap(parse_marker(one), parse_marker(other))
