"""Timing constraints on the producer and the consumer, all computed by hand: 5 every 10, and 5 after it every 20."""

from dataclasses import replace
from fractions import Fraction

import pytest
from test_chain_systems import ACTIVATION, END, START, at, producer_and_consumer, read, system, ticks, write

from amalthea_uros.analyze.sensitivity import sensitivity
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import AccessKind, Call, SenderReceiverAccess, Trigger
from amalthea_uros.perf.constraints import (
    ChainEnd,
    ChainSynchronization,
    Constraints,
    DataAgeConstraint,
    DelayConstraint,
    EventSynchronization,
    LatencyConstraint,
    LatencyKind,
    Matching,
    OrderConstraint,
    Ordering,
    RepetitionConstraint,
)
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.events import EventChain, RunnableChange, RunnableEvent
from amalthea_uros.perf.software import Runnable
from amalthea_uros.perf.stimuli import Counter, InterProcess, RelativePeriodic
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import MICROSECOND as US

EVENTS = (at("producer", START), at("producer", END), at("consumer", START), at("consumer", END))
MADE, OUT = EVENTS[0].name, EVENTS[3].name


MAKE = Runnable(name="make", activities=(ticks(1), write("L")))


def evaluate(*constraints, built=None, data_ages=(), orders=(), chains=()):
    built = built or producer_and_consumer(*EVENTS, chains=(EventChain(name="chain", stimulus=MADE, response=OUT), *chains))
    stated = Constraints(constraints=constraints, data_ages=data_ages, orders=orders)
    analysis = analyze_system(replace(built, constraints=stated))
    return [(r.quantity, r.value if r.value is None else r.value / US, str(r.verdict)) for r in analysis.requirements]


def latency(**limits):
    return LatencyConstraint(name="L", **{"chain": "chain"} | {name: us * US for name, us in limits.items()})


def delay(source, target, *, matching=Matching.REACTION, **limits):
    return DelayConstraint(
        name="D", source=source, target=target, matching=matching, **{name: us * US for name, us in limits.items()}
    )


def repetition(event=EVENTS[2].name, **limits):
    """Of the start of the consumer, twice, if nothing else is said."""
    return RepetitionConstraint(name="R", event=event, span=2, **{name: us * US for name, us in limits.items()})


@pytest.mark.parametrize(
    ("constraint", "expected"),
    [
        # From the start of the producer at 0 or 10 to the end of the consumer at 10 or 30.
        (latency(minimum=10, maximum=20), [("reaction", 20, "met"), ("reaction", 10, "met")]),
        (latency(minimum=11, maximum=19), [("reaction", 20, "missed"), ("reaction", 10, "missed")]),
        (replace(latency(minimum=10, maximum=10), kind=LatencyKind.AGE), [("data age", 10, "met"), ("data age", 10, "met")]),
        (replace(latency(maximum=9), kind=LatencyKind.AGE), [("data age", 10, "missed")]),
        (replace(latency(maximum=1), chain="none"), [("reaction", None, "unknown")]),
        # Without a limit it is not met.
        (latency(), [("reaction", None, "unknown")]),
        (delay(MADE, OUT, lower=10, upper=19), [("delay", 20, "missed"), ("delay", 10, "met")]),
        # Occurrences that belong together one by one.
        (delay(MADE, EVENTS[1].name, matching=Matching.ONE_TO_ONE, upper=5), [("delay", 5, "met")]),
        (delay(MADE, OUT, matching=Matching.ONE_TO_ONE, upper=99), [("delay", None, "unknown")]),
        # The consumer starts at 5 after every 20; by its response time of 10 and its 5 it might start 5 later.
        (
            repetition(lower=35, upper=45, jitter=5),
            [("repetition", 45, "met"), ("repetition", 35, "met"), ("jitter", 5, "met")],
        ),
        # Two periods are 40, and starts move by up to 5: the true value, 40, is between 35 and 45.
        (repetition(upper=44), [("repetition", 45, "unknown")]),
        (repetition(upper=35), [("repetition", 45, "unknown")]),
        (repetition(upper=34), [("repetition", 45, "missed")]),
        (repetition(lower=36), [("repetition", 35, "unknown")]),
        (repetition(lower=46), [("repetition", 35, "missed")]),
    ],
)
def test_of_a_chain_and_of_events(constraint, expected):
    assert evaluate(constraint) == expected


