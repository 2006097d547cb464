"""What a round executes, and how often rounds begin."""

import pytest
from looping import CALLBACKS, described

from amalthea_uros.perf.activities import Call, ProbabilitySwitch
from amalthea_uros.perf.stimuli import Custom, InterProcess, Periodic
from amalthea_uros.units import MICROSECOND, MILLISECOND, SECOND
from amalthea_uros.uros.described import describe_text

TIMER = "\n      timers: [{name: Control, period: 40 ms, execution_time: 4 us}]"
SLEEPING = "loop: {spin_some: 100 ms, sleep: 10 ms}"


def rounds(executor, callbacks=CALLBACKS, more=""):
    """The different rounds that are possible, each as the names of its runnables without the first one."""
    task = described(f"{{name: Main, {executor}}}", callbacks, more).system.processes["Main"]
    assert task.activities[0] == Call(runnable="Main_Spin")
    return {tuple(names) for names in sequences(task.activities[1:])}


def sequences(activities):
    """All ways through activities."""
    if not activities:
        yield []
        return
    first, *rest = activities
    ways = [[first.runnable]] if isinstance(first, Call) else []
    if isinstance(first, ProbabilitySwitch):
        ways = [way for branch in first.branches for way in sequences(branch.activities)]
    for way in ways:
        for other in sequences(rest):
            yield [*way, *other]


COMMAND, MAP = ("Take_On_Command", "On_Command_Callback"), ("Take_On_Map", "On_Map_Callback")
CONTROL = ("Control_Callback",)


def test_a_round_has_one_message_at_most_and_each_timer_once():
    assert rounds(SLEEPING) == {(), COMMAND, MAP, CONTROL, (*COMMAND, *CONTROL), (*MAP, *CONTROL)}


def test_the_order_of_the_handles_is_the_order_of_the_calls():
    found = rounds(f"{SLEEPING}, order: [On_Command, Control, On_Map]")
    assert (*COMMAND, *CONTROL) in found
    assert (*CONTROL, *MAP) in found
    assert (*MAP, *CONTROL) not in found


@pytest.mark.parametrize(
    ("executor", "callbacks"),
    [
        # What arrives while a publication waits for its acknowledgement is stored for the next round.
        (SLEEPING, CALLBACKS.replace(", reliability: best-effort}]", "}]")),
        # What the trigger condition keeps back is stored, too.
        (f"{SLEEPING}, trigger: {{custom: [[On_Map, On_Command]]}}", CALLBACKS),
    ],
)
def test_a_round_has_several_messages_if_they_can_be_stored(executor, callbacks):
    assert (*COMMAND, *MAP, *CONTROL) in rounds(executor, callbacks)


def test_the_trigger_condition_all_calls_all_or_nothing():
    assert rounds(f"{SLEEPING}, trigger: all") == {(), (*COMMAND, *MAP, *CONTROL)}


def test_the_trigger_condition_one_calls_at_least_that_one():
    found = rounds(f"{SLEEPING}, trigger: {{one: On_Map}}")
    assert () in found
    assert all("On_Map_Callback" in names for names in found if names)
    assert (*COMMAND, *MAP, *CONTROL) in found


def test_a_handle_that_is_always_called_is_called_without_a_message():
    always = CALLBACKS.replace("execution_time: 100 us,", "execution_time: 100 us, invocation: always,")
    assert all("On_Command_Callback" in names for names in rounds(f"{SLEEPING}, trigger: always", always))
    assert ("On_Command_Callback",) in rounds(f"{SLEEPING}, trigger: always", always)


def test_with_let_semantics_messages_are_taken_before_the_first_call():
    found = rounds(f"{SLEEPING}, semantics: LET, order: [Control, On_Map]")
    assert ("Take_On_Map", "Control_Callback", "On_Map_Callback") in found


def stimuli(executor, callbacks=CALLBACKS, more=""):
    system = described(f"{{name: Main, {executor}}}", callbacks, more).system
    return {name: system.stimuli_by_name[name] for name in system.processes["Main"].stimuli}


def test_a_sleep_and_the_shortest_round_separate_rounds():
    # 10 ms + 20 us + 3 handles of 1 us + 1 timer of 2 us.
    found = stimuli(f"{SLEEPING}, execution_time: {{base: 20 us, per_handle: 1 us, per_timer: 2 us}}")
    assert [(each.distance.lower, each.has_maximum) for each in found.values()] == [
        (10 * MILLISECOND + 25 * MICROSECOND, False)
    ]


def test_a_period_activates_rounds_if_the_wait_cannot_exceed_it():
    (stimulus,) = stimuli("loop: {spin_period: 20 ms, timeout: 5 ms}").values()
    assert isinstance(stimulus, Periodic)
    assert (stimulus.period, stimulus.jitter.upper) == (20 * MILLISECOND, 5 * MILLISECOND)


