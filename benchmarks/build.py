"""How much CPU time `amuros build` takes for an application of many callbacks, as a whole process.

python benchmarks/build.py --callbacks 2000 --repeat 5
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

TARGET = 2.0
PER_NODE = 50

HEAD = """amuros: 1
name: large
hardware: {platform: bodas-rc18-12-40}
middleware:
  task_periods: [1 ms, 10 ms, 20 ms, 100 ms, 1 s]
  executor: {execution_time: {base: 12 us, per_message: {fixed: 3 us, per_byte: 10 ns}, per_ready_callback: 1 us}}
application:
  nodes:
"""


def description(callbacks: int) -> str:
    """Nodes with as many subscriptions as timers, which publish, and a chain for every tenth pair."""
    nodes = range(-(-callbacks // PER_NODE))
    return HEAD + "".join(line for node in nodes for line in node_lines(node)) + "chains:\n" + "".join(chains(nodes))


def node_lines(node: int) -> Iterator[str]:
    yield f"    - name: node_{node}\n      core: Core_{node % 4}\n      publishers:\n"
    for index in range(PER_NODE // 2):
        yield f"        - {{topic: out_{node}_{index}, message_size: 16 B}}\n"
    yield "      subscriptions:\n"
    for index in range(PER_NODE // 2):
        rate = (1, 5, 10, 50)[index % 4]
        yield (
            f"        - {{name: Sub_{node}_{index}, topic: in_{node}_{index}, rate: {rate} Hz, message_size: 16 B, "
            f"execution_time: {{min: 1 us, avg: 1.5 us, max: 2 us}}, writes: [value_{node}_{index}]}}\n"
        )
    yield "      timers:\n"
    for index in range(PER_NODE // 2):
        period = (10, 20, 100)[index % 3]
        yield (
            f"        - {{name: Timer_{node}_{index}, period: {period} ms, execution_time: 3 us, "
            f"reads: [value_{node}_{index}], publishes: [out_{node}_{index}]}}\n"
        )


def chains(nodes: range) -> Iterator[str]:
    for node in nodes:
        for index in range(0, PER_NODE // 2, 10):
            path = f"[Sub_{node}_{index}, Timer_{node}_{index}]"
            yield f"  - {{name: chain_{node}_{index}, path: {path}, reaction: 2 s}}\n"


def cpu_time_of_children() -> float:
    """Of all that have ended; other programs on the computer disturb it less than the time on the wall."""
    times = os.times()
    return times.children_user + times.children_system


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--callbacks", type=int, default=2000)
    parser.add_argument("--repeat", type=int, default=5)
    options = parser.parse_args()
    with TemporaryDirectory() as folder:
        path = Path(folder) / "app.yaml"
        path.write_text(description(options.callbacks))
        times = []
        for _ in range(options.repeat):
            start = cpu_time_of_children()
            subprocess.run([sys.executable, "-m", "amalthea_uros", "build", path], check=True, capture_output=True)
            times.append(cpu_time_of_children() - start)
        size = path.with_suffix(".amxmi").stat().st_size / 1e6
    verdict = "met" if min(times) < TARGET else "missed"
    print(f"{options.callbacks} callbacks, {size:.1f} MB: min {min(times):.2f} s, median {statistics.median(times):.2f} s")
    print(f"target {TARGET:g} s: {verdict}")


if __name__ == "__main__":
    main()
