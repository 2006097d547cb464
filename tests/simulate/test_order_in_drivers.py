"""Messages that a driver holds for different times on a wire that loses nothing."""

from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import MILLISECOND, Duration
from amalthea_uros.uros.described import describe_text

#: The driver looks every tick, so that a heartbeat of the agent, drawn to wait less, comes before the message that it announces.
APPLICATION = """\
amuros: 1
name: Late
hardware: {platform: single-core, frequency: 1 GHz}
os: {tick: 10 ms}
middleware:
  executors: [{name: E, execution_time: {base: 1 us}, loop: {spin_some: 2 ms}}]
  transport: {serial: {driver: {write: blocking, read: dma}}}
  agent: {to_controller: {min: 0 ns, max: 483 us}}
application:
  nodes:
    - name: node
      subscriptions: [{name: C, execution_time: 447 us, interval: 10 ms, topic: in, message_size: 4 B, reliability: reliable}]
"""


def test_nothing_is_sent_again_because_a_later_message_is_read_earlier():
    found = simulate_system(describe_text(APPLICATION).assembly.system, Options(duration=Duration(500 * MILLISECOND), seed=1))
    # Its messages enter the wire 10 ms apart, less what they are kept in the agent.
    assert found["in_topic_to_C"].metrics[JobMetric.ACTIVATE_TO_ACTIVATE].min >= 9_517_000_000
