"""Descriptions of executors with loops."""

from amalthea_uros.errors import ReadError
from amalthea_uros.uros.described import describe_text

CALLBACKS = """
      publishers: [{topic: state, message_size: 8 B, reliability: best-effort}]
      subscriptions:
        - {name: On_Command, topic: command, rate: 20 Hz, message_size: 8 B, execution_time: 100 us, reliability: best-effort}
        - {name: On_Map, topic: map, rate: 5 Hz, message_size: 16 B, execution_time: 1 ms}
      timers:
        - {name: Control, period: 50 ms, execution_time: 300 us, publishes: [state]}
"""


def described(executor, callbacks=CALLBACKS, more=""):
    """The assembly of an application whose executor has some keys."""
    executor = executor if executor.startswith("executors:") else f"executor: {executor}"
    return describe_text(
        f"""
amuros: 1
name: app
hardware: {{platform: single-core, frequency: 100 MHz}}
middleware:
  {executor}
  {more}
application:
  nodes:
    - name: node{callbacks}
"""
    ).assembly


def executor_of(*arguments, **more):
    """The first executor of such an application."""
    return described(*arguments, **more).system.executors[0]


def findings_of(*arguments, **more):
    """The findings of describing it, by their ids."""
    try:
        found = described(*arguments, **more).findings
    except ReadError as error:
        found = error.findings
    return {finding.rule: finding for finding in found}
