"""An app.yaml is edited where its values are written; the rest of the file stays, and the result means what the change says."""

from difflib import ndiff
from pathlib import Path

import pytest
from support import ROOT

from amalthea_uros import InvalidArgumentError, LatencyQuantity, analyze, parse_change
from amalthea_uros.design.description.edit import DescriptionEditor
from amalthea_uros.design.description.text_edits import newline_of, value_text, with_comment, with_value
from amalthea_uros.units import MICROSECOND
from amalthea_uros.uros.described import describe_text

SAMPLES = sorted(path for path in (ROOT / "samples").glob("*.yaml") if "amuros:" in path.read_text())
ADVANCED = (ROOT / "samples" / "bodas-test-advanced.yaml").read_text()
DRIVE = (ROOT / "samples" / "drive-and-lift.yaml").read_text()


def edited(text, *changes):
    return DescriptionEditor(text, Path("app.yaml")).edited([parse_change(change) for change in changes])


def changed_lines(before, after):
    return [line[2:] for line in ndiff(before.split("\n"), after.split("\n")) if line.startswith("+ ")]


# What is changed


def test_a_subscription_that_runs_more_often_has_the_latency_that_the_change_promises():
    # 10 ms - 1 ms + 1 ms + 16 us: the formula for harmonic periods, executor first.
    result = edited(ADVANCED, "Message_Factor.period=10ms")
    (chain,) = analyze(result.text).chains
    assert chain.value(LatencyQuantity.MAX_REDUCED_REACTION_TIME).value == 10_016 * MICROSECOND
    assert changed_lines(ADVANCED, result.text) == [
        "        - {name: Message_Factor, topic: factor, rate: 50 Hz, task_period: 10 ms, message_size: 4 B, buffer: memory_1, "
        "execution_time: 2 us, writes: [memory_2]}"
    ]


#: In samples, what changes and a line of the result.
EDITED = {
    "values of an executor": (
        ADVANCED,
        ["Executor_Task_Spin.execution_time=10us..14us", "Take_Message_Factor.execution_time=20us"],
        "execution_time: {base: {min: 10 us, max: 14 us}, per_message: 20 us}",
    ),
    # Publishing 32 bytes takes 6 us + 32 * 50 ns = 7.6 us, which is no part of the callback.
    "a callback that publishes": (
        DRIVE,
        ["Report_Odometry.execution_time=50us"],
        "name: Report_Odometry, period: 100 ms, execution_time: 42.4 us",
    ),
    "a deadline of a task": (DRIVE, ["Task_Log.deadline=5ms"], "deadline: 5 ms"),
    "an interrupt": (DRIVE, ["Wheel_Pulse.execution_time=4us"], "execution_time: 4 us"),
    "a runnable": (DRIVE, ["Read_Wheels.execution_time=10us..60us"], "{min: 10 us, max: 60 us}"),
    "an exact time": (ADVANCED, ["Message_Factor.offset=0.0005ms"], "offset: 0.0005 ms"),
}


@pytest.mark.parametrize("what", EDITED)
def test_one_line_has_the_new_value(what):
    before, changes, expected = EDITED[what]
    after = edited(before, *changes).text
    (line,) = changed_lines(before, after)
    assert expected in line


def test_the_rate_of_a_timer_becomes_its_new_period():
    text = ADVANCED.replace("period: 1 ms, execution_time: 4 us", "rate: 1 kHz, execution_time: 4 us")
    result = edited(text, "Control_Function.period=10ms")
    assert "Control_Function, period: 10 ms, execution_time: 4 us" in result.text
    assert [(each.target, each.value) for each in result.assignments] == [("Control_Function.period", "10 ms")]


def test_priorities_that_would_follow_the_periods_are_kept():
    # Task_5ms is above the executor; with 10 ms, rate-monotonic priorities would put it below.
    result = edited(DRIVE, "Task_5ms.period=10ms")
    old, new = (
        {each.task: each.priority for each in describe_text(text).assembly.system.mapping.tasks}
        for text in (DRIVE, result.text)
    )
    assert old["Task_5ms"] > old["Executor_Task"]
    assert new["Task_5ms"] > new["Executor_Task"] > new["Control_Speed"]
    assert {each.target for each in result.kept} >= {"Task_5ms.priority"}


# What is refused


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        (["Core_0.frequency=2MHz"], "at the present clock"),
        (["Message_Factor.jitter=1ms"], "no place|no 'jitter'"),
        (["Message_Factor.execution_time=300 ticks"], "states execution times as times"),
        (["Message_Factor.period=100ms"], "longer than the message interval"),
        (["Message_Factor.period=7ms"], "not one of 'task_periods'"),
        (["Executor_Task.period=0.5ms"], "time between two messages of 'Message_Factor' from 20 ms to 10 ms"),
        (["Control_Function.period=2ms"], "2 ms is not one of 'task_periods'"),
        (["Mesage_Factor.period=10ms"], "did you mean 'Message_Factor'"),
    ],
)
def test_what_a_description_cannot_state_is_refused(changes, reason):
    with pytest.raises(InvalidArgumentError, match=reason):
        edited(ADVANCED, *changes)


def test_messages_come_as_before_if_the_change_says_so():
    result = edited(ADVANCED, "Executor_Task.period=0.5ms", "Message_Factor.arrival_period=20ms")
    assert "rate: 50 Hz" in result.text
    assert "Executor_Task, period: 0.5 ms" in result.text


# How the text is kept


