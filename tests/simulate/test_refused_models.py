"""What cannot be simulated is a finding that says why; the other processes are simulated as if it did not exist."""

from dataclasses import replace
from unittest.mock import patch

import pytest
from by_hand import built, when
from hand_made_systems import Proc, request, ticks

from amalthea_uros.perf.activities import (
    Call,
    Case,
    Loop,
    Migrate,
    ModeAccess,
    ModeOperation,
    Receive,
    Send,
    ServerCall,
    ServerCallKind,
    SetEvent,
    Switch,
    Trigger,
    WaitEvent,
)
from amalthea_uros.perf.conditions import ChannelFillIs, ModeAssignment, ModeLabelsAre, ModeValueIs, Relation, Undecided
from amalthea_uros.perf.events import CustomEvent, LabelEvent, ModeLabelEvent, RunnableChange, RunnableEvent
from amalthea_uros.perf.os import Policy, Scheduler
from amalthea_uros.perf.software import Mode, ModeLabel, OsEvent, Runnable
from amalthea_uros.perf.stimuli import Counter, Custom, EventTriggered, Periodic
from amalthea_uros.simulate.kernel import jobs
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import Duration

OTHER = Proc("other", (ticks(2),), 10, priority=1, scheduler="s1")
MODES = {
    "modes": (Mode(name="State", literals=("off", "on")), Mode(name="Number")),
    "mode_labels": (
        ModeLabel(name="state", mode="State", initial="off"),
        ModeLabel(name="number", mode="Number", initial="1"),
        ModeLabel(name="unset", mode="State"),
    ),
}


def value(label, relation, text):
    return ModeValueIs(label=label, relation=relation, value=text)


def loop(comparison):
    return Loop(condition=when(comparison), activities=(ticks(1),))


def refused(model):
    """The finding about what is not simulated; the other process must have been simulated undisturbed."""
    found = simulate_system(model, Options(duration=Duration(95 * US)))
    assert found.processes["other"].jobs == 10
    return [(each.rule, each.message) for each in found.findings if each.rule == "SIM001"]


@pytest.mark.parametrize(
    ("activity", "reason"),
    [
        (Migrate(scheduler="s1"), "it migrates to another scheduler, which is not simulated"),
        (Call(runnable="nowhere"), "the runnable 'nowhere' is not defined in the model"),
        (Call(runnable="itself"), "the runnable 'itself' calls itself"),
        (request("nowhere"), "the semaphore 'nowhere' is not defined in the model"),
        (Trigger(stimulus="nowhere"), "the stimulus 'nowhere' is not defined in the model"),
        (Send(channel="nowhere"), "the channel 'nowhere' is not defined in the model"),
        (Receive(channel="nowhere"), "the channel 'nowhere' is not defined in the model"),
        (WaitEvent(events=("nowhere",)), "the OS event 'nowhere' is not defined in the model"),
        (SetEvent(events=("there",), process="nobody"), "it sets events of 'nobody', which is not simulated"),
        (
            ModeAccess(label="nowhere", operation=ModeOperation.INCREMENT),
            "the mode label 'nowhere' is not defined in the model",
        ),
        (ModeAccess(label="state", operation=ModeOperation.SET), "it sets the mode label 'state' to nothing"),
        (
            ModeAccess(label="number", operation=ModeOperation.SET, value="on"),
            "the value 'on' of the mode label 'number' is no whole number, or too large",
        ),
        (Loop(activities=(ticks(1),)), "a loop has no condition"),
        (Switch(cases=(Case(activities=()),)), "a branch of a switch has no condition"),
        (loop(Undecided(reason="it has no operator")), "a condition cannot be decided: it has no operator"),
        (
            loop(value("state", Relation.LESS, "on")),
            "the literals of the mode label 'state' have no order, but are compared by <",
        ),
        (
            loop(value("unset", Relation.EQUAL, "on")),
            "the mode label 'unset', on which a condition depends, has no initial value",
        ),
        (
            loop(ModeLabelsAre(first="state", relation=Relation.EQUAL, second="number")),
            "the mode labels 'state' and 'number' are compared, but have different modes",
        ),
        (
            loop(ModeLabelsAre(first="nowhere", relation=Relation.EQUAL, second="neither")),
            "the mode label 'nowhere' is not defined in the model",
        ),
        (
            loop(ChannelFillIs(channel="nowhere", relation=Relation.EQUAL, level=1)),
            "the channel 'nowhere' is not defined in the model",
        ),
        (
            Call(runnable="r", counter=Counter(prescaler=0)),
            "the counter of the call of 'r' has the prescaler 0, which has no meaning",
        ),
        (
            ServerCall(runnable="r", kind=ServerCallKind.GET_RESULT),
            "it waits for the server runnable 'r', which no process executes",
        ),
        (ServerCall(runnable="r", kind=ServerCallKind.ASYNCHRONOUS), "no process executes the server runnable 'r'"),
    ],
)
def test_an_activity_that_cannot_be_simulated(activity, reason):
    runnables = (
        Runnable(name="itself", activities=(ticks(1), Call(runnable="itself"))),
        Runnable(name="r", activities=(ticks(1),)),
    )
    task = Proc("T", (ticks(1), activity), 10, priority=1)
    model = built(
        task, OTHER, runnables=runnables, os_events=(OsEvent(name="there"),), stimuli=(Custom(name="timer"),), **MODES
    )
    assert refused(model) == [("SIM001", f"'T' is not simulated: {reason}")]