@pytest.mark.parametrize(
    ("limits", "expected"),
    # The consumer is activated every 20 and starts up to 5 later: after ideal points every 20, or within limits that allow 40 for two.
    [
        ({"period": 20}, (5, "met")),
        ({"lower": 35, "upper": 45}, (5, "met")),
        ({"period": 10}, (None, "unknown")),
        ({"lower": 41, "upper": 45}, (None, "unknown")),
    ],
)
def test_ideal_points_at_another_distance_are_left_further_and_further_behind(limits, expected):
    assert evaluate(repetition(jitter=5, **limits))[-1] == ("jitter", *expected)


def test_repetition_of_sporadic_events():
    sporadic = RelativePeriodic(name="A", distance=Boundaries(lower=20 * US, upper=50 * US))
    built = system([("A", None, [ticks(1)])], [at("A", START), at("A", END)], stimuli=[sporadic])
    stated = replace(repetition("A start", lower=20, upper=50, jitter=1), span=1)
    assert evaluate(stated, built=built) == [("repetition", 50, "met"), ("repetition", 20, "met"), ("jitter", None, "unknown")]


def test_events_that_should_come_together():
    built = system(
        [("A", 10, [ticks(2)]), ("B", 10, [ticks(3)], "core", 1), ("C", 20, [ticks(1)])],
        [at("A", END), at("B", END), at("C", END)],
    )
    # A ends at 2, B 1 later activated and 1 to wait: between 2 and 5.
    together = EventSynchronization(name="S", events=("A terminate", "B terminate"), tolerance=3 * US)
    assert evaluate(together, built=built) == [("spread", 3, "met")]
    apart = EventSynchronization(name="S", events=("A terminate", "C terminate"), tolerance=99 * US)
    assert evaluate(apart, built=built) == [("spread", None, "unknown")]


def test_chains_that_should_end_together():
    short = EventChain(name="short", stimulus=MADE, response=EVENTS[1].name)
    constraint = ChainSynchronization(name="S", chains=("chain", "short"), tolerance=10 * US)
    # One takes 10 to 20, the other one 5.
    assert evaluate(constraint, chains=[short]) == [("spread at the response", 15, "missed")]
    assert evaluate(replace(constraint, end=ChainEnd.STIMULUS), chains=[short]) == [("spread at the stimulus", 0, "met")]
    assert [verdict for *_, verdict in evaluate(replace(constraint, chains=("chain", "none")))] == ["unknown"]


@pytest.mark.parametrize(
    ("limits", "expected"),
    [
        ({"latest": 4 * US}, [("data age", 4, "met")]),
        ({"latest": 3 * US}, [("data age", 4, "missed")]),
        ({"latest_cycle": 1, "earliest_cycle": 0}, [("data age", 4, "met"), ("data age", 4, "met")]),
        ({"earliest_cycle": 1}, [("data age", 4, "missed")]),
    ],
)
def test_how_long_data_are_valid(limits, expected):
    # The writer ends at 1 and 11 of every 20, the reader reads at 5.
    built = system(
        [("writer", 10, [Call(runnable="make")]), ("reader", 20, [read("L"), ticks(1)], "core", 5)],
        [at("writer", END), at("reader", START)],
        runnables=[MAKE],
    )
    assert evaluate(built=built, data_ages=[DataAgeConstraint(name="A", runnable="make", label="L", **limits)]) == expected


def test_data_that_several_processes_write_have_no_age():
    # The second writer is slower and reads what the first one writes: the cycle and the readers of the first one are not all.
    built = system(
        [
            ("writer", 10, [Call(runnable="make")]),
            ("slow", 40, [Call(runnable="make")]),
            ("reader", 20, [read("L"), ticks(1)], "core", 5),
        ],
        [at("writer", END), at("reader", START)],
        runnables=[MAKE],
    )
    for limits in ({"latest": 100 * US}, {"latest_cycle": 5}):
        age = DataAgeConstraint(name="A", runnable="make", label="L", **limits)
        assert [verdict for *_, verdict in evaluate(built=built, data_ages=[age])] == ["unknown"]


