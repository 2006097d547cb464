"""How fast an executor that spins in a loop is simulated: ten handles, of which five receive messages over a serial line.

python benchmarks/executors.py
"""

from __future__ import annotations

import argparse
from functools import partial
from importlib.util import find_spec

from simulation import SECOND, Compiled, Interpreted, timed

from amalthea_uros.perf.system import System
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.units import Duration
from amalthea_uros.uros.described import describe_text

_HEAD = """
amuros: 1
name: ten-handles
hardware: {platform: single-core, frequency: 100 MHz}
os: {tick: 1 ms}
middleware:
  executor: {name: main, loop: {spin_some: 10 ms, sleep: 1 ms}, execution_time: {base: 20 us, per_handle: 2 us, per_message: 10 us}}
  transport: {serial: {baud_rate: 921600, interrupt: {name: Receive, execution_time: 2 us}}}
  agent: {to_controller: {min: 0.1 ms, max: 1 ms}, to_host: {min: 0.1 ms, max: 1 ms}, acknowledgement: {min: 0.1 ms, max: 1 ms}}
application:
  nodes:
    - name: n
      publishers: [{topic: state, message_size: 24 B, reliability: best-effort}]
"""
_TIMES = "execution_time: {min: 20 us, max: 60 us}"


def ten_handles() -> System:
    """Five subscriptions and five timers, two of which publish."""
    subscriptions = [
        f"        - {{name: on_{number}, topic: in_{number}, interval: {20 + number} ms, message_size: 24 B, "
        f"reliability: best-effort, {_TIMES}}}"
        for number in range(5)
    ]
    timers = [
        f"        - {{name: timer_{number}, period: {10 + number} ms, {_TIMES}{', publishes: [state]' * (number < 2)}}}"
        for number in range(5)
    ]
    return describe_text("\n".join([_HEAD, "      subscriptions:", *subscriptions, "      timers:", *timers])).assembly.system


def events(found: Simulation) -> tuple[int, int]:
    """Calls of handles; and these, iterations, jobs of processes and preemptions, with two events for each."""
    calls = sum(handle.calls for executor in found.executors for handle in executor.handles)
    return calls, 2 * (calls + sum(process.jobs + process.preemptions.total for process in found.processes))


def main() -> None:
    """Measure it, interpreted and as machine code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeat", type=int, default=3)
    arguments = parser.parse_args()
    system = ten_handles()
    ways = [("interpreted", Interpreted(), 5)]
    if find_spec("numba"):
        ways.append(("machine code", Compiled(), 500))
    for name, way, seconds in ways:
        with way:
            time, found = timed(
                partial(simulate_system, system, Options(duration=Duration(seconds * SECOND))), arguments.repeat
            )
        calls, every = events(found)
        print(
            f"{name}: {calls / time:,.0f} calls/s, {every / time:,.0f} events/s, {seconds / time:,.1f} s of model time per second"
        )


if __name__ == "__main__":
    main()
