"""Subscriptions to topics that the same controller publishes: how often their messages come follows from the publisher."""

import pytest

import amalthea_uros as amuros
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import MILLISECOND

#: The callback of the other timer, of 12 ms, makes that of `Send` late.
LOOP = """
amuros: 1
name: own
hardware: {{platform: single-core, frequency: 1 GHz}}
middleware:
  executor: {{name: E, priority: 1, loop: {{spin: 1 s}}, execution_time: {{base: 10 us, per_message: 5 us}}}}
  transport: {{custom: {{table: [{{size: 512 B, time: 1 ms}}]}}}}
  agent: {{to_controller: 500 us, to_host: 500 us}}
application:
  nodes:
    - name: n
      publishers: [&topic {{topic: t, message_size: 8 B, reliability: best-effort}}]
      timers:
        - {{name: Send, period: 100 ms, execution_time: 20 us, publishes: [t]}}
        - {{name: Other, period: 70 ms, execution_time: 12 ms, publishes: [{also}]}}
      subscriptions: [{{<<: *topic, name: Take, interval: {interval}, execution_time: 20 us}}]
"""
STATED = LOOP.format(also="", interval="100 ms")


def distances(result):
    return result.processes["t_topic_to_Take"].metrics[JobMetric.ACTIVATE_TO_ACTIVATE]


def test_the_times_of_the_publisher_count_instead_of_what_is_stated():
    analysis = amuros.analyze(STATED)
    (finding,) = (each for each in analysis.findings if each.rule == "HST003")
    assert "the controller itself can send the messages of 'Take' every 100 ms with a jitter of up to" in finding.message
    observed = distances(amuros.simulate(STATED, "10 s"))
    assert distances(analysis).min <= observed.min < 95 * MILLISECOND


def test_a_task_of_a_callback_is_analysed_only_for_what_is_stated():
    """Its period was chosen for that: the messages of an executor without a loop need a jitter that covers what is sent."""
    text = STATED.replace("loop: {spin: 1 s}", "period: 30 ms")
    analysis = amuros.analyze(text)
    assert analysis.processes["Take"].response is None
    assert "the controller itself can send 't' every 100 ms with a jitter of up to" in str(
        [each.message for each in analysis.findings]
    )
    covered = text.replace("interval: 100 ms", "interval: 100 ms, jitter: 60 ms")
    analysis = amuros.analyze(covered)
    assert not [each for each in analysis.findings if each.rule.startswith("HST")]
    assert distances(analysis).min <= distances(amuros.simulate(covered, "10 s")).min < 95 * MILLISECOND


def test_a_greater_jitter_that_is_stated_remains():
    analysis = amuros.analyze(STATED.replace("interval: 100 ms", "interval: 100 ms, jitter: 50 ms"))
    assert "HST003" not in [each.rule for each in analysis.findings]
    assert distances(analysis).min == 50 * MILLISECOND


def test_messages_may_be_rarer_than_stated():
    analysis = amuros.analyze(STATED.replace("interval: 100 ms", "interval: 90 ms, jitter: 40 ms"))
    assert "HST003" not in [each.rule for each in analysis.findings]
    assert analysis.executors["E"].handles["Take"].response.worst is not None
    assert distances(analysis).min == 50 * MILLISECOND


@pytest.mark.parametrize(
    ("also", "interval", "reason"),
    [
        ("t", "100 ms", "more than one publisher sends 't'"),
        (
            "",
            "110 ms",
            "the controller itself can send the messages of 'Take' every 100 ms, but the subscription states 110 ms",
        ),
    ],
)
def test_messages_that_come_otherwise_than_stated_are_unknown(also, interval, reason):
    analysis = amuros.analyze(LOOP.format(also=also, interval=interval))
    assert analysis.executors["E"].handles["Take"].response.worst is None
    assert reason in str([each.message for each in analysis.findings])
