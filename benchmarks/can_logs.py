"""Measure how fast logs of CAN buses are read, and what becomes of damaged ones: python benchmarks/can_logs.py [frames]

Each figure is CPU time of a process of its own. The second table is about the log in which every other line was changed at random: our
reader counts each line as a frame or in a finding, while that of python-can ends at the first one that it does not know.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

SUFFIXES = (".log", ".asc", ".blf", ".trc")

_OURS = """
import re, resource, sys, time
from pathlib import Path
from amalthea_uros.trace.can.logs import open_can_log
began = time.process_time()
log = open_can_log(Path(sys.argv[1]))
count = sum(map(len, log))
spent = time.process_time() - began
print(count, spent, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
print("; ".join(f"{finding.rule} {finding.message}" for finding in log.findings))
"""
_THEIRS = """
import resource, sys, time
import can
began, count, end = time.process_time(), 0, ""
try:
    for _ in can.LogReader(sys.argv[1]):
        count += 1
except Exception as error:
    end = f"{type(error).__name__}: {error}"
print(count, time.process_time() - began, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
print(end)
"""


def write_log(path: Path, frames: int) -> None:
    """Write a log of candump with the markers of a few tasks."""
    random, time = Random(1), 1_436_509_052_000_000
    with path.open("w") as stream:
        for _ in range(frames):
            time += random.randrange(20, 900)
            identifier = random.choice(("123", "18000001", "18000002", "7FF"))
            stream.write(f"({time // 10**6}.{time % 10**6:06}) can0 {identifier}#{random.randbytes(8).hex().upper()}\n")


def convert(source: Path, target: Path) -> None:
    """Write a log in another format with python-can."""
    import can

    with can.LogReader(source) as reader, can.Logger(target) as logger:
        for message in reader:
            logger(message)


def damage(source: Path, target: Path) -> int:
    """Change every other line at random; gives the number of lines that are left."""
    random, count = Random(2), 0
    with source.open() as lines, target.open("w", encoding="latin-1") as stream:
        for number, line in enumerate(lines):
            text = line.rstrip("\n")
            if number % 2:
                place = random.randrange(len(text))
                text = text[:place] + random.choice(("", chr(random.randrange(32, 256)), "#", "9" * 20)) + text[place + 1 :]
            count += bool(text)
            stream.write(f"{text}\n")
    return count


def measure(program: str, path: Path) -> tuple[int, float, float, str]:
    """Frames, seconds, largest memory in MB, and what was reported."""
    command = [sys.executable, "-c", program, path]
    figures, *rest = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    count, seconds, kilobytes = figures.split()
    return int(count), float(seconds), int(kilobytes) / 1024, " ".join(rest)


def main() -> None:
    """Print both tables."""
    frames = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000
    print("| log | reader | frames | frames/s | peak MB |\n|---|---|---|---|---|")
    with TemporaryDirectory() as folder:
        plain = Path(folder) / "run.log"
        write_log(plain, frames)
        for suffix in SUFFIXES:
            path = plain.with_suffix(suffix)
            if path != plain:
                convert(plain, path)
            for name, program in (("amuros", _OURS), ("python-can", _THEIRS)):
                count, seconds, memory, _ = measure(program, path)
                print(f"| {suffix} | {name} | {count:,} | {count / seconds:,.0f} | {memory:.0f} |", flush=True)
        damaged = Path(folder) / "damaged.log"
        lines = damage(plain, damaged)
        print(f"\n| damaged log of {lines:,} lines | frames | frames/s | reported |\n|---|---|---|---|")
        for name, program in (("amuros", _OURS), ("python-can", _THEIRS)):
            count, seconds, _, reported = measure(program, damaged)
            print(f"| {name} | {count:,} | {count / seconds:,.0f} | {reported} |")


if __name__ == "__main__":
    main()