def test_data_that_several_processes_read_by_different_means_have_an_age_in_each():
    # The writer ends at 1 and 11 of every 20; the first reader reads at 5, the second one, by sender-receiver communication, at 18.
    receive = SenderReceiverAccess(label="L", kind=AccessKind.READ)
    built = system(
        [
            ("writer", 10, [Call(runnable="make")]),
            ("reader", 20, [read("L"), ticks(1)], "core", 5),
            ("receiver", 20, [receive, ticks(1)], "core", 18),
        ],
        [at("writer", END), at("reader", START)],
        runnables=[MAKE],
    )
    age = DataAgeConstraint(name="A", runnable="make", label="L", latest=5 * US)
    assert evaluate(built=built, data_ages=[age]) == [("data age", 4, "met"), ("data age", 7, "missed")]


@pytest.mark.parametrize(
    ("groups", "ordering", "verdict"),
    [
        ([["a"], ["b"]], Ordering.SUCCESSOR, "met"),
        ([["a"], ["c"]], Ordering.SUCCESSOR, "met"),
        ([["b", "a"], ["c"]], Ordering.SUCCESSOR, "met"),
        ([["b"], ["a"]], Ordering.SUCCESSOR, "missed"),
        ([["a"], ["c"]], Ordering.IMMEDIATE_ANYWHERE, "missed"),
        ([["b"], ["c"]], Ordering.IMMEDIATE_ANYWHERE, "met"),
        ([["b"], ["c"]], Ordering.IMMEDIATE_AT_START, "missed"),
        ([["b"], ["c"]], Ordering.IMMEDIATE_AT_END, "met"),
        ([["a"], ["b"]], Ordering.IMMEDIATE_AT_START, "met"),
    ],
)
def test_the_order_of_runnables(groups, ordering, verdict):
    runnables = [Runnable(name=name, activities=(ticks(1),)) for name in "abc"]
    built = system([("T", 10, [Call(runnable=name) for name in "abc"])], [at("T", START), at("T", END)], runnables=runnables)
    order = OrderConstraint(name="O", groups=tuple(map(tuple, groups)), ordering=ordering)
    assert evaluate(built=built, orders=[order]) == [("order of runnables", None, verdict)]


@pytest.mark.parametrize(
    ("groups", "processes", "reason"),
    [
        ((("d",), ("e",)), (), "no process calls its runnables, such as 'd'"),
        ((("a",), ("b",)), ("U",), "'a' is only called by processes outside of the scope"),
        ((), (), "it names no runnables"),
    ],
)
def test_an_order_that_limits_nothing_is_unknown_with_the_cause(groups, processes, reason):
    runnables = [Runnable(name=name, activities=(ticks(1),)) for name in "abde"]
    bodies = [("T", 10, [Call(runnable="a"), Call(runnable="b")]), ("U", 10, [ticks(1)])]
    built = system(bodies, [at("T", START)], runnables=runnables)
    order = OrderConstraint(name="O", groups=groups, processes=processes)
    (found,) = analyze_system(replace(built, constraints=Constraints(orders=(order,)))).requirements
    assert (found.quantity, str(found.verdict), found.reason) == ("order of runnables", "unknown", reason)


def test_a_constraint_without_limits_is_unknown_with_the_cause():
    built = producer_and_consumer(*EVENTS)
    (found,) = analyze_system(replace(built, constraints=Constraints(constraints=(delay(MADE, OUT),)))).requirements
    assert (found.quantity, found.object, found.reason) == ("delay", f"{MADE} to {OUT}", "it states no limit")


def body(kind):
    """What a job of A does, every 40; it activates B, and r takes 2."""
    counted = Counter(prescaler=2, offset=1)
    return {
        "a counted call": [ticks(1), Call(runnable="r", counter=counted)],
        "two calls": [ticks(1), Call(runnable="r"), Call(runnable="r")],
        "repeated calls": [ticks(1), Call(runnable="r", times=2)],
        "a trigger": [ticks(1), Trigger(stimulus="B")],
        "a counted trigger": [ticks(1), Trigger(stimulus="B", counter=counted)],
        "two triggers": [ticks(1), Trigger(stimulus="B"), ticks(1), Trigger(stimulus="B")],
    }[kind]


