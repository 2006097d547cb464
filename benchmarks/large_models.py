"""How loading, checking, analysing and comparing grow with the size of a model: python benchmarks/large_models.py"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

#: Elements for each megabyte of a synthetic model.
_ELEMENTS_PER_MB = 12_000
#: The greatest time per megabyte of the largest model, relative to that of the smallest one.
_TARGET = 1.3

#: Measured in a process of its own, imports included: nothing may be kept from one measurement to the next.
_MEASURE = """
import resource, sys
import amalthea_uros as amuros
what, model, other = sys.argv[1:]
match what:
    case "load":
        amuros.load(model)
    case "check":
        amuros.check_files(model)
    case "analyze":
        amuros.analyze_files(model)
    case "diff":
        amuros.diff(model, other)
used = resource.getrusage(resource.RUSAGE_SELF)
print(used.ru_utime + used.ru_stime, used.ru_maxrss / 1000)
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition(":")[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=[5, 20, 50], metavar="MB", help="sizes of the models (5 20 50)")
    parser.add_argument("--repeat", type=int, default=3, help="measurements (3)")
    options = parser.parse_args()
    with TemporaryDirectory() as folder:
        models = [(size, *write_models(size, Path(folder))) for size in options.sizes]
        for what in ("load", "check", "analyze", "diff"):
            per_megabyte = [report(what, size, model, other, options.repeat) for size, model, other in models]
            growth = per_megabyte[-1] / per_megabyte[0]
            verdict = "met" if growth <= _TARGET else "missed"
            print(f"{what}: time per MB grows by a factor of {growth:.2f}, target {_TARGET:g}: {verdict}")


def write_models(megabytes: int, folder: Path) -> tuple[Path, Path]:
    """A model, and the same one with other execution times."""
    model, other = folder / f"{megabytes}.amxmi", folder / f"{megabytes}-changed.amxmi"
    # In a process of its own: a process starts with the largest memory of the one that starts it.
    elements = str(megabytes * _ELEMENTS_PER_MB)
    subprocess.run([sys.executable, Path(__file__).with_name("synthetic.py"), "--elements", elements, "-o", model], check=True)
    with model.open(encoding="utf-8") as lines, other.open("w", encoding="utf-8") as changed:
        changed.writelines(line.replace('upperBound="', 'upperBound="1') for line in lines)
    return model, other


def report(what: str, megabytes: int, model: Path, other: Path, repeat: int) -> float:
    """Print the least CPU time and the largest memory of some runs; returns the time per megabyte."""
    runs = [measured(what, model, other) for _ in range(repeat)]
    seconds, memory = min(run[0] for run in runs), max(run[1] for run in runs)
    print(
        f"{what}, {megabytes} MB: {seconds:.2f} s CPU with imports, {seconds / megabytes:.3f} s per MB; "
        f"{memory:.0f} MB of memory, {memory / megabytes:.0f} per MB",
        flush=True,
    )
    return seconds / megabytes


def measured(what: str, model: Path, other: Path) -> tuple[float, float]:
    """CPU seconds and megabytes of a process."""
    command = [sys.executable, "-c", _MEASURE, what, str(model), str(other)]
    output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    seconds, megabytes = map(float, output.split())
    return seconds, megabytes


if __name__ == "__main__":
    main()
