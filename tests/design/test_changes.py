"""Changes of single values of a system: what they do, to what they apply, and what is wrong with others."""

import re
from dataclasses import replace
from fractions import Fraction

import pytest
from hand_made_systems import ticks
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.changes.apply import apply, describe
from amalthea_uros.design.changes.change import Change, parse_change
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf import activities, distributions, events, hardware, mapping, os, software, stimuli
from amalthea_uros.perf.system import System
from amalthea_uros.services.subject import open_system
from amalthea_uros.timing.basics.settings import Settings

MHZ = Fraction(10**6)
MS = 10**9


def core(name, clock):
    return hardware.Core(name=name, clock=clock)


def scheduler(name, *cores):
    return os.Scheduler(name=name, policy=os.Policy.FIXED_PRIORITY_PREEMPTIVE, cores=cores)


def duration(name, time):
    return os.Parameter(name, (os.Duration(time),))


def runnable(name, *times):
    return software.Runnable(name=name, activities=tuple(map(ticks, times)))


def calling(name, *runnables):
    return software.Task(
        name=name, stimuli=("tick",), activities=tuple(activities.Call(runnable=called) for called in runnables)
    )


#: Two cores with clocks of 1 and 3 MHz, each with a scheduler; a third scheduler for both; a server below the first.
SYSTEM = System(
    hardware=hardware.Hardware(
        clocks=(hardware.Clock(name="slow", frequency=MHZ), hardware.Clock(name="fast", frequency=3 * MHZ)),
        structures=(hardware.Structure(name="s", cores=(core("C0", "slow"), core("C1", "fast"), core("C2", "fast"))),),
    ),
    os=os.Os(
        systems=(
            os.OperatingSystem(
                name="OS",
                schedulers=(
                    *(scheduler("S0", "C0"), scheduler("S1", "C1", "C2"), scheduler("S2", "C2")),
                    os.Scheduler(name="Round", policy=os.Policy.PRIORITY_BASED_ROUND_ROBIN),
                    os.Scheduler(
                        name="Server",
                        policy=os.Policy.DEFERRABLE_SERVER,
                        parent=os.Parent(
                            scheduler="S2", priority=1, parameters=(duration("maxBudget", 2 * MS), duration("period", 9 * MS))
                        ),
                    ),
                ),
                interrupt_controllers=(
                    os.InterruptController(name="IC0", cores=("C0",)),
                    os.InterruptController(name="IC1", cores=("C1",)),
                ),
            ),
        )
    ),
    stimuli=stimuli.Stimuli(
        stimuli=(
            stimuli.Periodic(name="tick", period=MS),
            stimuli.Periodic(name="own", period=5 * MS, offset=MS, jitter=distributions.Uniform(lower=-3, upper=7000)),
            stimuli.RelativePeriodic(name="sporadic", distance=distributions.Constant(MS), has_maximum=False),
            stimuli.Periodic(name="name.with.dots", period=MS),
        )
    ),
    software=software.Software(
        tasks=(
            *(calling("A", "RA"), calling("B", "R1", "R2")),
            software.Task(name="Own", stimuli=("own",), activities=(activities.Loop(activities=(ticks(10),)),)),
            software.Task(name="Both", stimuli=("own", "tick"), activities=(ticks(1), ticks(2))),
            software.Task(name="Event", stimuli=("sporadic",)),
            software.Task(name="Free"),
            calling("Idle", "Nothing"),
            software.Task(name="Mixed", stimuli=("tick",), activities=(ticks(4), activities.Call(runnable="Empty"))),
        ),
        isrs=(software.Isr(name="I", stimuli=("sporadic",), activities=(ticks(3),)),),
        runnables=(
            *(
                runnable("RA", 4),
                runnable("R1", 5),
                runnable("R2", 6),
                runnable("Twice", 1, 2),
                runnable("Nothing"),
                runnable("Empty"),
            ),
        ),
        modes=(software.Mode(name="Gear", literals=("first", "second")),),
        mode_labels=(
            software.ModeLabel(name="gear", mode="Gear", initial="first"),
            software.ModeLabel(name="number", initial="1"),
        ),
    ),
    mapping=mapping.Mapping(
        tasks=(
            mapping.TaskAllocation(task="A", scheduler="S0", priority=3),
            mapping.TaskAllocation(task="B", scheduler="S0", priority=2, deadline=4 * MS),
            mapping.TaskAllocation(task="Own", scheduler="S1", cores=("C1",)),
            mapping.TaskAllocation(task="Both", scheduler="S0"),
            mapping.TaskAllocation(task="Event", scheduler="S1"),
        ),
        isrs=(mapping.IsrAllocation(isr="I", controller="IC0", priority=1),),
    ),
)


