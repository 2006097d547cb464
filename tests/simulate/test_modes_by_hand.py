"""Modes, channels, conditions and counters: schedules derived by hand."""

import pytest
from by_hand import built, play, when
from hand_made_systems import READ, WRITE, Proc, access, ticks

from amalthea_uros.perf.activities import (
    Call,
    Case,
    Count,
    Loop,
    ModeAccess,
    ModeOperation,
    RaiseEvent,
    Receive,
    ReceiveOperation,
    Send,
    Switch,
    Trigger,
)
from amalthea_uros.perf.conditions import ChannelFillIs, Condition, ModeAssignment, ModeLabelsAre, ModeValueIs, Relation
from amalthea_uros.perf.events import (
    CustomEvent,
    EventChain,
    LabelChange,
    LabelEvent,
    ProcessChange,
    ProcessEvent,
    RunnableChange,
    RunnableEvent,
)
from amalthea_uros.perf.software import Channel, Label, Mode, ModeLabel, Runnable
from amalthea_uros.perf.stimuli import Counter, EventTriggered, InterProcess, Periodic
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import Duration

STATE = Mode(name="State", literals=("off", "slow", "fast"))
NUMBER = Mode(name="Number")
TASK = {"priority": 1}


def is_(label, value, relation=Relation.EQUAL):
    return ModeValueIs(label=label, relation=relation, value=value)


def change(operation, label, step=1, value=None):
    return ModeAccess(label=label, operation=operation, step=step, value=value)


def durations(jobs):
    return [end - activation for activation, _, end in jobs]


def by_state(label, *lengths):
    """Executes as long as the value of a label says, the last one if it has no length."""
    cases = zip(STATE.literals, lengths, strict=False)
    return Switch(
        cases=tuple(Case(condition=when(is_(label, literal)), activities=(ticks(length),)) for literal, length in cases),
        default=(ticks(lengths[-1]),),
    )


def test_an_enumeration_ends_at_its_first_and_its_last_literal():
    # Up one each time: off, slow, fast, fast; then in one step down to off.
    up = Proc("up", (by_state("state", 1, 2, 3), change(ModeOperation.INCREMENT, "state")), 10, **TASK)
    down = Proc("down", (ticks(1), change(ModeOperation.DECREMENT, "state", 5)), 100, 35, priority=2)
    found = play(built(up, down, modes=(STATE,), mode_labels=(ModeLabel(name="state", mode="State", initial="off"),)), 60)
    assert durations(found["up"]) == [1, 2, 3, 3, 1, 2]


def test_numbers_have_no_end_and_are_compared_by_their_order():
    # n is 0, 2, 4, 6: the job executes 1 tick as long as n < 5, then 4 ticks.
    condition = when(is_("n", "5", Relation.LESS))
    body = (
        Switch(cases=(Case(condition=condition, activities=(ticks(1),)),), default=(ticks(4),)),
        change(ModeOperation.INCREMENT, "n", 2),
    )
    found = play(
        built(Proc("T", body, 10, **TASK), modes=(NUMBER,), mode_labels=(ModeLabel(name="n", mode="Number", initial="0"),)), 40
    )
    assert durations(found["T"]) == [1, 1, 1, 4]


def test_a_loop_over_a_number_is_repeated_while_its_condition_holds():
    # Three passes of 2 ticks each in the first job; afterwards n is 0, and there is none.
    body = (
        ticks(1),
        Loop(condition=when(is_("n", "0", Relation.GREATER)), activities=(ticks(2), change(ModeOperation.DECREMENT, "n"))),
    )
    labels = (ModeLabel(name="n", mode="Number", initial="3"),)
    found = play(built(Proc("T", body, 10, **TASK), modes=(NUMBER,), mode_labels=labels), 30)
    assert durations(found["T"]) == [7, 1, 1]


