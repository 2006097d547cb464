"""Services between controllers and the host: requests and responses are messages of two topics."""

import pytest
import yaml
from inline_models import LOOPING_CONTROLLER

import amalthea_uros as amuros
from amalthea_uros.errors import ReadError
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import MICROSECOND, MILLISECOND, NANOSECOND
from amalthea_uros.uros.described import describe_text

QUANTITY = ChainQuantity.REDUCED_REACTION_TIME
CONTROLLERS = (
    LOOPING_CONTROLLER
    + """\
    application:
      nodes:
        - name: n
          timers: [{name: Ask, period: 500 ms, execution_time: 20 us, requests: [Got]}]
          clients: [{name: Got, service: add, request_size: 8 B, response_size: 8 B, interval: 500 ms, execution_time: 20 us}]
  - name: b
    hardware: *hardware
    middleware: *middleware
    application:
      nodes:
        - {name: n, services: [{name: add, request_size: 8 B, response_size: 8 B, interval: 500 ms, execution_time: 3 ms}]}
host: {ros: humble, computers: [{name: pc}], latency: 2 ms}
chains: [{name: whole, path: [a_Ask, add/request, b_add, add/response, a_Got]}]
"""
)

#: The service is on the host.
HOST = """
host:
  ros: humble
  computers: [{name: pc, cores: 1}]
  latency: 2 ms
  executors: [{name: X, computer: pc, type: single-threaded, thread: {policy: fifo, priority: 10, core: 0}}]
  nodes: [{name: h, executor: X, services: [{name: Add, service: add, execution_time: 1 ms}]}]
chains: [{name: whole, path: [Ask, add/request, Add, add/response, Got]}]
"""


def of_first_controller(more):
    """What describes the first controller alone, and more."""
    (first, _) = yaml.safe_load(CONTROLLERS)["controllers"]
    return yaml.safe_dump({"amuros": 1, **first}) + more


def handles(simulation):
    return {each.name: each.calls for executor in (*simulation.executors, *simulation.host) for each in executor.handles}


def test_each_request_is_served_and_answered_once():
    simulation = amuros.simulate(CONTROLLERS, "5 s")
    assert handles(simulation) == {"a_Ask": 10, "a_Got": 10, "b_add": 10}
    jobs = {each.name: each.jobs for each in simulation.processes}
    data = {name: count for name, count in jobs.items() if "add" in name and not name.endswith("acknowledgement")}
    assert data == dict.fromkeys(data, 10)
    assert len(data) == 4


def test_a_chain_takes_the_service():
    """Four frames of 86, 110, 110 and 90 bytes with a latency of 2 ms each, four times an agent, twice a topic, three callbacks.

    Got and the service are called 15 us after their messages arrive, the request is sent at the end of Ask.
    """
    (seen,) = amuros.simulate(CONTROLLERS, "5 s").chains
    frames = (86 + 110 + 110 + 90) * 80 * NANOSECOND
    calls = (20 + 15 + 3000 + 15 + 20) * MICROSECOND
    quantity = seen.quantities[QUANTITY]
    assert seen.observations == 10
    assert quantity.min == quantity.max == frames + calls + 4 * 2 * MILLISECOND + 2 * 2 * MILLISECOND + 4 * 500 * MICROSECOND


def test_the_chain_over_the_service_has_a_bound():
    (found,), (seen,) = amuros.analyze(CONTROLLERS).chains, amuros.simulate(CONTROLLERS, "5 s").chains
    assert found.best <= seen.quantities[QUANTITY].min
    assert seen.quantities[QUANTITY].max <= found.worst < 40 * MILLISECOND


def test_what_depends_on_an_unknown_request_is_unknown_on_both_sides():
    """With a sleep, how late acknowledgements are has no bound: nor when requests arrive, nor therefore when their responses do."""
    analysis = amuros.analyze(CONTROLLERS.replace("{spin: 1 s}", "{spin_some: 10 ms, sleep: 1 ms}"))
    for name in ("b_add_request_to_add", "a_add_response_to_Got"):
        assert name not in analysis.solution.event_models
        assert f"unknown times of {name}" in str([each.message for each in analysis.findings])
    assert analysis.chains["whole"].worst is None


@pytest.mark.parametrize("service", ["add", "/add"])
def test_an_answer_without_the_service_is_unknown(service):
    """The agents send requests on as requests only: the chain has to name what makes the response of a request."""
    text = CONTROLLERS.replace("add/request, b_add, add/response", service)
    (chain,) = amuros.analyze(text).chains
    assert chain.worst is None
    assert "'/add/request' is not sent on as '/add/response'" in chain.reason
    (seen,) = amuros.simulate(text, "5 s").chains
    assert seen.observations == 0


def test_the_service_of_a_controller_without_others_is_called_from_outside():
    """Every 500 ms, as it states, with a phase of at most that; and its own response is no request."""
    (_, second) = yaml.safe_load(CONTROLLERS)["controllers"]
    assert handles(amuros.simulate(yaml.safe_dump({"amuros": 1, **second}), "5 s"))["add"] in (9, 10)


def test_a_service_of_the_host_answers_a_controller():
    simulation = amuros.simulate(of_first_controller(HOST), "5 s")
    assert handles(simulation) == {"Ask": 10, "Got": 10, "Add": 10}
    assert simulation.chains["whole"].observations == 10


def test_messages_of_services_have_latencies_of_their_own():
    slower = CONTROLLERS.replace(
        "latency: 2 ms}\nchains", "latency: 2 ms, topics: [{topic: add/response, latency: 7 ms}]}\nchains"
    )
    usual, longer = (amuros.simulate(text, "5 s").chains["whole"].quantities for text in (CONTROLLERS, slower))
    assert longer[QUANTITY].max - usual[QUANTITY].max == 5 * MILLISECOND


def with_timer_of_the_host(service):
    """The controllers, and a timer of the host that calls a service."""
    content = yaml.safe_load(CONTROLLERS)
    content["host"] = yaml.safe_load(HOST)["host"]
    timer = {"name": "T", "period": "1 s", "execution_time": "1 ms", "calls": [service]}
    content["host"]["nodes"] = [{"name": "h", "executor": "X", "timers": [timer]}]
    return yaml.safe_dump(content)


@pytest.mark.parametrize(
    ("service", "message"),
    [("ad", "undefined service 'ad'"), ("add", "the service 'add' is called in the nodes h, n, but which response")],
)
def test_services_that_nobody_has_or_several_nodes_call_are_refused(service, message):
    with pytest.raises(ReadError) as caught:
        describe_text(with_timer_of_the_host(service))
    assert message in str([each.message for each in caught.value.findings])


def test_the_host_can_call_a_service_of_a_controller():
    content = yaml.safe_load(with_timer_of_the_host("add"))
    del content["controllers"][0], content["chains"]
    assert handles(amuros.simulate(yaml.safe_dump(content), "5 s")) == {"b_add": 5, "T": 5}
