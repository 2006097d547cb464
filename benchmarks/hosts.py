"""How long hosts of ROS 2 take to analyse and to simulate, and how that grows with their callbacks.

8 executors of all kinds in threads of fixed priority on 4 cores, and 20 chains of callbacks through them.

python benchmarks/hosts.py
"""

from __future__ import annotations

import argparse
from functools import partial

from response_times import least_time

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.units import SECOND, Duration
from amalthea_uros.uros.described import describe_text

CHAINS, EXECUTORS, CORES, LOAD = 20, 8, 4, 0.3
TYPES = ("single-threaded", "static-single-threaded", "events", "single-threaded")


def large_host(callbacks: int) -> System:
    """Chains of timers and subscriptions, each of which changes the executor in the middle."""
    hops = callbacks // CHAINS
    executors = [
        f"    - {{name: E{number}, type: {TYPES[number % 4]}, "
        f"thread: {{policy: fifo, priority: {90 - number}, core: {number % CORES}}}}}"
        for number in range(EXECUTORS)
    ]
    timers: dict[int, list[str]] = {number: [] for number in range(EXECUTORS)}
    subscriptions: dict[int, list[str]] = {number: [] for number in range(EXECUTORS)}
    topics, chains = [], []
    for chain in range(CHAINS):
        period = 20 + 5 * chain
        cost = int(period * 1000 * LOAD * CORES / callbacks)
        for hop in range(hops):
            executor = (chain + (0 if hop < hops // 2 else 3)) % EXECUTORS
            publishes = f", publishes: [t{chain}_{hop + 1}]" if hop + 1 < hops else ""
            times = f"execution_time: {{min: {cost // 2} us, max: {cost} us}}{publishes}"
            if hop == 0:
                timers[executor].append(f"        - {{name: c{chain}_0, period: {period} ms, {times}}}")
            else:
                subscriptions[executor].append(f"        - {{name: c{chain}_{hop}, topic: t{chain}_{hop}, {times}}}")
                latency = "{min: 50 us, max: 100 us}" if hop == hops // 2 else "0 us"
                topics.append(f"    - {{topic: t{chain}_{hop}, latency: {latency}}}")
        path = ", ".join(f"c{chain}_{hop}" for hop in range(hops))
        chains.append(f"  - {{name: chain{chain}, path: [{path}], reaction: 10 s}}")
    nodes = []
    for number in range(EXECUTORS):
        nodes += [f"    - name: n{number}", f"      executor: E{number}"]
        for key, items in (("timers", timers[number]), ("subscriptions", subscriptions[number])):
            nodes += [f"      {key}:", *items] if items else []
    head = ["amuros: 1", "name: large-host", "hardware: {platform: host}", "host:", "  ros: humble"]
    parts = [*head, f"  computers: [{{name: pc, cores: {CORES}}}]", "  executors:", *executors, "  nodes:", *nodes]
    return describe_text("\n".join([*parts, "  topics:", *topics, "chains:", *chains])).assembly.system


def main() -> None:
    """Measure hosts of several sizes."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    for callbacks in (100, 200, 400):
        system = large_host(callbacks)
        took = least_time(partial(analyze_system, system), options.repeat) / 1000
        known = sum(each.worst is not None for each in analyze_system(system).chains)
        print(
            f"analysis of {callbacks} callbacks, {EXECUTORS} executors, {CORES} cores, {CHAINS} chains ({known} bounds): {took:.2f} s"
        )
        took = least_time(partial(simulate_system, system, Options(duration=Duration(SECOND))), 1) / 1000
        print(f"simulation of 1 s of {callbacks} callbacks: {took:.2f} s")


if __name__ == "__main__":
    main()