def changed(system, *changes):
    return apply(system, Settings(), [parse_change(change) for change in changes])


def differences(*changes):
    found = describe(SYSTEM, Settings(), [parse_change(change) for change in changes])
    return [(difference.before, difference.after) for difference in found]


VALUES = {
    "Own.period=2ms": ("5 ms", "2 ms"),
    "Own.offset=0s": ("1 ms", "0 s"),
    "Own.jitter=3us": ("7 ns", "3 us"),
    "A.jitter=0s": ("0 s", "0 s"),
    "own.period=1s": ("5 ms", "1 s"),
    "sporadic.offset=2ms": ("0 s", "2 ms"),
    "name.with.dots.period=3ms": ("1 ms", "3 ms"),
    "A.priority=-7": ("3", "-7"),
    "I.priority=9": ("1", "9"),
    "A.deadline=1ms": ("not set", "1 ms"),
    "B.deadline=1ms": ("4 ms", "1 ms"),
    "A.preemption=non-preemptive": ("preemptive", "non-preemptive"),
    "A.activation_limit=3": ("1", "3"),
    "RA.execution_time=1 tick": ("4 us", "1 us"),
    "RA.execution_time=7ticks..9ticks": ("4 us", "7 us..9 us"),
    "A.execution_time=12us": ("4 us", "12 us"),  # 1 MHz
    "Own.execution_time=12us": ("3.33333333333 us", "12 us"),  # 3 MHz
    "I.execution_time=1us": ("3 us", "1 us"),
    "Nothing.execution_time=2ticks": ("not set", "2 ticks"),
    "Mixed.execution_time=2ticks": ("4 ticks", "2 ticks"),
    "Free.execution_time=2ticks": ("not set", "2 ticks"),
    "C0.frequency=300MHz": ("1 MHz", "300 MHz"),
    "fast.frequency=2MHz": ("3 MHz", "2 MHz"),
    "Free.period=1ms": ("not set", "1 ms"),
    "Both.stimulus=tick": ("own, tick", "tick"),
    "A.core=C1": ("C0", "C1"),
    "Free.core=C0": ("not set", "C0"),
    "C0.policy=OSEK": ("FixedPriorityPreemptive", "OSEK"),
    "Own.core=C2": ("C1", "C2"),
    "A.scheduler=S1": ("S0", "S1"),
    "I.core=C1": ("C0", "C1"),
    "I.core=C2": ("C0", "C2"),
    "I.controller=IC1": ("IC0", "IC1"),
    "gear.mode=second": ("first", "second"),
    "number.mode=-3/2": ("1", "-3/2"),
    "Server.policy=PollingPeriodicServer": ("DeferrableServer", "PollingPeriodicServer"),
    "A.time_slice=1ms": ("not set", "1 ms"),
    "Round.time_slice=2ms": ("not set", "2 ms"),
    "Server.capacity=3ms": ("2 ms", "3 ms"),
    "Server.budget=3ms": ("2 ms", "3 ms"),
    "Server.period=8ms": ("9 ms", "8 ms"),
    "Server.priority=4": ("1", "4"),
}


@pytest.mark.parametrize("change", VALUES)
def test_the_value_before_and_after_a_change(change):
    assert differences(change) == [VALUES[change]]


@pytest.mark.parametrize("change", VALUES)
def test_a_change_keeps_all_other_values(change):
    after = changed(SYSTEM, change)
    name, key = parse_change(change).object, parse_change(change).key
    related = {"capacity": "budget", "budget": "capacity", "scheduler": "core", "core": "scheduler", "controller": "core"}
    for other, (before, _) in VALUES.items():
        target = parse_change(other)
        if target.object == name and target.key in (key, related.get(key), "controller"):
            continue
        if {name, target.object} in ({"Own", "own"}, {"A", "RA"}):  # the same stimulus, the same demand
            continue
        if target.key == "execution_time" and key in (
            "frequency",
            "core",
            "scheduler",
            "controller",
        ):  # the same ticks take another time
            continue
        (difference,) = describe(after.system, after.settings, [target])
        assert difference.before == before, other


@pytest.mark.parametrize("change", VALUES)
def test_a_change_made_twice_is_the_change(change):
    once = changed(SYSTEM, change)
    assert apply(*once, [parse_change(change)]) == once


