"""Traps and contradictions that are found before any time is computed; examples of each trap are in the catalogue of findings."""

import pytest
from looping import CALLBACKS, described, findings_of

from amalthea_uros.uros.described import describe_text

LOOP = "loop: {spin_some: 100 ms, sleep: 10 ms}"
TIMER = "\n      timers: [{name: Control, period: 50 ms, execution_time: 300 us}]"


@pytest.mark.parametrize(
    ("executor", "rule"),
    [
        (f"{{{LOOP}, max_handles: 2}}", "EXE001"),
        ("{loop: {spin_period: 20 ms}}", "EXE002"),
        ("{loop: {spin_period: 20 ms, timeout: 21 ms}}", "EXE002"),
        ("{loop: {spin_some: 999 us}}", "EXE003"),
        ("{loop: {spin_some: 999 us, sleep: 1 ms}}", "EXE003"),
        ("{loop: {spin: 1 s}, trigger: all}", "EXE003"),
        ("{loop: {spin: 1 s}, trigger: {one: On_Map}}", "EXE003"),
        (f"{{{LOOP}, order: [On_Map, On_Map]}}", "EXE009"),
        (f"{{{LOOP}, period: 5 ms}}", "APP003"),
        (f"{{{LOOP}, offset: 5 ms}}", "APP003"),
        (f"{{{LOOP}, trigger: {{one: On_Mop}}}}", "APP001"),
        (f"{{{LOOP}, order: [On_Mop]}}", "APP001"),
        (f"executors: [{{name: A, {LOOP}}}, {{name: B, {LOOP}}}]", "APP003"),
    ],
)
def test_a_trap_is_reported(executor, rule):
    assert rule in findings_of(executor)


@pytest.mark.parametrize(
    "executor",
    [
        f"{{{LOOP}, max_handles: 3}}",
        "{loop: {spin_period: 20 ms, timeout: 20 ms}}",
        "{loop: {spin_some: 1 ms}}",
        "{loop: {spin: 1 s}}",
        "{loop: {spin_some: 1 ms, sleep: 50 ms}, trigger: all}",
        "{loop: {spin: 1 s}, trigger: {one: Control}}",
    ],
)
def test_what_is_right_is_not_reported(executor):
    assert not [rule for rule in findings_of(executor) if rule.startswith(("EXE", "APP"))]


def test_an_executor_with_timers_only_polls_unless_it_sleeps():
    assert "EXE006" in findings_of("{loop: {spin: 1 s}}", TIMER)
    assert "EXE006" not in findings_of(f"{{{LOOP}}}", TIMER)
    assert "EXE006" not in findings_of("{loop: {spin: 1 s}}")


@pytest.mark.parametrize("timeout", ["", ", timeout: 1 s", ", timeout: 20 ms"])
def test_a_wait_that_returns_at_once_does_not_exceed_the_period(timeout):
    # rclc_executor_spin_one_period sleeps until the next period, whatever the timeout is that it does not wait for.
    assert not {"EXE002", "EXE003", "EXE006"} & {*findings_of(f"{{loop: {{spin_period: 20 ms{timeout}}}}}", TIMER)}
    assert "EXE002" in findings_of("{loop: {spin_period: 20 ms}}")


def test_tasks_of_callbacks_that_publish_are_threads_too():
    own = CALLBACKS.replace("publishes: [state]", "publishes: [state], runs_in: own-task")
    assert "EXE008" in findings_of(f"{{{LOOP}}}", own)
    assert "EXE008" not in findings_of(f"{{{LOOP}}}", own, more="multithread: true")
    assert "EXE008" not in findings_of("{period: 1 ms}", own)


def test_an_executor_and_executors_exclude_each_other():
    found = findings_of(f"executors: [{{name: A, {LOOP}}}]", more="executor: {name: B}")["APP003"]
    assert found.message == "'executor' and 'executors' exclude each other"


def test_an_undefined_executor_has_a_suggestion():
    found = findings_of(f"{{name: Main, {LOOP}}}", CALLBACKS.replace("publishes:", "runs_in: Mian, publishes:"))["APP001"]
    assert found.message == "undefined executor 'Mian'"
    assert found.help == "Did you mean 'Main'?"


def test_only_what_nothing_depends_on_can_do_without_a_rate():
    guard = (
        "\n      publishers: [{topic: t, message_size: 4 B}]\n      guard_conditions: [{name: Stop, execution_time: 1 us%s}]"
    )
    assert "APP003" not in findings_of(f"{{{LOOP}}}", guard % "")
    assert "APP003" in findings_of(f"{{{LOOP}}}", guard % ", publishes: [t]")
    assert "APP003" in findings_of("{period: 1 ms, callbacks: in-executor}", guard % "")


@pytest.mark.parametrize(
    ("executor", "text"),
    [
        (f"{{{LOOP}}}", "callbacks run in the executor, as rclc does"),
        (f"{{{LOOP}, callbacks: own-task}}", "callbacks run in their own tasks: set in app.yaml"),
        ("{period: 1 ms}", "callbacks run in their own tasks by default"),
    ],
)
def test_it_is_said_who_decided_where_callbacks_run(executor, text):
    assert described(executor).placement == text


def test_a_platform_decides_where_callbacks_run():
    text = """
amuros: 1
name: app
hardware: {platform: bodas-rc18-12-40}
middleware: {executor: {period: 1 ms%s}}
application:
  nodes: [{name: node, timers: [{name: Control, period: 10 ms, execution_time: 1 ms}]}]
"""
    assert describe_text(text % "").assembly.placement == "the platform bodas-rc18-12-40 runs callbacks in their own tasks"
    stated = describe_text(text % ", callbacks: in-executor").assembly
    assert stated.placement == "callbacks run in the executor: set in app.yaml"


def test_several_executors_without_loops_have_a_period_each():
    executors = "executors: [{name: A, period: 5 ms}, {name: B, period: 10 ms}]"
    assembly = described(executors, CALLBACKS.replace("publishes:", "runs_in: B, publishes:"))
    assert {choice.task: choice.executor for choice in assembly.choices} == {
        "A": "A",
        "On_Command": "A",
        "On_Map": "A",
        "B": "B",
    }
    assert [call.runnable for call in assembly.system.processes["B"].activities] == ["B_Spin", "Control_Callback"]
