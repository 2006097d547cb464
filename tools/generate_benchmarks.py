"""Measure, and write the page of the figures: python tools/generate_benchmarks.py [--measure] [FOLDER]

With `--measure` the programs of `benchmarks` run, and what they print is kept in `benchmarks/figures.json`, with the computer, the
versions and the day. The page `docs/benchmarks.md` is made of that file.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import subprocess
import sys
from collections.abc import Callable
from datetime import UTC, datetime
from functools import partial
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

from templating import ROOT, templates

FOLDER = ROOT / "benchmarks"
FIGURES = FOLDER / "figures.json"
PAGE = "benchmarks.md"
#: What was measured, and the figure.
Rows = list[tuple[str, str]]
LIBRARIES = ("amuros", "lxml", "numpy", "numba", "pyecore")


def measure() -> dict[str, Any]:
    """Run all programs, one after the other."""
    return {
        "day": datetime.now(UTC).date().isoformat(),
        "machine": f"{_processor()}, {os.cpu_count()} cores, {platform.system()} {platform.machine()}",
        "versions": {"Python": platform.python_version(), **{name: found for name in LIBRARIES if (found := _version(name))}},
        "tables": {title: rows() for title, rows in TABLES.items()},
    }


def _processor() -> str:
    """The name of the processor, which Python knows on some systems only."""
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.exists() else []
    names = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(names, platform.processor() or "unknown processor")


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _printed(program: str) -> Rows:
    """What a program measured, and the figures: the part of each line that it prints after the last colon."""
    print(program, flush=True)
    run = subprocess.run([sys.executable, FOLDER / program], check=True, stdout=subprocess.PIPE, text=True)
    lines = [line.rpartition(": ") for line in run.stdout.splitlines()]
    return [(what, figure) for what, colon, figure in lines if colon]


def _side_by_side() -> Rows:
    """The least CPU time and the memory of each way to load and save the same file."""
    print("load_save.py", flush=True)
    with TemporaryDirectory() as folder:
        path = Path(folder) / "figures.json"
        subprocess.run([sys.executable, FOLDER / "load_save.py", "--json", path], check=True, stdout=subprocess.DEVNULL)
        result = json.loads(path.read_text(encoding="utf-8"))
    (file,) = result["files"]
    rows = [(f"{row['variant']}, {file['bytes'] / 1e6:.1f} MB", row["note"] or _least(row["samples"])) for row in file["rows"]]
    return [*rows, ("amuros --help", f"{1000 * median(result['help']['cpu']):.0f} ms")]


def _least(samples: list[dict[str, float]]) -> str:
    cpu, peak = min(sample["cpu"] for sample in samples), max(sample["peak"] for sample in samples)
    return f"{cpu:.3f} s of CPU time, {peak / 1e6:.0f} MB of memory"


#: Title of a table -> how its rows are measured.
TABLES: dict[str, Callable[[], Rows]] = {
    "Loading and saving": _side_by_side,
    "A first look": partial(_printed, "start.py"),
    "Building": partial(_printed, "build.py"),
    "Response times": partial(_printed, "response_times.py"),
    "Event chains": partial(_printed, "chains.py"),
    "Hosts of ROS 2": partial(_printed, "hosts.py"),
    "Checking": partial(_printed, "check.py"),
    "From measurements to better designs": partial(_printed, "closed_loop.py"),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--measure", action="store_true", help="measure first; takes minutes")
    parser.add_argument("folder", nargs="?", type=Path, default=ROOT / "docs")
    options = parser.parse_args()
    if options.measure:
        FIGURES.write_text(json.dumps(measure(), indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
    figures = json.loads(FIGURES.read_text(encoding="utf-8"))
    page = templates().get_template("benchmarks.md").render(figures)
    (options.folder / PAGE).write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
