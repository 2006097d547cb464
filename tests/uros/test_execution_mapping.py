"""Callbacks mapped to periodic tasks, by the rules of the thesis, section 4.3."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.assembly.planned import PlannedTask
from amalthea_uros.uros.os import priorities

APP = """
    amuros: 1
    name: app
    hardware: {{platform: single-core}}
    middleware:
      task_periods: [1 ms, 10 ms, 20 ms, 100 ms]
      executor: {{{executor}}}
    application:
      nodes:
        - name: node
          subscriptions:
            - {{name: Sub, topic: t, message_size: 4 B, {sub}}}
          timers:
            - {{name: Timer, {timer}}}
"""


def app(sub="rate: 50 Hz, execution_time: 2 us", timer="period: 1 ms, execution_time: 4 us", executor="execution_time: 12 us"):
    return APP.format(sub=sub, timer=timer, executor=executor)


def periods(assembly):
    return {choice.task: choice.period // MS for choice in assembly.choices}


@pytest.mark.parametrize(
    ("sub", "period"),
    [
        ("rate: 50 Hz, execution_time: 2 us", 20),  # as long as the message interval
        ("rate: 49 Hz, execution_time: 2 us", 20),  # a bit longer than that
        ("rate: 51 Hz, execution_time: 2 us", 10),  # 20 ms would lose messages
        ("interval: 1 s, execution_time: 2 us", 100),
        ("rate: 1000 Hz, execution_time: 2 us", 1),
        ("rate: 50 Hz, execution_time: 2 us, task_period: 10 ms", 10),
    ],
)
def test_the_longest_period_that_loses_no_message(author, sub, period):
    assert periods(author.describe(app(sub=sub)))["Sub"] == period


def test_the_executor_is_as_fast_as_the_fastest_callback_and_has_the_highest_priority(author):
    timer = "period: 10 ms, execution_time: 4 us"
    assembly = author.describe(app(timer=timer))
    assert periods(assembly) == {"Executor_Task": 10, "Sub": 20, "Timer": 10}
    assert {a.task: a.priority for a in assembly.system.mapping.tasks} == {"Executor_Task": 3, "Timer": 2, "Sub": 1}


@pytest.mark.parametrize(
    ("keys", "line", "rule", "message"),
    [
        (
            {"sub": "rate: 50 Hz, execution_time: 20 ms"},
            *(11, "UR101", "no available task period fits 'Sub': 100 ms (longer than the message interval of 20 ms); "),
        ),
        (
            {"executor": "period: 10 ms"},
            *(
                13,
                "UR101",
                "no available task period fits 'Timer': 100 ms, 20 ms, 10 ms (longer than the timer period of 1 ms); ",
            ),
        ),
        (
            {"sub": "rate: 50 Hz, execution_time: 2 us, task_period: 100 ms"},
            *(11, "UR102", "the task period 100 ms of 'Sub' is longer than the message interval of 20 ms"),
        ),
        (
            {"sub": "rate: 50 Hz, execution_time: 2 us, task_period: 5 ms"},
            *(11, "UR102", "the task period 5 ms of 'Sub' is not one of 'task_periods'"),
        ),
        (
            {"timer": "period: 1 ms, execution_time: {on: {generic: 1 us}}"},
            *(13, "APP006", "no execution time for platform 'single-core'"),
        ),
    ],
)
def test_what_fits_nowhere_is_refused(author, keys, line, rule, message):
    (found,) = author.findings(app(**keys))
    assert found[:2] == (line, rule)
    assert found[2].startswith(message)


def test_the_reasons_against_each_period_are_told(author):
    ((_, _, message),) = author.findings(app(executor="period: 10 ms"))
    assert message.endswith("; 1 ms (shorter than the executor period of 10 ms)")
    ((_, _, message),) = author.findings(app(sub="rate: 50 Hz, execution_time: 20 ms"))
    assert "; 20 ms, 10 ms, 1 ms (not longer than the execution time" in message


def test_a_timer_runs_in_a_task_whose_period_divides_its_own(author):
    assembly = author.describe(app(timer="period: 50 ms, execution_time: 4 us"))
    assert periods(assembly)["Timer"] == 10
    (call,) = assembly.system.processes["Timer"].activities
    assert call.counter.prescaler == 5


def test_without_task_periods_any_period_is_allowed(author):
    text = app(sub="rate: 30 Hz, execution_time: 2 us").replace(
        "task_periods: [1 ms, 10 ms, 20 ms, 100 ms]", "task_periods: []"
    )
    choice = next(choice for choice in author.describe(text).choices if choice.task == "Sub")
    # A thirtieth of a second, rounded down: at least as often as messages arrive.
    assert choice.period == 33_333_333_333


def planned(name, period, priority=None, wins_ties=False):
    return PlannedTask(name=name, core="c", stimuli=(), activities=(), period=period, priority=priority, wins_ties=wins_ties)


def test_preset_priorities_are_kept_and_the_others_fit_in():
    tasks = [
        planned("fast", 1),
        planned("slow", 100, 10),
        planned("middle", 10, 20),
        planned("rather slow", 50),
        planned("never", None),
    ]
    notes = Notes()
    found = priorities(tasks, notes)
    assert (found["slow"], found["middle"]) == (10, 20)
    assert found["never"] < 10 < found["rather slow"] < 20 < found["fast"]
    assert notes.findings == []


def test_no_gap_between_preset_priorities_is_reported():
    notes = Notes()
    priorities([planned("a", 100, 5), planned("b", 50), planned("c", 10, 6)], notes)
    assert [finding.rule for finding in notes.findings] == ["UR105"]


@given(st.lists(st.integers(1, 8), min_size=1, max_size=8))
def test_a_shorter_period_never_has_a_lower_priority(drawn):
    tasks = [planned(f"t{index}", period) for index, period in enumerate(drawn)]
    found = priorities(tasks, Notes())
    assert sorted(found.values()) == list(range(1, len(tasks) + 1))
    for one in tasks:
        for other in tasks:
            if one.period < other.period:
                assert found[one.name] > found[other.name]


def test_cost_of_the_executor(author):
    executor = (
        "execution_time: {base: 10 us, per_timer: 2 us, per_ready_callback: 3 us, per_message: {fixed: 5 us, per_byte: 1 us}}"
    )
    system = author.describe(app(executor=executor)).system

    def ticks(runnable):
        return [
            activity.demand.ticks.value for activity in system.runnables[runnable].activities if hasattr(activity, "demand")
        ]

    # One timer is checked in every activation; a message of 4 B is taken every 20th time; the timer is ready every time.
    assert ticks("Executor_Task_Spin") == [10 + 2]
    assert ticks("Take_Sub") == [3 + 5 + 4 * 1]
    assert ticks("Notify_Timer") == [3]
    calls = {call.runnable: call.counter for call in system.processes["Executor_Task"].activities}
    assert calls["Executor_Task_Spin"] is calls["Notify_Timer"] is None
    assert calls["Take_Sub"].prescaler == 20


def test_bounds_are_rounded_outwards(author):
    assembly = author.describe(app(timer="period: 1 ms, execution_time: {min: 1.9 us, avg: 2.5 us, max: 3.1 us}"))
    (execute,) = assembly.system.runnables["Timer_Callback"].activities
    ticks = execute.demand.ticks
    assert (ticks.lower, ticks.average, ticks.upper) == (1, 2.5, 4)


def test_a_constant_that_is_not_a_whole_number_of_ticks_is_reported(author):
    assembly = author.describe(app(timer="period: 1 ms, execution_time: 2.5 us"))
    assert [(f.rule, f.location.line) for f in assembly.findings] == [("APP007", 13)]


def test_execution_times_per_platform(author):
    timer = "period: 1 ms, execution_time: {on: {single-core: 4 us, generic: 1 us}}"
    one = author.describe(app(timer=timer))
    other = author.describe(app(timer=timer), platform="generic")
    assert one.system.runnables["Timer_Callback"].activities[0].demand.ticks.value == 4
    assert other.system.runnables["Timer_Callback"].activities[0].demand.ticks.value == 100


INSIDE = """
    amuros: 1
    name: app
    hardware: {{platform: single-core}}
    middleware:
      executor: {{period: 10 ms, callbacks: in-executor, semantics: {semantics}, trigger: {trigger}, order: [Slow],
        execution_time: {{base: 5 us, per_message: 3 us}}}}
    application:
      nodes:
        - name: node
          subscriptions:
            - {{name: Fast, topic: f, message_size: 4 B, interval: 10 ms, execution_time: 2 us}}
            - {{name: Slow, topic: s, message_size: 4 B, interval: 40 ms, execution_time: 2 us}}
          timers:
            - {{name: Timer, period: 20 ms, execution_time: 2 us}}