def test_the_first_branch_that_holds_is_taken():
    # (a == b) or (a == slow and b == fast): off/off 2; slow/off neither 1; slow/fast 2; and what follows is not tested any more.
    either = Condition(
        (
            (ModeLabelsAre(first="a", relation=Relation.EQUAL, second="b"),),
            (is_("a", "slow"), is_("b", "fast")),
        )
    )
    switch = Switch(
        cases=(Case(condition=either, activities=(ticks(2),)), Case(condition=when(is_("b", "fast")), activities=(ticks(5),))),
        default=(ticks(1),),
    )
    setters = [
        Proc("a", (ticks(1), change(ModeOperation.SET, "a", value="slow")), 1000, 5, priority=2),
        Proc("b", (ticks(1), change(ModeOperation.SET, "b", value="fast")), 1000, 15, priority=2),
    ]
    labels = [ModeLabel(name=name, mode="State", initial="off") for name in "ab"]
    found = play(built(Proc("T", (switch,), 10, **TASK), *setters, modes=(STATE,), mode_labels=labels), 30)
    assert durations(found["T"]) == [2, 1, 2]


def test_a_stimulus_assigns_modes_only_if_its_condition_holds():
    # `on` occurs at 0, 20, 40 while the state is off: at 0 it sets fast, so that it does not occur at 20; `reset` sets off at 30.
    on = Periodic(
        name="on",
        period=20 * US,
        condition=when(is_("state", "off")),
        assignments=(ModeAssignment(label="state", value="fast"),),
    )
    reset = Periodic(name="reset", period=1000 * US, offset=30 * US, assignments=(ModeAssignment(label="state", value="off"),))
    task = Proc("T", (by_state("state", 1, 2, 3),), stimuli=("on",), **TASK)
    labels = (ModeLabel(name="state", mode="State", initial="off"),)
    found = play(built(task, stimuli=(on, reset), modes=(STATE,), mode_labels=labels), 60)
    # The assignment precedes the activation: the job sees fast.
    assert found["T"] == [(0, 0, 3), (40, 40, 43)]


def test_a_runnable_whose_condition_is_false_is_not_executed():
    runnable = Runnable(name="r", activities=(ticks(3),), condition=when(is_("state", "fast")))
    body = (ticks(1), Call(runnable="r"), change(ModeOperation.INCREMENT, "state"))
    labels = (ModeLabel(name="state", mode="State", initial="off"),)
    found = play(built(Proc("T", body, 10, **TASK), runnables=(runnable,), modes=(STATE,), mode_labels=labels), 40)
    assert durations(found["T"]) == [1, 1, 4, 4]


@pytest.mark.parametrize(("operation", "filled"), [(ReceiveOperation.FIFO_READ, 5), (ReceiveOperation.LIFO_TAKE, 3)])
def test_reading_leaves_elements_in_a_channel_and_taking_does_not(operation, filled):
    # 1 + 2 * 2 elements have been sent at 12; the receiver gets 2 at 15. The length of the job at 20 shows the number.
    sender = Proc("sender", (ticks(1), Send(channel="c", elements=2)), 10, **TASK)
    receiver = Proc("receiver", (ticks(1), Receive(channel="c", elements=2, operation=operation)), 1000, 15, **TASK)
    cases = tuple(
        Case(condition=when(ChannelFillIs(channel="c", relation=Relation.EQUAL, level=level)), activities=(ticks(level),))
        for level in range(1, 9)
    )
    measure = Proc("measure", (Switch(cases=cases),), 1000, 20, priority=2)
    found = play(built(sender, receiver, measure, channels=(Channel(name="c", default_elements=1),)), 30)
    assert durations(found["measure"]) == [filled]


def test_a_full_channel_takes_no_more_and_counts_what_is_lost():
    # At 1 there are 2 elements; 2 more at 11 are one too many for 3 places, and at 21 none of 2 fits.
    sender = Proc("sender", (ticks(1), Send(channel="c", elements=2)), 10, **TASK)
    model = built(sender, channels=(Channel(name="c", capacity=3),))
    found = simulate_system(model, Options(duration=Duration(30 * US)))
    assert [(each.rule, each.message) for each in found.findings] == [("SIM004", "the channel 'c' was full: 3 elements lost")]


