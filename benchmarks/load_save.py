"""Loading and saving side by side: bare lxml, amuros, pyecore, all on the same file.

Every measurement runs in a fresh process, the variants in turn, so that a busy machine disturbs all of them alike. Ratios are
those of the least CPU times.

    python benchmarks/load_save.py --elements 60000 --repeat 5
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
from dataclasses import asdict, dataclass, field
from importlib.util import find_spec
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from measure import VARIANTS

_HERE = Path(__file__).parent
_PYECORE_REPEAT = 2
_HELP_REPEAT = 10
_HELP = "from amalthea_uros.cli.main import main; main()"


@dataclass
class Row:
    """The measurements of one variant on one file, or why there are none."""

    variant: str
    samples: list[dict[str, float]] = field(default_factory=list)
    note: str = ""

    def values(self, key: str) -> list[float]:
        return [sample[key] for sample in self.samples]

    @property
    def cpu(self) -> float | None:
        """The least CPU time."""
        return min(self.values("cpu"), default=None)


@dataclass(frozen=True)
class Verdict:
    """A figure and what it should be."""

    what: str
    figure: float | None
    target: str
    met: bool | None

    def line(self) -> str:
        figure = "-" if self.figure is None else f"{self.figure:.2f}"
        word = {True: "met", False: "MISSED", None: "not measured"}[self.met]
        return f"  {self.what:<46}{figure:>9}   {self.target:<10}{word}"


def run(path: Path, repeat: int) -> list[Row]:
    """All variants on one file."""
    rows = [Row(variant) for variant in VARIANTS]
    for number in range(repeat):
        for row in rows:
            if not row.note and (number < _PYECORE_REPEAT or not row.variant.startswith("pyecore")):
                _add_sample(row, path)
    return rows


def _add_sample(row: Row, path: Path) -> None:
    if row.variant.startswith("pyecore") and find_spec("pyecore") is None:
        row.note = "pyecore is not installed"
        return
    command: list[str | Path] = [sys.executable, _HERE / "measure.py", row.variant, path]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    if result.returncode:
        row.note = (result.stderr.strip() or f"exit status {result.returncode}").splitlines()[-1]
    else:
        row.samples.append(json.loads(result.stdout))


def help_cpu() -> list[float]:
    """CPU seconds of `amuros --help`, run by run; none if there is no command line."""
    found = []
    for _ in range(_HELP_REPEAT):
        before = _children_cpu()
        result = subprocess.run([sys.executable, "-c", _HELP, "--help"], capture_output=True, check=False)
        if result.returncode:
            return []
        found.append(_children_cpu() - before)
    return found


def _children_cpu() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def verdicts(rows: list[Row]) -> list[Verdict]:
    """The figures of one file that have a target."""
    cpu = {row.variant: row.cpu for row in rows}
    load, save = cpu["amuros load"], cpu["amuros save"]
    return [
        _at_most("amuros load / lxml parse", _ratio(load, cpu["lxml parse"]), 3),
        _at_least("pyecore load / amuros load", _ratio(cpu["pyecore load"], load), 20),
        _at_most("amuros save / amuros load", _ratio(save, load), 0.5),
        _at_most("amuros save, one value changed / amuros load", _ratio(cpu["amuros save, one value changed"], load), 0.5),
    ]


def help_verdict(seconds: list[float]) -> Verdict:
    return _at_most("amuros --help, ms of CPU", 1000 * median(seconds) if seconds else None, 80)


def _ratio(one: float | None, other: float | None) -> float | None:
    return None if one is None or other is None else one / other


def _at_most(what: str, figure: float | None, limit: float) -> Verdict:
    return Verdict(what, figure, f"<= {limit:g}", None if figure is None else figure <= limit)


def _at_least(what: str, figure: float | None, limit: float) -> Verdict:
    return Verdict(what, figure, f">= {limit:g}", None if figure is None else figure >= limit)


def table(rows: list[Row]) -> list[str]:
    """The figures of one file as text."""
    lines = [
        f"  {'':<31}{'wall s':^16}{'CPU s':^16}{'x lxml':>8}{'once':>8}{'peak':>9}",
        f"  {'':<31}{'min':>8}{'median':>8}{'min':>8}{'median':>8}{'':>8}{'CPU s':>8}{'MB':>9}",
    ]
    base = rows[0].cpu
    for row in rows:
        if row.note:
            lines.append(f"  {row.variant:<31}  {row.note}")
            continue
        wall, cpu = row.values("wall"), row.values("cpu")
        times = "".join(f"{value:8.3f}" for value in (min(wall), median(wall), min(cpu), median(cpu)))
        once, peak = min(row.values("once")), max(row.values("peak")) / 1e6
        lines.append(f"  {row.variant:<31}{times}{_ratio(row.cpu, base) or 0:8.1f}{once:8.2f}{peak:9.0f}")
    return lines


def write_model(elements: int, path: Path) -> None:
    """Writes the synthetic model, in another process: the peak of this one would count for those it starts."""
    command: list[str | Path] = [sys.executable, _HERE / "synthetic.py", "--elements", str(elements), "-o", path]
    subprocess.run(command, check=True)


def main() -> None:
    parser = argparse.ArgumentParser(description="Measures loading and saving.")
    parser.add_argument("--elements", type=int, default=60000, help="size of the synthetic model (60000)")
    parser.add_argument("--repeat", type=int, default=5, help="measurements of each variant, two at most of pyecore (5)")
    parser.add_argument("--model", type=Path, help="a real file to measure as well")
    parser.add_argument("--json", type=Path, help="file for all measurements")
    options = parser.parse_args()
    report: list[dict[str, object]] = []
    with TemporaryDirectory() as folder:
        synthetic = Path(folder) / "synthetic.amxmi"
        write_model(options.elements, synthetic)
        for path in filter(None, (synthetic, options.model)):
            rows = run(path, options.repeat)
            judged = verdicts(rows)
            size = path.stat().st_size
            print(f"{path.name}, {size / 1e6:.2f} MB", *table(rows), *(verdict.line() for verdict in judged), "", sep="\n")
            report.append(
                {"file": path.name, "bytes": size, "rows": list(map(asdict, rows)), "verdicts": list(map(asdict, judged))}
            )
    seconds = help_cpu()
    verdict = help_verdict(seconds)
    print("command line", verdict.line(), sep="\n")
    if options.json:
        result = {"files": report, "help": {"cpu": seconds, "verdict": asdict(verdict)}}
        options.json.write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