WRONG = {
    "period=2ms": "does not name an object and a key",
    "A.period": "not of the form OBJECT.KEY=VALUE",
    "A.period=": "not of the form OBJECT.KEY=VALUE",
    "Ownn.period=2ms": "unknown object 'Ownn'; did you mean 'Own'",
    "A.perod=2ms": "the task 'A' has no 'perod'; did you mean 'period'?",
    "C0.x=2ms": "the core 'C0' has no 'x'; it has frequency",
    "A.period=2": "'2' has no unit",
    "A.period=0s": "not greater than 0 s",
    "A.offset=-1ms": "is negative",
    "A.priority=high": "'high' is not a whole number",
    "A.activation_limit=0": "'0' is less than 1",
    "A.preemption=sometimes": "not one of preemptive, cooperative, non-preemptive",
    "C0.frequency=0Hz": "not greater than 0 Hz",
    "C0.frequency=1ms": "'ms' is not a unit of frequency",
    "Both.period=1ms": "'Both' has several stimuli (own, tick)",
    "Free.offset=1ms": "'Free' has no stimulus; state Free.period",
    "Free.stimulus=tack": "unknown stimulus 'tack'",
    "Event.period=1ms": "'sporadic' of 'Event' is RelativePeriodic, which has no period",
    "sporadic.jitter=1ms": "RelativePeriodic, which has no jitter; these have one: Periodic",
    "Free.priority=1": "'Free' is not mapped",
    "A.core=C2": "several schedulers are responsible for the core 'C2'; choose one: A.scheduler=S1, A.scheduler=S2, A.scheduler=Server",
    "A.core=C9": "unknown core 'C9'",
    "C9.frequency=1MHz": "unknown object 'C9'",
    "C2.policy=OSEK": "several schedulers are responsible for the core 'C2'; choose one: S1.policy=OSEK, S2.policy=OSEK",
    "A.scheduler=S9": "unknown scheduler 'S9'",
    "B.execution_time=1us": "R1.execution_time, R2.execution_time",
    "Both.execution_time=1us": "'Both' contains 2 execution times",
    "Twice.execution_time=1tick": "'Twice' contains 2 execution times",
    "Idle.execution_time=1tick": "change those of its runnables: Nothing.execution_time",
    "RA.execution_time=3": "'3' has no unit; write a time such as '12 us', or '3 ticks'",
    "RA.execution_time=4us..2us": "ends before it starts",
    "RA.execution_time=4us..9ticks": "mixes a time and ticks",
    "RA.execution_time=-1us": "is negative",
    "R2.execution_time=..": "'' is not a time",
    "gear.mode=third": "expected one of first, second",
    "number.mode=one": "'one' is not a number",
    "S0.period=1ms": "its policy FixedPriorityPreemptive is not that of a server",
    "S0.priority=1": "'S0' has no parent",
    "Free.time_slice=1ms": "'Free' is not mapped to a scheduler, so it has no time slice",
    "S0.time_slice=1ms": "its policy FixedPriorityPreemptive is not PriorityBasedRoundRobin",
}


@pytest.mark.parametrize("change", WRONG)
def test_wrong_changes_say_what_was_expected(change):
    with pytest.raises(InvalidArgumentError, match=re.escape(WRONG[change])):
        changed(SYSTEM, change)


def test_a_system_without_hardware_is_given_a_core_with_a_scheduler():
    bare = replace(SYSTEM, hardware=hardware.Hardware(), os=os.Os(), mapping=mapping.Mapping())
    stated = ["CPU.frequency=1MHz", "CPU.policy=OSEK", "A.core=CPU"]
    found = describe(bare, Settings(), list(map(parse_change, stated)))
    assert [(each.before, each.after) for each in found] == [("not set", after) for after in ("1 MHz", "OSEK", "CPU")]
    # In any order: what is there is stated first.
    assert changed(bare, *stated) == changed(bare, *reversed(stated))
    with pytest.raises(
        InvalidArgumentError, match=re.escape("no scheduler is responsible for the core 'CPU'; state its policy")
    ):
        changed(bare, "CPU.frequency=1MHz", "A.core=CPU")
    with pytest.raises(InvalidArgumentError, match="unknown core 'CPU'"):
        changed(bare, "CPU.policy=OSEK")


def test_a_shared_stimulus_is_changed_for_one_process_only():
    system = changed(SYSTEM, "A.period=4ms").system
    periods = {
        name: [system.stimuli_by_name[each].period for each in system.processes[name].stimuli] for name in ("A", "B", "Both")
    }
    assert periods == {"A": [4 * MS], "B": [MS], "Both": [5 * MS, MS]}


def test_a_shared_stimulus_to_which_an_event_refers_is_not_copied():
    system = replace(SYSTEM, events=events.Events(events=(events.StimulusEvent(name="e", stimulus="tick"),)))
    with pytest.raises(InvalidArgumentError, match=re.escape("change tick.period for all of them")):
        changed(system, "A.period=4ms")
    periods = changed(system, "tick.period=4ms").system.stimuli_by_name
    assert periods["tick"].period == 4 * MS


