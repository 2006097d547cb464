"""The assumptions of the proofs in docs/proofs, each violated on purpose: then a bound is exceeded, which holds otherwise."""

from dataclasses import replace
from itertools import count
from random import Random

import played_executors
import pytest
from hypothesis import given
from hypothesis import strategies as st
from looping_executors import MS, SPIN, US, Proc, evaluate, looping, message, ticks, timer, waiting_publication
from played_executors import Spans, play
from random_executors import violations

from amalthea_uros.executors.bounds.backlog import Arriving, max_backlog
from amalthea_uros.executors.bounds.sequences import CycleSequence
from amalthea_uros.perf.executors import LoopKind, ThreadLoop, TriggerCondition, TriggerKind
from amalthea_uros.perf.network import Span
from amalthea_uros.perf.software import Preemption
from amalthea_uros.timing.event_models.models import SporadicEvents

# The receive backlog.

ITEMS = Arriving(events=SporadicEvents(10), jitter=40)
LENGTH = 6
#: All items that jitter can bring at once, and then one every 10.
BURST = [0] * 5 + [*range(10, 200, 10)]


def backlog(arrivals, length, reads=lambda _: 1, newest_first=False):
    """The most items in the buffer, and the greatest age; the last cycle without an item begins just before the first one arrives."""
    waiting, coming, time = [], sorted(arrivals), min(arrivals)
    most = oldest = number = 0
    while waiting or coming:
        time, number = time + length, number + 1
        if not waiting and coming and coming[0] > time:
            time = coming[0]
        while coming and coming[0] <= time:
            waiting.append(coming.pop(0))
        most = max(most, len(waiting))
        for _ in range(min(reads(number), len(waiting))):
            oldest = max(oldest, time - waiting.pop(-1 if newest_first else 0))
    return most, oldest


@given(st.integers(2, 12), st.integers(0, 60), st.integers(1, 2), st.integers(1, 11), st.randoms())
def test_no_schedule_has_more_items_in_the_buffer(interval, jitter, parts, length, random):
    most = max_backlog(
        [Arriving(events=SporadicEvents(interval), jitter=jitter, parts=parts)], length, CycleSequence(length, length)
    )
    if most is None:
        return
    times = [number * interval + random.randint(0, jitter) for number in range(30)]
    seen, oldest = backlog([time for time in times for _ in range(parts)], random.randint(1, length))
    assert seen <= most
    assert oldest <= most * length


def test_the_bound_of_the_backlog_is_reached():
    assert backlog(BURST, LENGTH)[0] == max_backlog([ITEMS], LENGTH, CycleSequence(LENGTH, LENGTH))


@pytest.mark.parametrize(
    ("arrivals", "change"),
    [
        pytest.param(BURST, {"newest_first": True}, id="B1-the-newest-is-read-first"),
        pytest.param(BURST, {"reads": lambda number: number % 2}, id="B2-a-wait-reads-nothing"),
        pytest.param([0, *BURST], {}, id="B3-one-item-more"),
        pytest.param(BURST, {"length": LENGTH + 4}, id="B4-a-longer-cycle"),
        pytest.param([*BURST, 3], {}, id="B5-an-acknowledgement-that-is-left"),
        pytest.param([-1, -1, *BURST], {}, id="B8-items-at-the-beginning"),
    ],
)
def test_each_assumption_about_the_backlog_is_needed(arrivals, change):
    most = max_backlog([ITEMS], LENGTH, CycleSequence(LENGTH, LENGTH))
    seen, oldest = backlog(arrivals, **{"length": LENGTH} | change)
    assert seen > most or oldest > most * LENGTH


# Cycles and response times.

LOOP = ThreadLoop(kind=LoopKind.SLEEPING, timeout=10 * MS, sleep=5 * MS)
SEEDS = range(20)


def base(*others, loop=LOOP, **parts):
    handles = message("a", 20_000, 1000, jitter=10 * MS), timer("t", 50_000, 500)
    return looping(*handles, loop=loop, spin=200, others=others, **parts)


def exceeded(analysed, played=None, costs=(1000, 500), preempting=(), priority=5):
    """The bounds of a system that are exceeded when executors are simulated step by step."""
    executors = played or analysed.executors
    sending = {each.transmission: (0, MS) for handle in analysed.executors[0].handles for each in handle.publications}
    results = [evaluate(analysed, sending={name: Span(least=0, most=most) for name, (_, most) in sending.items()})]
    times = {handle.runnable: (cost * US, cost * US) for handle, cost in zip(executors[0].handles, costs, strict=True)}
    spans = Spans(
        costs=times, spins={each.name: (200 * US, 200 * US) for each in executors}, sending=sending, draw=lambda _, most: most
    )
    priorities = {each.name: priority + number for number, each in enumerate(executors)}
    found = set()
    for seed in SEEDS:
        seen = play(executors, spans, 1000 * MS, random=Random(seed), preempting=preempting, priorities=priorities)
        found.update(violations(seen[:1], results))
    return found


