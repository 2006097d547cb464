"""What simulated systems do with events, runnables and labels, and the verdicts on constraints of them."""

from dataclasses import replace

import hand_made_systems
import pytest
from hand_made_systems import Proc, ticks

from amalthea_uros.judge.verdict import ObservedVerdict
from amalthea_uros.perf.activities import (
    AccessKind,
    Call,
    Chance,
    Communication,
    LabelAccess,
    ProbabilitySwitch,
    RaiseEvent,
    SemaphoreAccess,
    SemaphoreOperation,
    Trigger,
)
from amalthea_uros.perf.constraints import (
    ChainEnd,
    ChainSynchronization,
    Constraints,
    CountLimit,
    CountMetric,
    DataAgeConstraint,
    DelayConstraint,
    EventSynchronization,
    OrderConstraint,
    Ordering,
    RepetitionConstraint,
    Requirement,
    TimeLimit,
    TimeMetric,
)
from amalthea_uros.perf.events import (
    CustomEvent,
    EventChain,
    EventSet,
    LabelChange,
    LabelEvent,
    ProcessChange,
    ProcessEvent,
    RunnableChange,
    RunnableEvent,
    SemaphoreChange,
    SemaphoreEvent,
    StimulusEvent,
)
from amalthea_uros.perf.os import Semaphore
from amalthea_uros.perf.software import Label, Runnable
from amalthea_uros.perf.stimuli import Counter, Periodic, Stimuli
from amalthea_uros.simulate.kernel import machine_code
from amalthea_uros.simulate.options import ALL_LABELS, Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import Duration

OK, MISSED, NOT_OBSERVED = ObservedVerdict.OK, ObservedVerdict.MISSED, ObservedVerdict.NOT_OBSERVED


def access(label, kind, communication=None):
    return LabelAccess(label=label, kind=AccessKind(kind), communication=communication)


def system(bodies, *, periods, runnables=None, offsets=None, cores=None, events=(), chains=(), **demanded):
    """Tasks at 1 MHz, the first one the most urgent; `periods` in milliseconds, a task without one is triggered."""
    runnables, offsets, cores = runnables or {}, offsets or {}, cores or {}
    processes = [
        Proc(
            name,
            tuple(body),
            periods.get(name, 0) * 1000,
            offsets.get(name, 0),
            stimuli=() if name in periods else (f"go {name}",),
            priority=len(bodies) - number,
            scheduler=f"s{cores.get(name, 'c0')[1:]}",
            task={"activation_limit": 9},
        )
        for number, (name, body) in enumerate(bodies.items())
    ]
    every = [activity for body in (*bodies.values(), *runnables.values()) for activity in body]
    labels = dict.fromkeys(each.label for each in every if isinstance(each, LabelAccess))
    model = hand_made_systems.system(
        *processes,
        triggers=[f"go {name}" for name in bodies if name not in periods],
        runnables=tuple(Runnable(name=name, activities=tuple(body)) for name, body in runnables.items()),
        labels=tuple(Label(name=name) for name in labels),
        semaphores=(Semaphore(name="mutex"),),
        events=tuple(events),
        chains=chains,
    )
    return replace(model, constraints=Constraints(**demanded))


def simulated(model, milliseconds=100, labels=(), communication=None):
    options = Options(duration=Duration(milliseconds * MS), labels=labels, settings=Settings(communication=communication))
    return simulate_system(model, options)


def verdicts(model, **options):
    return [(each.quantity, each.value, each.verdict) for each in simulated(model, **options).requirements]


# Where events occur: from the start of a process of 10 ms to each of them


BODIES = {
    "High": [ticks(100)],
    "Low": [
        ticks(200),
        SemaphoreAccess(semaphore="mutex", operation=SemaphoreOperation.REQUEST),
        ticks(100),
        Call(runnable="Step"),
        SemaphoreAccess(semaphore="mutex", operation=SemaphoreOperation.RELEASE),
        Trigger(stimulus="go Next"),
        RaiseEvent(event="custom"),
    ],
    "Next": [ticks(50)],
}
#: Step writes 30 us after its start at 400 us; High, which comes 150 us after Low, takes 100 us in between.
RUNNABLES = {"Step": [ticks(30), access("x", "write"), ticks(20)]}


