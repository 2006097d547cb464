"""What a controller receives is stated at its subscription, unless something described sends it: then it needs a wire."""

import pytest

import amalthea_uros as amuros
from amalthea_uros.uros.described import describe_text

CONTROLLER = """
amuros: 1
name: one
hardware: {platform: single-core}
middleware:
  executor: {name: E, EXECUTOR}
application:
  nodes:
    - name: n
      publishers: [{topic: state, message_size: 8 B, reliability: best-effort}]
      timers: [{name: Publish, period: 100 ms, execution_time: 40 us, publishes: [state]}]
      subscriptions:
        - {name: On_State, topic: state, rate: 10 Hz, message_size: 8 B, reliability: best-effort, execution_time: 30 us}
"""
PERIODIC, LOOP = "period: 5 ms, execution_time: 100 us", "loop: {spin_some: 5 ms, sleep: 1 ms}, execution_time: {base: 20 us}"
REFUSED = "'On_State' receives 'state', which is published here, too, but no wire is described on which it comes"


@pytest.mark.parametrize(("executor", "rate"), [(PERIODIC, "9 Hz"), (PERIODIC, "1 Hz"), (LOOP, "10 Hz"), (LOOP, "100 Hz")])
def test_own_messages_are_not_taken_as_stated(executor, rate):
    # Sent are 10 in a second; in a loop, each of them counts when it comes.
    with pytest.raises(amuros.ReadError, match=REFUSED):
        describe_text(CONTROLLER.replace("EXECUTOR", executor).replace("10 Hz", rate))


@pytest.mark.parametrize("rate", ["10 Hz", "50 Hz"])
def test_own_messages_that_are_no_more_than_the_jobs_in_which_they_are_due(rate):
    described = describe_text(CONTROLLER.replace("EXECUTOR", PERIODIC).replace("10 Hz", rate))
    assert "On_State" in described.assembly.system.processes


def test_a_publisher_that_runs_in_all_activations_of_its_task_sends_more_than_its_period_says():
    more = CONTROLLER.replace("EXECUTOR", PERIODIC).replace(
        "period: 100 ms,", "period: 100 ms, runs_in: own-task, runs_when: activated,"
    )
    with pytest.raises(amuros.ReadError, match=REFUSED):
        describe_text(more.replace("  executor: {name", "  task_periods: [5 ms, 20 ms]\n  executor: {name"))


def test_two_publishers_send_more_than_either():
    more = "timers: [{name: Other, period: 100 ms, execution_time: 40 us, publishes: [state]}, "
    with pytest.raises(amuros.ReadError, match=REFUSED):
        describe_text(CONTROLLER.replace("EXECUTOR", PERIODIC).replace("timers: [", more))


HOST = """
host:
  ros: humble
  computers: [{name: pc}]
  latency: 2 ms
  executors: [{name: X, computer: pc, type: single-threaded, thread: {policy: fifo, priority: 10, core: 0}}]
  nodes: [{name: h, executor: X, timers: [{name: Send, period: 20 ms, execution_time: 1 ms, SENDS}]}]
"""
RECEIVES = "subscriptions: [{name: On_Wish, topic: /wish, rate: 10 Hz, message_size: 8 B, execution_time: 30 us}]"
SERVES = "services: [{name: add, rate: 10 Hz, request_size: 8 B, response_size: 8 B, execution_time: 30 us}]"


@pytest.mark.parametrize("executor", [PERIODIC, LOOP])
@pytest.mark.parametrize(
    ("part", "sends", "refused"),
    [
        (RECEIVES, "publishes: [wish]", "'On_Wish' receives 'wish', which is published here, too"),
        (SERVES, "calls: [add]", "'add' receives 'add/request', which is published here, too"),
    ],
)
def test_messages_of_the_host_need_a_wire(executor, part, sends, refused):
    controller = CONTROLLER.partition("      publishers:")[0].replace("EXECUTOR", executor)
    with pytest.raises(amuros.ReadError, match=refused):
        describe_text(f"{controller}      {part}\n{HOST.replace('SENDS', sends)}")