@pytest.mark.parametrize(
    ("kind", "source", "target", "upper", "reaction", "one_to_one"),
    [
        # Each second start is followed by the end of r only in the job after it, 40 later.
        ("a counted call", "A start", "r end", 30, "unknown", "unknown"),
        # A ends twice as often as r starts, but after each start.
        ("a counted call", "r start", "A terminate", 30, "met", "unknown"),
        ("two calls", "A start", "r end", 30, "met", "unknown"),
        ("repeated calls", "A start", "r end", 30, "met", "unknown"),
        ("a trigger", "A start", "B start", 30, "met", "met"),
        ("a counted trigger", "A start", "B start", 30, "unknown", "unknown"),
        ("two triggers", "A start", "B start", 30, "met", "unknown"),
    ],
)
def test_a_delay_of_events_that_do_not_occur_equally_often(kind, source, target, upper, reaction, one_to_one):
    events = (
        *(at("A", START), at("A", END), at("B", START)),
        RunnableEvent(name="r start", runnable="r", change=RunnableChange.START),
        RunnableEvent(name="r end", runnable="r", change=RunnableChange.TERMINATE),
    )
    tasks = [("A", 40, body(kind)), ("B", None, [ticks(2)])]
    stimuli, runnables = [InterProcess(name="B")], [Runnable(name="r", activities=(ticks(2),))]
    built = system(tasks, events, stimuli=stimuli, runnables=runnables)
    delays = [replace(delay(source, target, matching=matching, upper=upper), name=matching) for matching in Matching]
    assert [verdict for _, _, verdict in evaluate(*delays, built=built)] == [reaction, one_to_one, one_to_one]


def test_what_others_activate_too_does_not_belong_to_one_source():
    tasks = [
        ("A", 40, [ticks(1), Trigger(stimulus="B")]),
        ("C", 40, [ticks(1), Trigger(stimulus="B")]),
        ("B", None, [ticks(2)]),
    ]
    built = system(tasks, (at("A", START), at("B", START)), stimuli=[InterProcess(name="B")])
    stated = delay("A start", "B start", matching=Matching.ONE_TO_ONE, upper=99)
    assert evaluate(stated, built=built) == [("delay", None, "unknown")]


def test_a_runnable_that_a_job_executes_several_times_repeats_within_it():
    built = system(
        [("A", 40, body("repeated calls"))],
        [RunnableEvent(name="r start", runnable="r", change=RunnableChange.START)],
        runnables=[Runnable(name="r", activities=(ticks(2),))],
    )
    stated = replace(repetition("r start", lower=30), span=1)
    assert evaluate(stated, built=built) == [("repetition", None, "unknown")]


def test_the_activation_of_the_job_that_reads_answers_nothing():
    # X keeps A off from 0 to 9 or 10, and A keeps B off, which is activated at 0 and at 40: that is 30 or 31 after the start of A.
    tasks = [("X", 120, [ticks(10, 9)]), ("A", 60, [ticks(5)]), ("B", 40, [ticks(1)])]
    built = system(tasks, (at("A", START), at("B", ACTIVATION)))
    assert [verdict for _, _, verdict in evaluate(delay("A start", "B activate", upper=29), built=built)] == ["unknown"]


def test_data_within_a_job_do_not_reach_what_comes_before():
    built = system(
        [("X", 40, [ticks(9, 4)]), ("A", 40, [ticks(3), write("L"), read("L")])], (at("A", START), at("A", ACTIVATION))
    )
    # A starts 4 to 9 after its activation, and is activated 31 to 36 later.
    assert [verdict for _, _, verdict in evaluate(delay("A start", "A activate", upper=30), built=built)] == ["missed"]


# Sensitivity where a latency does not grow with the execution times.


def test_a_factor_covers_all_smaller_ones():
    # Reader starts after Other, 3 us and the time of Other after each release of Writer, which writes after 4 us. While Other takes
    # less than 1 us, Reader misses the data and uses them 10 us later, after 13 us + Other + 0.1 us: above 0.7 us, that is more than
    # 13.8 us. From 1 us on, the latency is short again.
    built = system(
        [
            ("Writer", 100, [ticks(40), write("x")], "one", 0),
            ("Other", 100, [ticks(5)], "two", 30),
            ("Reader", 100, [read("x"), ticks(1)], "two", 30),
        ],
        (at("Writer", START), at("Reader", END)),
        cores=("one", "two"),
        unit=US // 10,
    )
    limit = LatencyConstraint(name="limit", chain="chain", kind=LatencyKind.REACTION, maximum=138 * US // 10)
    built = replace(built, constraints=Constraints(constraints=(limit,)))
    analysis = analyze_system(built)
    assert [str(each.verdict) for each in analysis.requirements] == ["met"]
    assert analyze_system(built, Settings(factors={"Other": Fraction(8, 5)})).summary.schedulable != "yes"
    assert float(sensitivity(analysis).processes["Other"]) == pytest.approx(1.4, rel=2e-3)