@pytest.mark.parametrize(
    ("event", "time"),
    [
        (ProcessEvent(name="e", process="Low", change=ProcessChange.ACTIVATE), 0),
        (ProcessEvent(name="e", process="Low", change=ProcessChange.START), 0),
        (ProcessEvent(name="e", process="Low", change=ProcessChange.PREEMPT), 150),
        (ProcessEvent(name="e", process="Low", change=ProcessChange.RESUME), 250),
        (ProcessEvent(name="e", process="Low", change=ProcessChange.TERMINATE), 450),
        (ProcessEvent(name="e", process="Low", change=ProcessChange.RESUME, core="c0"), 250),
        (ProcessEvent(name="e", process="High"), 150),
        (StimulusEvent(name="e", stimulus="High_tick"), 150),
        (StimulusEvent(name="e", stimulus="go Next"), 450),
        (SemaphoreEvent(name="e", semaphore="mutex", change=SemaphoreChange.LOCK), 300),
        (SemaphoreEvent(name="e", semaphore="mutex", change=SemaphoreChange.UNLOCK, process="Low", core="c0"), 450),
        (RunnableEvent(name="e", runnable="Step", change=RunnableChange.START), 400),
        (RunnableEvent(name="e", runnable="Step", change=RunnableChange.TERMINATE, process="Low"), 450),
        (RunnableEvent(name="e", change=RunnableChange.TERMINATE, core="c0"), 450),
        (LabelEvent(name="e", label="x", change=LabelChange.WRITE, runnable="Step"), 430),
        (LabelEvent(name="e", label="x", process="Low"), 430),
        (CustomEvent(name="custom"), 450),
        (EventSet(name="e", events=("high", "next")), 450),
    ],
)
def test_the_delay_up_to_an_event(event, time):
    begin = ProcessEvent(name="begin", process="Low", change=ProcessChange.ACTIVATE)
    high = ProcessEvent(name="high", process="High", change=ProcessChange.START)
    after = ProcessEvent(name="next", process="Next", change=ProcessChange.ACTIVATE)
    constraint = DelayConstraint(name="D", source="begin", target=event.name, upper=time * US)
    model = system(
        BODIES,
        periods={"High": 10, "Low": 10},
        offsets={"High": 150},
        runnables=RUNNABLES,
        events=(begin, high, after, event),
        constraints=(constraint,),
    )
    assert verdicts(model) == [("delay", time * US, OK)]


@pytest.mark.parametrize(
    "event",
    [
        ProcessEvent(name="e", process="Low", change=ProcessChange.START, core="c1"),
        LabelEvent(name="e", label="x", change=LabelChange.READ),
        LabelEvent(name="e", label="x", process="High"),
        RunnableEvent(name="e", runnable="Step", change=RunnableChange.SUSPEND),
        ProcessEvent(name="another", process="Low", change=ProcessChange.START),
    ],
)
def test_what_does_not_occur_is_not_observed(event):
    constraint = RepetitionConstraint(name="R", event="e", lower=1)
    model = system(BODIES, periods={"High": 10, "Low": 10}, runnables=RUNNABLES, events=(event,), constraints=(constraint,))
    ((_, value, verdict),) = verdicts(model)
    assert (value, verdict) == (None, NOT_OBSERVED)


def test_the_same_runnable_on_two_cores_is_told_apart_by_its_core():
    bodies = {"A": [Call(runnable="Step")], "B": [ticks(7), Call(runnable="Step")]}
    events = (
        RunnableEvent(name="first", runnable="Step", change=RunnableChange.START, core="c0"),
        RunnableEvent(name="second", runnable="Step", change=RunnableChange.START, core="c1"),
    )
    model = system(
        bodies,
        periods={"A": 10, "B": 10},
        cores={"A": "c0", "B": "c1"},
        runnables={"Step": [ticks(1)]},
        events=events,
        constraints=(EventSynchronization(name="S", events=("first", "second"), tolerance=6 * US),),
    )
    (found,) = simulated(model).requirements
    assert (found.object, found.quantity, found.value, found.verdict) == ("first, second", "spread", 7 * US, MISSED)
    assert found.at == 0


