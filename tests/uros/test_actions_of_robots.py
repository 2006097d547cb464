"""Actions between controllers and the host: goals, results and feedback have the names of ROS 2."""

import pytest
import yaml
from inline_models import LOOPING_CONTROLLER

import amalthea_uros as amuros
from amalthea_uros.errors import ReadError
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import MILLISECOND
from amalthea_uros.uros.described import describe_text

CONTROLLERS = (
    LOOPING_CONTROLLER
    + """\
    application:
      nodes:
        - name: n
          timers: [{name: Ask, period: 500 ms, execution_time: 20 us, requests: [Done]}]
          action_clients: [&action {name: Done, action: move, goal_size: 8 B, result_size: 8 B, feedback_size: 8 B, interval: 500 ms,
            execution_time: 20 us}]
  - name: b
    hardware: *hardware
    middleware: *middleware
    application:
      nodes:
        - name: n
          action_servers: [{name: move, goal_size: 8 B, result_size: 8 B, feedback_size: 8 B, interval: 500 ms, execution_time: 3 ms}]
host:
  ros: humble
  computers: [{name: pc, cores: 1}]
  latency: 2 ms
  executors: [{name: X, computer: pc, type: single-threaded, thread: {policy: fifo, priority: 10, core: 0}}]
  nodes: [{name: h, executor: X, subscriptions: [{name: Show, topic: move/_action/feedback, execution_time: 1 ms}]}]
"""
)

#: Of the host: it sends goals, gets their results, and shows feedback.
TIMER = {"name": "T", "period": "500 ms", "execution_time": "1 ms", "calls": ["move/_action/send_goal"]}
CLIENT = {"name": "C", "service": "/move/_action/get_result", "execution_time": "1 ms"}
SUBSCRIPTION = {"name": "Show", "topic": "move/_action/feedback", "execution_time": "1 ms"}


def with_callbacks_of_the_host(*removed, **callbacks):
    """The controllers without some of them, and a host with other callbacks."""
    content = yaml.safe_load(CONTROLLERS)
    content["controllers"] = [each for each in content["controllers"] if each["name"] not in removed]
    content["host"]["nodes"] = [{"name": "h", "executor": "X", **callbacks}]
    return yaml.safe_dump(content)


def handles(simulation):
    return {each.name: each.calls for executor in (*simulation.executors, *simulation.host) for each in executor.handles}


def problems(text):
    with pytest.raises(ReadError) as caught:
        describe_text(text)
    return str([(each.message, each.help) for each in caught.value.findings])


def test_the_messages_of_an_action_have_the_topics_of_ros_2():
    data = [each for each in describe_text(CONTROLLERS).assembly.system.network.transmissions if each.topic]
    assert {each.topic for each in data} == {
        "move/_action/send_goal/request",
        "move/_action/get_result/response",
        "move/_action/feedback",
    }


def test_each_goal_is_taken_once_and_has_a_result_and_feedback():
    simulation = amuros.simulate(CONTROLLERS, "5 s")
    assert handles(simulation) == {"a_Ask": 10, "a_Done": 10, "b_move": 10, "Show": 10}


@pytest.mark.parametrize("name", ["result", "feedback"])
def test_chains_over_an_action_are_observed_within_their_bounds(name):
    content = yaml.safe_load(with_callbacks_of_the_host("a", timers=[TIMER], clients=[CLIENT], subscriptions=[SUBSCRIPTION]))
    goal = ["T", "move/_action/send_goal/request", "b_move"]
    content["chains"] = [
        {"name": "result", "path": [*goal, "move/_action/get_result/response", "C"]},
        {"name": "feedback", "path": [*goal, "move/_action/feedback", "Show"]},
    ]
    bounds, observed = (
        amuros.analyze(yaml.safe_dump(content)).chains[name],
        amuros.simulate(yaml.safe_dump(content), "5 s").chains[name],
    )
    times = observed.quantities[ChainQuantity.REDUCED_REACTION_TIME]
    assert observed.observations == 10
    assert bounds.best <= times.min <= times.max <= bounds.worst < 45 * MILLISECOND


def test_a_topic_of_the_name_of_the_action_is_another_one():
    """Nothing publishes it, although the action has that name."""
    text = with_callbacks_of_the_host(subscriptions=[{**SUBSCRIPTION, "topic": "move"}])
    assert "nothing publishes 'move'" in str([each.message for each in amuros.analyze(text).findings])


def test_the_host_sends_goals_by_their_service():
    text = with_callbacks_of_the_host("a", timers=[TIMER], clients=[CLIENT])
    assert handles(amuros.simulate(text, "5 s")) == {"b_move": 10, "T": 10, "C": 10}


def test_the_host_serves_goals_of_a_controller():
    service = {"name": "S", "service": "move/_action/send_goal", "execution_time": "1 ms"}
    text = with_callbacks_of_the_host("b", services=[{**service, "publishes": ["move/_action/get_result/response"]}])
    assert handles(amuros.simulate(text, "5 s")) == {"a_Ask": 10, "a_Done": 10, "S": 10}


def test_a_call_of_the_action_is_no_call_of_one_of_its_services():
    message = problems(with_callbacks_of_the_host(timers=[{**TIMER, "calls": ["move"]}]))
    assert "undefined service 'move'" in message
    assert "move/_action/send_goal" in message


def test_results_of_goals_that_several_nodes_send_are_refused():
    assert "is called in the nodes h, n" in problems(with_callbacks_of_the_host(timers=[TIMER]))


@pytest.mark.parametrize(
    ("more", "sentence"),
    [
        ({}, "requests for results and the status need no time on it"),
        ({"parameter_server": {"execution_time": "1 ms"}}, "requests to parameter servers and lifecycle nodes"),
    ],
)
def test_results_say_what_is_not_on_the_wire(more, sentence):
    content = yaml.safe_load(CONTROLLERS)
    content["controllers"][1]["application"]["nodes"][0] |= more
    assert sentence in str(amuros.analyze(yaml.safe_dump(content)).assumptions)
    assert sentence in str(amuros.simulate(yaml.safe_dump(content), "1 s").assumptions)
