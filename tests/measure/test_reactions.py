"""Latencies between stimuli and responses that are frames."""

import numpy as np

from amalthea_uros.measure.reactions import reactions
from amalthea_uros.timing.basics.quantities import ChainQuantity as Q

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