def test_the_ends_of_two_chains():
    bodies = {"A": [ticks(100)], "B": [ticks(50)]}
    events = [
        ProcessEvent(name=f"{change} {name}", process=name, change=ProcessChange(change))
        for name in bodies
        for change in ("start", "terminate")
    ]
    chains = [EventChain(name=name, stimulus=f"start {name}", response=f"terminate {name}") for name in bodies]
    constraints = [
        ChainSynchronization(name=end, chains=("A", "B"), tolerance=100 * US, end=end, every_occurrence=every)
        for end in ChainEnd
        for every in (False, True)
    ]
    model = system(bodies, periods={"A": 10, "B": 10}, events=events, chains=chains, constraints=tuple(constraints))
    # B starts when A ends, 100 us after A; it ends 50 us later.
    spreads = [("spread at the stimulus", 100 * US, OK)] * 2 + [("spread at the response", 50 * US, OK)] * 2
    assert verdicts(model) == spreads


def test_a_constraint_without_limits_is_not_observed():
    event = ProcessEvent(name="e", process="Low", change=ProcessChange.START)
    constraint = DelayConstraint(name="D", source="e", target="e")
    model = system(BODIES, periods={"High": 10, "Low": 10}, runnables=RUNNABLES, events=(event,), constraints=(constraint,))
    (found,) = simulated(model).requirements
    assert (found.verdict, found.reason) == (NOT_OBSERVED, "it states no limit")


@pytest.mark.early
def test_events_are_observed_alike_by_machine_code(monkeypatch):
    pytest.importorskip("numba")
    event = ProcessEvent(name="e", change=ProcessChange.RESUME)
    limit = TimeLimit(metric=TimeMetric.RUNNING_TIME, value=MS)
    model = system(
        BODIES,
        periods={"High": 3, "Low": 10},
        runnables=RUNNABLES,
        events=(event, StimulusEvent(name="s")),
        constraints=(
            RepetitionConstraint(name="R", event="e", lower=1, upper=MS, jitter=MS),
            RepetitionConstraint(name="S", event="s", lower=1, upper=MS),
        ),
        requirements=(Requirement(name="Q", runnable="Step", limit=limit),),
    )
    interpreted = simulated(model, labels=(ALL_LABELS,))
    monkeypatch.setattr(machine_code, "is_worth_it", lambda _seconds, _left: True)
    assert simulated(model, labels=(ALL_LABELS,)) == interpreted


def test_activations_that_no_job_follows_fill_no_more_than_there_is_place_for():
    """More occurrences than are kept at a time, while one job executes."""
    bodies = {"Long": [ticks(60_000)], "Short": [ticks(1)]}
    event = StimulusEvent(name="s", stimulus="Short_tick")
    model = system(bodies, periods={"Long": 1000, "Short": 1}, events=(event,), constraints=(repetition_of("s"),))
    often = Periodic(name="Short_tick", period=2 * US)
    model = replace(model, stimuli=Stimuli(stimuli=(model.stimuli.stimuli[0], often)))
    (found,) = simulated(model, milliseconds=60).requirements
    assert (found.value, found.verdict) == (2 * US, OK)


def repetition_of(event):
    return RepetitionConstraint(name="R", event=event, upper=2 * US)


# Order of runnables


@pytest.mark.parametrize(
    ("called", "ordering", "verdict"),
    [
        ("abc", Ordering.SUCCESSOR, OK),
        ("axc", Ordering.SUCCESSOR, MISSED),
        ("axbc", Ordering.SUCCESSOR, OK),
        ("axbc", Ordering.IMMEDIATE_ANYWHERE, MISSED),
        ("xab", Ordering.IMMEDIATE_AT_END, OK),
        ("abx", Ordering.IMMEDIATE_AT_END, MISSED),
        ("xabc", Ordering.IMMEDIATE_AT_START, MISSED),
        ("ba", Ordering.SUCCESSOR, MISSED),
    ],
)
def test_the_order_of_runnables(called, ordering, verdict):
    order = OrderConstraint(name="O", groups=(("a",), ("b",)), ordering=ordering)
    bodies = {"Task": [Call(runnable=name) for name in called], "Other": [Call(runnable="x")]}
    runnables = {name: [ticks(1)] for name in "abcx"}
    model = system(bodies, periods={"Task": 10, "Other": 10}, runnables=runnables, orders=(order,))
    (found,) = simulated(model).requirements
    assert (found.object, found.quantity, found.verdict) == ("Task", "order of runnables", verdict)
    if verdict is MISSED:
        assert found.reason == "10 of 10 jobs in another order"