def test_a_time_is_rounded_to_ticks_outwards():
    # 1 us is 3 ticks of 3 MHz: 0.5 us are 1.5 ticks.
    for text, after in {
        "0.5us": "666.666666667 ns",  # 2 ticks
        "0.5us..1.5us": "333.333333333 ns..1.66666666667 us",  # 1..5 ticks
        "0.5us..0.5us": "666.666666667 ns",
    }.items():
        assert differences(f"Own.execution_time={text}") == [("3.33333333333 us", after)]


def test_times_are_converted_at_the_frequencies_after_all_changes():
    changes = ["A.execution_time=12us", "A.scheduler=S1", "fast.frequency=2MHz", "C2.frequency=2MHz"]
    for order in (changes, changes[::-1]):
        found = {change.partition("=")[0]: each for change, each in zip(order, differences(*order), strict=True)}
        assert found["A.execution_time"] == ("4 us", "12 us")


def test_cores_with_different_frequencies_need_ticks():
    message = "'Own' is executed on cores with different frequencies; write its execution time in ticks"
    with pytest.raises(InvalidArgumentError, match=message):
        differences("C2.frequency=2MHz", "Own.scheduler=S1", "Own.execution_time=12us")
    assert differences("C2.frequency=2MHz", "Own.scheduler=S1", "Own.execution_time=12ticks")[-1] == (
        "3.33333333333 us",
        "12 ticks",
    )


def test_an_unknown_frequency_needs_ticks():
    clocks = tuple(replace(clock, frequency=None) for clock in SYSTEM.hardware.clocks)
    system = replace(SYSTEM, hardware=replace(SYSTEM.hardware, clocks=clocks))
    with pytest.raises(InvalidArgumentError, match="'A' is executed on a core of unknown frequency"):
        changed(system, "A.execution_time=1us")


def test_a_runnable_that_others_call_is_not_changed_for_one_task():
    both = replace(SYSTEM.software.tasks[0], name="A2")
    system = replace(SYSTEM, software=replace(SYSTEM.software, tasks=(*SYSTEM.software.tasks, both)))
    with pytest.raises(InvalidArgumentError, match=re.escape("change those of its runnables: RA.execution_time")):
        changed(system, "A.execution_time=1tick")


def test_a_name_of_several_objects_means_the_one_that_has_the_key():
    task = software.Task(name="RA", stimuli=("own",))
    system = replace(SYSTEM, software=replace(SYSTEM.software, tasks=(*SYSTEM.software.tasks, task)))
    after = changed(system, "RA.execution_time=9ticks").system
    assert after.runnables["RA"].activities == (ticks(9),)


def test_the_last_change_of_a_value_counts():
    assert differences("A.priority=5", "A.priority=6") == [("3", "6")]


def test_the_analysis_takes_changes_into_account():
    system = open_system([ROOT / "samples" / "bodas-test-advanced.yaml"]).system

    def response(*changes):
        settings = Settings(phases={"Message_Factor": 0})
        after = apply(system, settings, [parse_change(change) for change in changes])
        return analyze_system(*after).processes["Control_Function"].response.worst

    # The executor takes 12 us, and 13 us more with a message; Control_Function has 4 us at a lower priority.
    assert response() == 29_000_000
    assert response("Control_Function.execution_time=6us") == 31_000_000
    assert response("Take_Message_Factor.execution_time=1us", "Control_Function.execution_time=5 ticks") == 18_000_000
    assert response("Control_Function.priority=9") == 4_000_000
    assert response("Core_0.frequency=2MHz") == 14_500_000


def test_the_phase_of_a_message():
    system = open_system([ROOT / "samples" / "bodas-test-advanced.yaml"]).system
    assert changed(system, "Message_Factor.phase=5ms").settings == Settings(phases={"Message_Factor": "5 ms"})


@given(st.text(min_size=1), st.from_regex(r"[a-z_]+", fullmatch=True), st.text(min_size=1))
def test_any_name_without_an_equals_sign_is_possible(name, key, value):
    name, value = name.replace("=", "").strip() or "x", value.strip() or "x"
    assert parse_change(f"{name}.{key}={value}") == Change(name, key, value)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("A.period=1.5ms", ("A", "period", "1.5ms")),
        ("a.b.period = 2ms", ("a.b", "period", "2ms")),
        ("a=b.period=2ms", ("a=b", "period", "2ms")),
        ("a.b=c.period=2ms", ("a", "b", "c.period=2ms")),  # as short a name as possible: there is no key b, so this is refused
    ],
)
def test_dots_and_equals_signs_of_names(text, expected):
    change = parse_change(text)
    assert (change.object, change.key, change.value) == expected