@pytest.mark.parametrize(("timeout", "jitter"), [("", 20), (", timeout: 1 s", 20), (", timeout: 5 ms", 5)])
def test_a_wait_that_may_return_at_once_has_a_jitter_too(timeout, jitter):
    # micro-ROS/rmw_microxrcedds#305: some versions wait also where nothing receives messages.
    found = stimuli(f"loop: {{spin_period: 20 ms{timeout}}}", TIMER)
    (stimulus,) = found.values()
    assert (stimulus.period, stimulus.jitter.upper) == (20 * MILLISECOND, jitter * MILLISECOND)


@pytest.mark.parametrize("loop", ["{spin: 1 s}", "{spin_period: 20 ms}", "{spin_some: 1 s}"])
def test_an_executor_that_blocks_spins_for_messages_timers_and_timeouts(loop):
    # rclc_executor_spin_period waits for the timeout of 1 s, too, and after that rounds are not apart by the period.
    found = {name: each.distance.lower for name, each in stimuli(f"loop: {loop}").items()}
    assert found == {
        "timeout_of_Main": SECOND,
        "messages_for_On_Command": 50 * MILLISECOND,
        "messages_for_On_Map": 200 * MILLISECOND,
        "due_Control": 50 * MILLISECOND,
    }


def test_an_interrupt_triggers_the_rounds_instead_of_messages():
    found = stimuli("loop: {spin: 1 s}", more="transport: {can: {bitrate: 500 kbit/s, interrupt: 2 us}}")
    assert {name for name, each in found.items() if isinstance(each, InterProcess)} == {"trigger_of_Main"}
    assert set(found) == {"trigger_of_Main", "timeout_of_Main", "due_Control"}


def test_before_a_timer_is_due_a_tight_loop_polls():
    # The wait is cut to whole milliseconds, so that it ends up to 1 ms early: 100,000 ticks of 100 MHz.
    system = described("{name: Main, loop: {spin: 1 s}}").system
    (poll,) = system.runnables["Main_Poll"].activities
    assert (poll.demand.ticks.lower, poll.demand.ticks.upper) == (0, 100_000)
    assert "Main_Poll" not in described("{name: Main, loop: {spin_some: 1 s, sleep: 1 ms}}").system.runnables


def test_a_loop_without_any_pause_is_unknown_unless_its_rounds_take_time():
    (unknown,) = stimuli("loop: {spin_some: 0 ms}").values()
    assert isinstance(unknown, Custom)
    (known,) = stimuli("loop: {spin_some: 0 ms}, execution_time: 20 us").values()
    assert known.distance.lower == 20 * MICROSECOND


def test_requests_of_unknown_rate_leave_the_rounds_unknown():
    callbacks = f"{CALLBACKS}      parameter_server: {{execution_time: 1 us}}"
    assert [name for name, each in stimuli("loop: {spin: 1 s}", callbacks).items() if isinstance(each, Custom)] == [
        "messages_for_node_Parameters"
    ]


def test_a_deadline_of_a_callback_is_a_requirement_on_its_runnable():
    callbacks = CALLBACKS.replace("execution_time: 300 us,", "execution_time: 300 us, deadline: 15 ms,")
    (requirement,) = described(f"{{{SLEEPING}}}", callbacks).system.constraints.requirements
    assert (requirement.runnable, requirement.limit.value) == ("Control_Callback", 15 * MILLISECOND)


def test_with_ticks_rounds_are_apart_by_whole_ticks_but_the_first_two():
    text = f"{SLEEPING}, execution_time: 20 us"
    exact = described(f"{{name: Main, {text}}}", more="publish: 1 us\n").system
    assert exact.stimuli_by_name["rounds_of_Main"].distance.lower == 10 * MILLISECOND + 20 * MICROSECOND
    # vTaskDelay of 10 ticks of 1 ms, called at any time between two ticks, ends with the 10th tick from the one before: a sleep of 9 ms
    # or more. Of three rounds, the second sleep ends 10 ms after the first.
    ticks = described(f"{{name: Main, {text}}}", more="publish: 1 us\nos: {tick: 1 ms}\n").system
    points = ticks.stimuli_by_name["rounds_of_Main"].points
    shortest = 9 * MILLISECOND + 20 * MICROSECOND
    assert [(point.occurrences, point.lower) for point in points[:3]] == [
        (1, 0),
        (2, shortest),
        (3, shortest + 10 * MILLISECOND),
    ]


def test_the_interrupt_of_the_operating_system_occurs_with_the_iterations_that_messages_begin():
    system = describe_text("""
amuros: 1
name: p
hardware: {platform: single-core, frequency: 1 GHz}
os: {overhead: {activation: 2 us, activations_run_in: interrupt}}
middleware:
  executor: {name: main, loop: {spin: 1 s}, execution_time: 10 us}
  transport: {udp: {bitrate: 10 Mbit/s, latency: 1 ms}}
  agent: {to_controller: 1 ms}
application:
  nodes:
    - name: n
      subscriptions:
        - {name: on_cmd, topic: cmd, interval: 20 ms, message_size: 8 B, execution_time: 100 us, reliability: best-effort}
""").assembly.system
    assert system.processes["main_Activation"].stimuli == system.processes["main"].stimuli
    assert set(system.processes["main"].stimuli) <= set(system.stimuli_by_name)