"""


def executor_calls(author, semantics="ROS", trigger="any"):
    system = author.describe(INSIDE.format(semantics=semantics, trigger=trigger)).system
    (task,) = system.software.tasks
    return [(call.runnable, call.counter.prescaler if call.counter else 1) for call in task.activities]


def test_callbacks_in_the_executor_run_in_the_order_of_registration(author):
    slow, fast = (("Take_Slow", 4), ("Slow_Callback", 4)), (("Take_Fast", 1), ("Fast_Callback", 1))
    spin, timer = ("Executor_Task_Spin", 1), ("Timer_Callback", 2)
    assert executor_calls(author) == [spin, *slow, *fast, timer]
    # LET takes all messages first.
    assert executor_calls(author, semantics="LET") == [spin, slow[0], fast[0], slow[1], fast[1], timer]


@pytest.mark.parametrize(("trigger", "every"), [("all", {4}), ("{one: Timer}", {2, 4})])
def test_trigger_conditions(author, trigger, every):
    # Nothing runs before the condition holds, and nothing runs more often than it is due.
    assert {prescaler for name, prescaler in executor_calls(author, trigger=trigger) if name != "Executor_Task_Spin"} == every


def test_an_executor_slower_than_its_callbacks_is_refused(author):
    text = INSIDE.format(semantics="ROS", trigger="any").replace("period: 10 ms, callbacks", "period: 20 ms, callbacks")
    assert author.findings(text) == [(5, "UR103", "the executor period 20 ms is longer than the 10 ms of Fast")]


def test_received_frames_interrupt(author):
    text = app().replace("executor:", "transport: {can: {bitrate: 250 kbit/s, interrupt: 3 us}}\n      executor:")
    assembly = author.describe(text)
    (isr,) = assembly.system.software.isrs
    (stimulus,) = (assembly.system.stimuli_by_name[name] for name in isr.stimuli)
    # 4 B and 12 B of headers in blocks of 7 B: three frames, no closer than 111 bits of 4 us.
    assert (stimulus.period, stimulus.count, stimulus.distance) == (20 * MS, 3, 444 * US)
    (message,) = assembly.messages
    assert (message.length, message.frames, message.transmission_time) == (16, 3, 3 * 135 * 4 * US)
    assert float(message.bus_load) == pytest.approx(3 * 135 * 4e-6 / 20e-3)


def test_a_callback_without_a_task_causes_no_other_errors(author):
    chain = "\n    chains:\n      - {name: c, path: [Sub, Timer]}\n    requirements:\n      - {process: Timer, response_time: 1 ms}\n"
    text = app(executor="period: 10 ms, execution_time: 12 us", sub="rate: 50 Hz, execution_time: 2 us, writes: [x]")
    findings = author.findings(text + chain)
    assert [rule for _, rule, _ in findings] == ["UR101"]