def test_nothing_is_exceeded_while_the_assumptions_hold():
    assert not exceeded(base())


def other(system, **change):
    """The executor of a system, with other properties than those that were analysed."""
    return (replace(system.executors[0], **change),)


@pytest.mark.parametrize(
    "change",
    [
        pytest.param(lambda executor: {"loop": replace(executor.loop, sleep=30 * MS)}, id="C4-a-longer-sleep"),
        pytest.param(lambda executor: {"waiting": replace(executor.waiting, messages_per_wait=0)}, id="C6-nothing-is-read"),
        pytest.param(lambda _: {"trigger": TriggerCondition(kind=TriggerKind.ALL)}, id="C8-what-is-ready-is-not-called"),
        pytest.param(
            lambda executor: {"handles": (replace(executor.handles[0], interval=4 * MS), executor.handles[1])},
            id="C9-more-messages",
        ),
    ],
)
def test_each_assumption_about_the_loop_is_needed(change):
    analysed = base()
    assert exceeded(analysed, other(analysed, **change(analysed.executors[0])))


def test_a_second_region_of_lower_rank_is_not_counted():
    # C2: in the play, the regions of the lower process begin whenever they like.
    low = Proc("low", (ticks(2000),), period=500_000, priority=1, task={"preemption": Preemption.NON_PREEMPTIVE})
    assert exceeded(base(low), preempting=((9, 3 * MS, 0, 2 * MS, 2 * MS),))
    assert not exceeded(base(low), preempting=((1, 3 * MS, 0, 2 * MS, 2 * MS),))


def test_overhead_that_is_divided_anew_in_each_iteration_is_not_counted(monkeypatch):
    # C3: all of it after the check, and all of it before the next one.
    class Alternating(played_executors.Played):
        turn = count()
        looks = 0

        @property
        def prepares(self):
            return 4 * (next(self.turn) % 2)

        @prepares.setter
        def prepares(self, _):
            pass

    analysed = looping(timer("t", 50_000, 0), loop=SPIN, spin=200)
    assert not exceeded(analysed, costs=(0,))
    monkeypatch.setattr(played_executors, "Played", Alternating)
    assert exceeded(analysed, costs=(0,))


def test_a_timer_that_does_not_end_a_wait_is_late(monkeypatch):
    # C7.
    class Deaf(played_executors.Played):
        def _wait(self, timeout):
            every, self.entities = self.entities, [each for each in self.entities if not each.is_timer]
            steps = super()._wait(timeout)
            first = next(steps, None)
            self.entities = every
            if first is not None:
                yield first
                yield from steps

    analysed = base(loop=ThreadLoop(kind=LoopKind.CONTINUOUS, timeout=1000 * MS))
    assert not exceeded(analysed)
    monkeypatch.setattr(played_executors, "Played", Deaf)
    assert exceeded(analysed)


def test_a_session_that_is_passed_on_by_priority_is_kept_for_longer():
    # C5: two others of higher priority pass it on to each other.
    analysed = base(session="s")
    executor = analysed.executors[0]
    others = tuple(
        replace(executor, name=name, handles=(replace(executor.handles[0], name=name),), loop=replace(LOOP, sleep=MS))
        for name in ("First", "Second")
    )
    analysed = replace(analysed, executors=(executor, *others))
    assert exceeded(analysed, analysed.executors)


def test_jobs_of_equal_rank_that_wait_are_counted():
    # While messages keep the thread executing, jobs of its rank wait, and all of them execute when a publication waits.
    def analysed(limit):
        publication = waiting_publication(timeout=2 * MS, transmission="tx")
        return looping(
            message("a", 8000, 2000, jitter=400 * MS),
            message("b", 50_000, 100, publications=(publication,)),
            timer("t", 100_000, 0),
            loop=SPIN,
            spin=200,
            others=(Proc("equal", (ticks(1000),), period=4000, priority=5, task={"activation_limit": limit}),),
        )

    played = {"costs": (2000, 100, 0), "preempting": ((5, 4 * MS, 0, MS, MS),)}
    assert not exceeded(analysed(100), **played)
    # C1: more jobs wait than may be pending.
    assert any(text.startswith("t: ") for text in exceeded(analysed(1), **played))
