"""The initialisation of the middleware, and its static pools."""

import pytest

from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import parse_time
from amalthea_uros.uros.initialisation import response_cycles

APP = """
    amuros: 1
    name: app
    hardware: {{platform: single-core}}
    middleware:
      executor: {{period: 1 ms}}
      initialisation: {{response_time: {{min: 9.304 ms, max: 101.150 ms}}}}
      limits: {{{limits}}}
    application:
      nodes:
        - name: node
          publishers:
            - {{topic: out, message_size: {size}, reliability: {reliability}}}
          timers:
            - {{name: Timer, period: 1 ms, execution_time: 2 us, publishes: [out]}}
          subscriptions:
            - {{name: A, topic: a, message_size: 4 B, interval: 1 ms, execution_time: 2 us}}
            - {{name: B, topic: b, message_size: 4 B, interval: 1 ms, execution_time: 2 us}}
          services:
            - {{name: Ask, rate: 1 Hz, request_size: 4 B, response_size: 4 B, execution_time: 2 us}}
"""


def app(limits="", size="4 B", reliability="reliable"):
    return APP.format(limits=limits, size=size, reliability=reliability)


@pytest.mark.parametrize(
    ("response", "cycles"),
    # Response times that were measured on the controller (thesis, section 4.2), at a task cycle of 1 ms.
    [("97.258 ms", 98), ("101.150 ms", 102), ("9.304 ms", 10), ("0.4 ms", 1), ("1 ms", 1)],
)
def test_each_cycle_checks_for_the_response(response, cycles):
    assert response_cycles(parse_time(response), MS) == cycles


def test_entities_in_the_order_of_creation(author):
    start = author.describe(app()).initialisation
    assert [f"{entity.kind} {entity.name}" for entity in start.entities] == [
        *("session client", "participant node", "topic out", "publisher out", "datawriter out"),
        *("topic a", "subscriber a", "datareader a", "topic b", "subscriber b", "datareader b", "replier Ask"),
    ]
    # A cycle for each request, then 10 to 102 that check for the response; both subscriptions ask for data before the last one.
    assert (start.min_cycles, start.max_cycles) == (12 * 11, 12 * 103 + 2)
    assert start.max_time == (12 * 103 + 1) * MS


def test_what_the_application_needs(author):
    pools = {pool.name: (pool.needed, pool.available) for pool in author.describe(app("RMW_UXRCE_MAX_NODES: 2")).pools}
    assert pools == {
        "RMW_UXRCE_MAX_SESSIONS": (1, 1),
        "RMW_UXRCE_MAX_NODES": (1, 2),
        "RMW_UXRCE_MAX_TOPICS": (3, 8),  # -1: as many as publishers and subscriptions together
        "RMW_UXRCE_MAX_PUBLISHERS": (1, 4),
        "RMW_UXRCE_MAX_SUBSCRIPTIONS": (2, 4),
        "RMW_UXRCE_MAX_SERVICES": (1, 4),
        "RMW_UXRCE_MAX_CLIENTS": (0, 4),
        "RMW_UXRCE_MAX_WAIT_SETS": (1, 4),
        "RMW_UXRCE_MAX_GUARD_CONDITION": (1, 4),  # of the timer
        "RMW_UXRCE_MAX_HISTORY": (3, 8),  # both subscriptions and the service
    }
