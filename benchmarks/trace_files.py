"""Measure how fast traces are written, and with how much memory: python benchmarks/trace_files.py [seconds of model time]

The events are those of the sample drive-and-lift, about 10,000 in each second of model time; 1000 s are ten million. Each format is
written in a process of its own.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

MODEL = Path(__file__).parents[1] / "samples" / "drive-and-lift.yaml"
SUFFIXES = (".btf", ".btf.gz", ".csv", ".pftrace", ".json")

_MEASURE = """
import resource, sys, time
from amalthea_uros.services.simulate import simulate
began = time.perf_counter()
simulate(sys.argv[1], sys.argv[2], trace_paths=sys.argv[3:])
print(time.perf_counter() - began, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


def measure(duration: str, *traces: Path) -> tuple[float, float]:
    """Seconds of a run, and the largest memory of its process in MB."""
    command = [sys.executable, "-c", _MEASURE, MODEL, duration, *traces]
    seconds, kilobytes = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
    return float(seconds), int(kilobytes) / 1024


def main() -> None:
    """Print a row for each format; the first one is a run without a trace."""
    duration = f"{sys.argv[1] if len(sys.argv) > 1 else 100} s"
    print(f"| trace of {duration} | s | peak MB | file MB |\n|---|---|---|---|")
    with TemporaryDirectory() as folder:
        for suffix in ("none", *SUFFIXES):
            traces = [] if suffix == "none" else [Path(folder) / f"trace{suffix}"]
            seconds, memory = measure(duration, *traces)
            size = sum(trace.stat().st_size for trace in traces) / 10**6
            print(f"| {suffix} | {seconds:.1f} | {memory:.0f} | {size:.0f} |", flush=True)


if __name__ == "__main__":
    main()