def test_only_the_jobs_in_another_order_are_wrong():
    branches = [Chance(weight=1, activities=(Call(runnable=a), Call(runnable=b))) for a, b in ("ab", "ba")]
    model = system(
        {"Task": [ProbabilitySwitch(branches=tuple(branches))]},
        periods={"Task": 1},
        runnables={"a": [ticks(1)], "b": [ticks(1)]},
        orders=(OrderConstraint(name="O", groups=(("a",), ("b",))),),
    )
    (found,) = simulated(model).requirements
    wrong, jobs = (int(found.reason.split()[index]) for index in (0, 2))
    assert (found.verdict, jobs) == (MISSED, 100)
    assert 20 < wrong < 80


# Runnables


def test_the_times_of_a_runnable():
    """Step begins 400 us after the activation of its job; High takes 100 us of it, and then it takes 50 us itself."""
    limits = {
        TimeMetric.RESPONSE_TIME: 550,
        TimeMetric.START_DELAY: 400,
        TimeMetric.GROSS_EXECUTION_TIME: 150,
        TimeMetric.NET_EXECUTION_TIME: 50,
        TimeMetric.RUNNING_TIME: 50,
        TimeMetric.READY_TIME: 100,
        TimeMetric.START_TO_START: 10_000,
    }
    requirements = [
        Requirement(name="R", runnable="Step", limit=TimeLimit(metric=metric, value=value * US))
        for metric, value in limits.items()
    ]
    requirements.append(Requirement(name="R", runnable="Step", limit=CountLimit(metric=CountMetric.PREEMPTIONS, value=0)))
    bodies = {"High": [ticks(100)], "Low": [ticks(400), Call(runnable="Step")]}
    model = system(
        bodies,
        periods={"High": 10, "Low": 10},
        offsets={"High": 420},
        runnables={"Step": [ticks(50)]},
        requirements=tuple(requirements),
    )
    simulation = simulated(model)
    expected = [(value * US, OK) for value in limits.values()]
    assert [(each.value, each.verdict) for each in simulation.requirements] == [*expected, (1, MISSED)]
    (step,) = simulation.runnables
    assert (step.executions, step.preemptions.total) == (10, 10)
    assert step.metrics[JobMetric.RESPONSE_TIME].mean == 550 * US


def test_calls_that_a_counter_skips_are_no_executions():
    bodies = {"Task": [Call(runnable="Step", counter=Counter(prescaler=5))]}
    limit = TimeLimit(metric=TimeMetric.NET_EXECUTION_TIME, value=MS)
    model = system(
        bodies,
        periods={"Task": 10},
        runnables={"Step": [ticks(50)]},
        requirements=(Requirement(name="R", runnable="Step", limit=limit),),
    )
    assert simulated(model).runnables["Step"].executions == 2


# Labels


def reader_and_writer(communication, **options):
    """A writer of 10 ms that writes after 100 of 200 us; a reader of 5 ms, 50 us later, that reads after 30 us."""
    bodies = {
        "Reader": [ticks(30), access("x", "read", communication), ticks(30)],
        "Writer": [ticks(100), access("x", "write", communication), ticks(100)],
    }
    model = system(
        bodies, periods={"Reader": 5, "Writer": 10}, offsets={"Reader": 50}, cores={"Reader": "c0", "Writer": "c1"}, **options
    )
    return simulated(model, labels=("x",), milliseconds=40)


@pytest.mark.parametrize(
    ("communication", "least", "unwritten"),
    [
        # Reads at 80 and 5080 us; the write at 100 us, or (at 200) the end of its job, are between them.
        (Communication.EXPLICIT, 4980, 1),
        (Communication.IMPLICIT, 4980, 1),
        # The write is there at 10 ms: both reads after that see it.
        (Communication.LET, 9980, 2),
    ],
)
def test_the_age_of_what_is_read(communication, least, unwritten):
    (label,) = reader_and_writer(communication).labels
    assert (label.name, label.reads, label.writes, label.unwritten_reads, label.overwritten) == ("x", 8, 4, unwritten, 0)
    assert label.age.count == 8 - unwritten
    assert (label.age.min, label.age.max) == (least * US, (least + 5000) * US)


