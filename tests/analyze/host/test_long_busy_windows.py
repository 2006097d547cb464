"""Busy windows of an executor of the host that are too long for the busy-window-aware bound."""

import pytest

import amalthea_uros as amuros
from amalthea_uros.units import MILLISECOND

#: A fast timer, and one that is called once in a long time for long.
HOST = """
amuros: 1
name: planner
hardware: {platform: single-core, frequency: 100 MHz}
host:
  ros: foxy
  computers: [{name: pc}]
  executors: [{name: X, computer: pc, type: single-threaded, thread: {policy: fifo, priority: 10, core: 0}}]
  nodes:
    - name: n
      executor: X
      timers: [{name: Fast, period: 2 ms, execution_time: 1 ms}, {name: Plan, period: 10 s, execution_time: SLOW}]
"""


@pytest.mark.parametrize(("slow", "is_said"), [("400 ms", False), ("600 ms", True)])
def test_it_is_said_that_the_bounds_can_be_larger_than_necessary(slow, is_said):
    analysis = amuros.analyze(HOST.replace("SLOW", slow))
    sentence = "bounds in 'X' can be larger than necessary: its longest busy window has more than 500 releases"
    assert (sentence in analysis.assumptions) is is_said
    (fast, _) = analysis.host["X"].handles
    assert fast.response.worst >= int(slow.split()[0]) * MILLISECOND