@pytest.mark.parametrize("path", SAMPLES, ids=lambda path: path.stem)
@pytest.mark.parametrize("newline", ["\n", "\r\n"], ids=["LF", "CRLF"])
def test_a_change_touches_one_line_of_each_sample(path, newline, monkeypatch):
    monkeypatch.chdir(path.parent)  # where the databases lie that it names
    text = path.read_text().replace("\n", newline).removesuffix(newline)
    system = describe_text(text).assembly.system
    process = [task.name for task in system.software.tasks if task.name not in system.transmissions][-1]
    result = edited(text, f"{process}.deadline=900us")
    assert len(changed_lines(text, result.text)) == 1
    assert result.text.count("\r") == result.text.count("\n") * (newline == "\r\n")
    assert edited(result.text, f"{process}.deadline=900us").text == result.text


UGLY = """\
# é𝄞
"amuros": 1
name:   ugly   # the name
hardware: {"platform": generic, frequency: 100 MHz}
x-times: &times
  execution_time: &short 12 us   # shared

tasks:

- # first
  name: 'A'
  period:   "10 ms"  # quoted
  execution_time: *short
  # after A
- {name: B, period: 20 ms,
   execution_time: {min: 3 us,   # least
                    max: 5 us}}  # most
- name: C
  period: 40 ms
  <<: *times
- name: D
  priority: 1
  period:
    50 ms
  execution_time:
    # comment inside
    min: 1 us
    max: 9 us  # measured
# the end"""


@pytest.mark.parametrize(
    ("change", "lines"),
    [
        ("A.period=5ms", ['  period:   "5 ms"  # quoted']),
        ("A.execution_time=13us", ["  execution_time: 13 us"]),
        ("B.execution_time=4us..6us", ["   execution_time: {min: 4 us,   # least", "                    max: 6 us}}  # most"]),
        ("B.deadline=7ms", ["- {name: B, period: 20 ms, deadline: 7 ms,"]),
        ("C.execution_time=14us", ["  execution_time: 14 us"]),
        ("C.deadline=30ms", ["  deadline: 30 ms"]),
        ("D.period=60ms", ["    60 ms"]),
        ("D.execution_time=2us..8us", ["    min: 2 us", "    max: 8 us  # measured"]),
    ],
)
def test_ugly_yaml_stays_as_it_is(change, lines):
    result = edited(UGLY, change)
    assert changed_lines(UGLY, result.text) == lines
    assert len(result.text.split("\n")) - len(UGLY.split("\n")) in (0, 1)


def test_who_shares_a_value_keeps_it():
    # The anchor belongs to the first task; the second one, which refers to it, is not changed.
    text = (
        UGLY.replace("execution_time: *short", "execution_time: &own 7 us")
        .replace("min: 3 us", "min: *own")
        .replace("max: 5 us", "max: 9 us")
    )
    result = edited(text, "A.execution_time=13us")
    assert "execution_time: 13 us" in result.text
    assert "min: &own 7 us" in result.text


def test_a_mapping_that_several_share_is_not_changed():
    text = "a: &all {min: 1 us, max: 2 us}\nb: *all\n"
    with pytest.raises(InvalidArgumentError, match="shared through the anchor &all"):
        with_value(text, ("b", "min"), "3 us")
    with pytest.raises(InvalidArgumentError, match="shared through the anchor &all"):
        with_value(text, ("a",), {"min": "3 us", "max": "4 us"})


def test_a_list_that_is_merged_is_not_changed():
    tasks = "x-base: &base\n  tasks:\n    - {name: A, period: 10 ms, execution_time: 1 ms}\n<<: *base\n"
    with pytest.raises(InvalidArgumentError, match="merged with '<<'"):
        edited(f"amuros: 1\nname: m\nhardware: single-core\n{tasks}", "A.priority=5")


def test_comments_are_replaced_by_newer_ones():
    text = "a:\r\n  - {b: 1}  # mine\r\n"
    once = with_comment(text, ("a", 0, "b"), "b:", "first")
    assert once == "a:\r\n  # b: first\r\n  - {b: 1}  # mine\r\n"
    assert with_comment(once, ("a", 0, "b"), "b:", "second") == once.replace("first", "second")


def test_values_are_written_where_their_mapping_is_missing():
    assert with_value("a: 1\n", ("m", "e", "p"), "2 ms") == "a: 1\nm: {e: {p: 2 ms}}\n"
    assert with_value("hardware: generic\n", ("hardware", "frequency"), "1 MHz") == (
        "hardware: {platform: generic, frequency: 1 MHz}\n"
    )
    assert with_value("a: {}", ("a", "b"), "null") == "a: {b: 'null'}"
    assert value_text("a: {b: 2 us }", ("a", "b")) == "2 us"
    assert newline_of("a") == "\n"


def test_a_priority_is_written_as_the_operating_system_counts():
    text = (
        "amuros: 1\nname: a\nhardware: {frequency: 1 MHz}\nos: {rtos: zephyr}\ntasks:\n"
        "  - {name: A, period: 10 ms, priority: 3, execution_time: 1 ms}\n"
        "  - {name: B, period: 20 ms, priority: 5, execution_time: 1 ms}\n"
    )
    # In the system, A has priority 14 - 3 = 11 and B 14 - 5 = 9; 12 is above both, and 2 in the file.
    result = edited(text, "B.priority=12")
    assert changed_lines(text, result.text) == ["  - {name: B, period: 20 ms, priority: 2, execution_time: 1 ms}"]
    assert {each.task: each.priority for each in describe_text(result.text).assembly.system.mapping.tasks} == {"A": 11, "B": 12}