def test_the_counters_of_a_trigger_and_of_its_stimulus_follow_each_other():
    # The trigger fires in jobs 2, 4, 6, 8, ...; the stimulus takes the 1st, 4th, 7th of these: jobs 2, 8, 14, at 10, 70, 130.
    fires = Proc("fires", (ticks(1), Trigger(stimulus="go", counter=Counter(prescaler=2, offset=2))), 10, priority=2)
    stimulus = InterProcess(name="go", counter=Counter(prescaler=3, offset=1))
    then = Proc("then", (ticks(1),), stimuli=("go",), **TASK)
    found = play(built(fires, then, stimuli=(stimulus,)), 150)
    assert [activation for activation, _, _ in found["then"]] == [11, 71, 131]


@pytest.mark.parametrize(
    ("event", "activations"),
    [
        # The job: 2 ticks, a call of 3 ticks, 1 tick, a write, 1 tick, the custom event.
        (RunnableEvent(name="e", runnable="r", change=RunnableChange.START), [2, 22, 42]),
        (RunnableEvent(name="e", runnable="r", change=RunnableChange.TERMINATE), [5, 25, 45]),
        (LabelEvent(name="e", label="data", change=LabelChange.WRITE), [6, 26, 46]),
        (CustomEvent(name="e"), [7, 27, 47]),
    ],
)
def test_stimuli_react_to_events(event, activations):
    body = (
        access("data", READ),
        ticks(2),
        Call(runnable="r"),
        ticks(1),
        access("data", WRITE),
        ticks(1),
        RaiseEvent(event="e"),
        ticks(1),
    )
    reacts = EventTriggered(name="reacts", events=("e",))
    rarely = EventTriggered(name="rarely", events=("e",), counter=Counter(prescaler=2, offset=2))
    then = Proc("then", (ticks(1),), stimuli=("reacts",), priority=1, scheduler="s1")
    second = Proc("second", (ticks(1),), stimuli=("rarely",), priority=2, scheduler="s1")
    parts = {"runnables": (Runnable(name="r", activities=(ticks(3),)),), "labels": (Label(name="data"),), "events": (event,)}
    found = play(built(Proc("T", body, 20, **TASK), then, second, stimuli=(reacts, rarely), **parts), 60)
    assert [activation for activation, _, _ in found["then"]] == activations
    assert [activation for activation, _, _ in found["second"]] == [activations[1]]


@pytest.mark.parametrize(
    ("repeated", "seconds"),
    [
        # Counting leaves out four calls of five, which then raise no event.
        ({"counter": Counter(prescaler=5, offset=1)}, 20),
        # A call that stands for three raises its events each time.
        ({"times": Count(least=3, mean=3, most=3)}, 300),
    ],
)
def test_a_call_raises_its_events_as_often_as_it_takes_place(repeated, seconds):
    """The task calls a runnable every millisecond, whose end activates another task."""
    first = Proc("first", (Call(runnable="work", **repeated), ticks(10)), 1000, priority=2)
    second = Proc("second", (ticks(10),), stimuli=("at the end",), priority=1, task={"activation_limit": 10})
    events = (
        RunnableEvent(name="starts", runnable="work", change=RunnableChange.START),
        RunnableEvent(name="ends", runnable="work", change=RunnableChange.TERMINATE),
        ProcessEvent(name="finished", process="second", change=ProcessChange.TERMINATE),
    )
    model = built(
        first,
        second,
        stimuli=(EventTriggered(name="at the end", events=("ends",)),),
        runnables=(Runnable(name="work", activities=(ticks(10),)),),
        events=events,
        chains=(EventChain(name="way", stimulus="starts", response="finished"),),
    )
    found = simulate_system(model, Options(duration=Duration(100_000 * US)))
    assert (found["first"].jobs, found["second"].jobs) == (100, seconds)
    if "counter" in repeated:
        # From the start of the call: it takes 10 us, the rest of the job 10 us, and the job that its end activates 10 us.
        latency = found.chains["way"].quantities[ChainQuantity.REDUCED_REACTION_TIME]
        assert (latency.count, latency.min, latency.max) == (20, 30 * US, 30 * US)