def test_the_settings_decide_about_communication():
    body = [access("x", "read", Communication.LET), ticks(10), access("x", "write", Communication.LET)]
    model = system({"Task": body}, periods={"Task": 10})
    found = {how: simulated(model, labels=(ALL_LABELS,), communication=how).labels["x"] for how in (None, *Communication)}
    # Each job reads what the one before it has written, 10 us before its end at 10 us after its release.
    assert {how: label.age.max for how, label in found.items()} == dict.fromkeys(found, (10_000 - 10) * US)


@pytest.mark.parametrize("first", ["Reader", "Writer"])
def test_at_a_common_release_what_is_written_under_let_is_there_before_anybody_reads(first):
    bodies = {
        "Reader": [access("x", "read", Communication.LET), ticks(1)],
        "Writer": [ticks(2), access("x", "write", Communication.LET)],
    }
    order = [first, *(name for name in bodies if name != first)]
    cores = {"Reader": "c0", "Writer": "c1"}
    model = system({name: bodies[name] for name in order}, periods=dict.fromkeys(bodies, 1), cores=cores)
    label = simulated(model, labels=("x",), milliseconds=10).labels["x"]
    # Each job reads at its start what was written 2 us after the release before.
    assert (label.unwritten_reads, label.age.min, label.age.max) == (1, 998 * US, 998 * US)


def test_a_job_reads_its_own_implicit_write_but_not_under_let():
    body = [ticks(5), access("x", "write"), ticks(10), access("x", "read")]
    model = system({"Task": body}, periods={"Task": 10})
    ages = {how: simulated(model, labels=("x",), communication=how).labels["x"].age.max for how in Communication}
    assert ages == {Communication.EXPLICIT: 10 * US, Communication.IMPLICIT: 10 * US, Communication.LET: (10_000 + 10) * US}


def test_values_that_nobody_has_read_before_they_are_replaced():
    bodies = {"Writer": [access("x", "write"), ticks(1)], "Reader": [access("x", "read"), ticks(1)]}
    model = system(bodies, periods={"Writer": 1, "Reader": 4}, offsets={"Reader": 500})
    label = simulated(model, labels=("x",), milliseconds=8).labels["x"]
    # Written 8 times, read at 0.5 and 4.5 ms; the last value is not overwritten in the run.
    assert (label.reads, label.writes, label.overwritten) == (2, 8, 5)


def test_labels_are_observed_on_request_only():
    model = system({"Task": [access("x", "write"), ticks(1)]}, periods={"Task": 1})
    assert simulated(model).labels == ()


# Data ages


def test_the_age_of_what_a_runnable_writes():
    bodies = {
        "Reader": [ticks(30), access("x", "read", Communication.EXPLICIT)],
        "Writer": [Call(runnable="Write"), ticks(100)],
    }
    ages = (
        DataAgeConstraint(name="time", runnable="Write", label="x", earliest=30 * US, latest=2 * MS),
        DataAgeConstraint(name="cycles", runnable="Write", label="x", earliest_cycle=0, latest_cycle=0),
        DataAgeConstraint(name="nobody", runnable="Reader", label="x", latest=MS),
    )
    model = system(
        bodies,
        periods={"Reader": 5, "Writer": 10},
        offsets={"Reader": 1000},
        runnables={"Write": [ticks(10), access("x", "write", Communication.EXPLICIT)]},
        data_ages=ages,
    )
    # Writes at 10 us, reads at 1030 and 6030 us, in each 10 ms.
    found = [(each.object, each.quantity, each.value, each.verdict) for each in simulated(model).requirements]
    assert found == [
        ("x in Reader", "data age", 6020 * US, MISSED),
        ("x in Reader", "data age", 1020 * US, OK),
        ("x in Reader", "data age in cycles", 0, OK),
        ("x in Reader", "data age in cycles", 0, OK),
        ("x", "data age", None, NOT_OBSERVED),
    ]


def test_an_age_in_cycles_counts_activations_of_the_writer():
    bodies = {
        "Writer": [Call(runnable="Write", counter=Counter(prescaler=3)), ticks(1)],
        "Reader": [access("x", "read"), ticks(1)],
    }
    age = DataAgeConstraint(name="A", runnable="Write", label="x", earliest_cycle=0, latest_cycle=1)
    model = system(
        bodies,
        periods={"Writer": 1, "Reader": 1},
        offsets={"Reader": 500},
        runnables={"Write": [access("x", "write")]},
        data_ages=(age,),
    )
    assert verdicts(model) == [("data age in cycles", 2, MISSED), ("data age in cycles", 0, OK)]