@pytest.mark.parametrize(
    ("stimulus", "reason"),
    [
        (
            Periodic(name="timer", period=10 * US, condition=when(value("unset", Relation.EQUAL, "on"))),
            "the mode label 'unset', on which a condition depends, has no initial value",
        ),
        (
            Periodic(name="timer", period=10 * US, assignments=(ModeAssignment(label="nowhere", value="on"),)),
            "the mode label 'nowhere' is not defined in the model",
        ),
    ],
)
def test_a_stimulus_that_cannot_be_simulated(stimulus, reason):
    model = built(Proc("T", (ticks(1),), stimuli=("timer",), priority=1), OTHER, stimuli=(stimulus,), **MODES)
    assert refused(model) == [("SIM001", f"'T' is not simulated: {reason}")]


@pytest.mark.parametrize(
    ("event", "reason"),
    [
        (RunnableEvent(name="e", runnable="r", change=RunnableChange.SUSPEND), "the rate of the event 'e' is unbounded"),
        (ModeLabelEvent(name="e", label="state"), "stimuli also raise the event 'e'"),
        (CustomEvent(name="e"), "no activity in the model raises the event 'e'"),
        (CustomEvent(name="another"), "the event 'e' is not defined in the model"),
        (LabelEvent(name="e", label="nowhere"), "no activity in the model raises an event of the stimulus 'reacts'"),
    ],
)
def test_events_of_a_stimulus_that_also_occur_elsewhere_or_nowhere(event, reason):
    assigning = Periodic(name="assigning", period=10 * US, assignments=(ModeAssignment(label="state", value="on"),))
    stimuli = (EventTriggered(name="reacts", events=("e",)), assigning)
    task = Proc("T", (ticks(1),), stimuli=("reacts",), priority=1)
    calls = Proc("other", (Call(runnable="r"),), 10, priority=1, scheduler="s1")
    parts = {"runnables": (Runnable(name="r", activities=(ticks(2),)),), "events": (event,), **MODES}
    assert refused(built(task, calls, stimuli=stimuli, **parts)) == [("SIM001", f"'T' is not simulated: {reason}")]


def test_a_policy_that_is_not_known():
    schedulers = [
        Scheduler(name=f"s{n}", policy=policy, cores=(f"c{n}",)) for n, policy in enumerate((Policy.PFAIR, Policy.OSEK))
    ]
    (found,) = refused(built(Proc("T", (ticks(1),), 10, priority=1), OTHER, schedulers=schedulers))
    assert found[1] == "'T' is not simulated: there is no analysis for the policy PfairPD2 of its scheduler 's0'"


def test_a_task_that_is_allocated_twice():
    model = built(Proc("T", (ticks(1),), 10, priority=1), OTHER)
    first = model.mapping.tasks[0]
    twice = replace(model, mapping=replace(model.mapping, tasks=(*model.mapping.tasks, replace(first, scheduler="s1"))))
    assert refused(twice) == [("SIM001", "'T' is not simulated: it is allocated more than once")]


def test_what_sets_events_of_a_process_that_is_not_simulated_is_not_simulated_either():
    waits = Proc("waits", (Migrate(scheduler="s1"), ticks(1)), 10, priority=1)
    sets = Proc("sets", (ticks(1), SetEvent(events=("there",), process="waits")), 10, priority=2)
    found = refused(built(waits, sets, OTHER, os_events=(OsEvent(name="there"),)))
    assert [message for _, message in found] == [
        "'waits' is not simulated: it migrates to another scheduler, which is not simulated",
        "'sets' is not simulated: it sets events of 'waits', which is not simulated",
    ]


def test_a_loop_that_takes_no_time_and_does_not_end_ends_the_run():
    # The loop begins in the job at 20, after which nothing can be simulated any more.
    body = (
        ticks(1),
        ModeAccess(label="number", operation=ModeOperation.INCREMENT),
        Loop(
            condition=when(value("number", Relation.GREATER, "3")),
            activities=(ModeAccess(label="state", operation=ModeOperation.INCREMENT),),
        ),
    )
    with patch.object(jobs, "MOST_STEPS", 1000):
        found = simulate_system(built(Proc("T", body, 10, priority=1), OTHER, **MODES), Options(duration=Duration(95 * US)))
    assert [(each.rule, each.message) for each in found.findings] == [
        ("SIM003", "at 21 us, 'T' executes activities forever without taking time; the run ends there")
    ]
    assert (found.processes["T"].jobs, found.processes["other"].jobs) == (2, 2)
    # Nothing counts as late because of the time that was not simulated.
    assert found.processes["T"].longest_unfinished == 1 * US
