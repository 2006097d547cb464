"""How long messages are stored, compared with schedules of one handle, step by step: see docs/proofs/stored-messages.md."""

from random import Random

import pytest
from effort import examples
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.executors.bounds.storage import StorageConditions
from amalthea_uros.timing.event_models.models import PeriodicEvents

UNTIL_WAIT, UNTIL_CHECK, PERIOD = 10, 2, 20
COUNT, LAST, IDLE = 60, 20, 5


def longest_storage(
    arrivals, draw, *, until_wait=UNTIL_WAIT, until_check=UNTIL_CHECK, timeout=1000, takes=lambda number: True, always=False
):
    """The longest time from an arrival to the check that takes the message, of an executor whose callbacks read all before they end.

    Iterations without a callback are as long as `IDLE`; there are none if it is always called. The last messages do not count: nothing
    ends the waits after them.
    """
    coming, unread, stored, times = sorted(arrivals), [], [], []
    wait = number = 0
    while coming or unread or stored:
        unread += [coming.pop(0) for _ in range(sum(time <= wait for time in coming))]
        check = wait
        if unread:
            stored.append(unread.pop(0))
        else:
            check = min([wait + timeout, *coming[:1]])
            stored += [coming.pop(0) for _ in range(sum(time <= check for time in coming))]
        check, number = check + draw(until_check), number + 1
        if stored and takes(number):
            times.append(check - stored.pop(0))
        elif not always:
            wait = check + draw(IDLE - until_check)
            continue
        published = check + draw(until_wait)
        stored += unread + [coming.pop(0) for _ in range(sum(time <= published for time in coming))]
        unread, wait = [], published + draw(check + until_wait - published)
    return max(times[:-LAST])


def conditions(*, jitter=0, timeout=1000, is_only=True, **change):
    """Those of a handle whose messages come periodically."""
    found = {
        "events": PeriodicEvents(PERIOD, jitter),
        "until_wait": UNTIL_WAIT,
        "until_check": UNTIL_CHECK,
        "until_timeout": UNTIL_WAIT + UNTIL_CHECK + timeout,
        "age": UNTIL_WAIT + UNTIL_CHECK,
        "gaps": (PERIOD + jitter,),
        "is_alone": is_only,
        "idle": IDLE,
    }
    return StorageConditions(**found | change)


def late(jitters):
    return [number * PERIOD + jitter for number, jitter in enumerate(jitters)]


def longest(most):
    return most


#: The first message arrives in an iteration without a callback, and the second one early, while the first one is published.
BEHIND = [time + 37 for time in late([6, *[0] * (COUNT - 1)])]


@examples(300)
@given(st.integers(0, 30), st.integers(1, 100), st.booleans(), st.booleans(), st.integers(0, 2**32))
def test_no_message_is_stored_longer_than_its_bound(jitter, timeout, is_only, always, seed):
    random = Random(seed)
    bound = conditions(jitter=jitter, timeout=timeout, is_only=is_only, room=COUNT, idle=None if always else IDLE).longest.most
    arrivals = late(random.randint(0, jitter) for _ in range(COUNT))
    assert longest_storage(arrivals, lambda most: random.randint(0, most), timeout=timeout, always=always) <= bound


def test_messages_that_are_stored_once_stay_behind():
    # Its wait times out at 40, and the next one begins at 45. The first message, of 43, is taken at 47, and published until 57, when
    # the second one comes: it is stored. From then on each waits for the next one, which comes 20 later, and is taken 2 after that.
    assert longest_storage(BEHIND, longest, timeout=40) == PERIOD + UNTIL_CHECK
    assert conditions(jitter=6).longest.most == PERIOD + 6 + UNTIL_CHECK


def test_nothing_is_stored_if_each_message_finds_the_executor_waiting():
    assert longest_storage([time + 41 for time in late([2, *[0] * (COUNT - 1)])], longest, timeout=40) <= IDLE
    assert conditions(jitter=2).longest.most == UNTIL_WAIT + UNTIL_CHECK


def test_without_room_for_each_iteration_more_and_more_are_stored():
    # Every second one is late, so that the next one comes during its publication: waits end only for every second one.
    assert longest_storage(late([0, 12] * (COUNT // 2)), longest) > 5 * PERIOD
    assert conditions(jitter=12).longest is None
    assert conditions(jitter=12, room=8).longest.most == 12 + UNTIL_CHECK + 8 * (12 + PERIOD + 12)


@pytest.mark.parametrize(
    ("arrivals", "change"),
    [
        pytest.param([*BEHIND[:2], *(time + 20 for time in BEHIND[2:])], {}, id="D1-messages-that-do-not-come"),
        pytest.param(BEHIND, {"takes": lambda number: number % 4}, id="D2-an-iteration-that-takes-nothing"),
        pytest.param(BEHIND, {"until_check": UNTIL_CHECK + 8}, id="D3-a-longer-beginning"),
        pytest.param(late([0, 12] * (COUNT // 2)), {}, id="D4-more-jitter"),
    ],
)
def test_each_assumption_about_stored_messages_is_needed(arrivals, change):
    assert longest_storage(arrivals, longest, timeout=40, **change) > conditions(jitter=6).longest.most


def test_a_callback_that_is_always_called_reads_messages_in_iterations_that_took_none():
    # The first wait times out at 40; the callback publishes from 42 to 52, and reads the message of 45, which waits for that of 65.
    arrivals = [time + 45 for time in late([0] * COUNT)]
    assert longest_storage(arrivals, longest, timeout=40, always=True) == PERIOD + UNTIL_CHECK
    assert conditions().longest.most == UNTIL_WAIT + UNTIL_CHECK
    assert conditions(idle=None).longest.most == PERIOD + UNTIL_CHECK
