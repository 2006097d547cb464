"""How long several cycles take of which some contain what a loop does in intervals: see docs/proofs/executor-cycle.md."""

from itertools import product

import pytest

from amalthea_uros.executors.bounds.sequences import CycleSequence

LONGEST, USUAL = 30, 10


@pytest.mark.parametrize(
    ("count", "time"),
    [
        (1, 30),
        (2, 40),
        # In 100, a second one begins.
        (8, 8 * USUAL + 20),
        (9, 9 * USUAL + 2 * 20),
    ],
)
def test_a_cycle_with_what_is_done_in_intervals_by_hand(count, time):
    assert CycleSequence(LONGEST, USUAL, (101,)).time(count) == time


@pytest.mark.parametrize("intervals", [(), (25,), (40,), (25, 70)])
def test_no_schedule_takes_longer(intervals):
    cycles = CycleSequence(LONGEST, USUAL, intervals)
    for count in range(1, 9):
        assert cycles.time(count) >= max(
            taken for chosen in product((False, True), repeat=count) if (taken := _time(chosen, intervals)) is not None
        )


def _time(chosen, intervals):
    """How long cycles take, of which some are to contain everything that is due; None if nothing is."""
    now, begun = 0, dict.fromkeys(range(len(intervals)), -1000)
    for is_chosen in chosen:
        due = [each for each, interval in enumerate(intervals) if now >= begun[each] + interval]
        if is_chosen and not due:
            return None
        if is_chosen:
            begun[due[0]] = now
        now += LONGEST if is_chosen else USUAL
    return now


def test_nothing_in_intervals_makes_all_cycles_the_longest_ones():
    assert CycleSequence(LONGEST, LONGEST).time(7) == 7 * LONGEST


def test_in_the_long_run_a_cycle_takes_its_share_of_what_is_done_in_intervals():
    """Of 100, the extra 20 take a fifth, so that 80 are left for 8 cycles."""
    assert CycleSequence(LONGEST, USUAL, (100,)).average == 100 / 8
    assert CycleSequence(LONGEST, USUAL, (20,)).average == LONGEST
