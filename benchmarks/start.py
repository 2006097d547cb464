"""How much a first look costs: CPU time of whole commands on a sample, as a multiple of what Python takes to import their libraries.

The commands take turns, so that whatever else the computer does concerns all of them; of each the least time counts.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

ROUNDS = 5
SAMPLES = Path(__file__).parents[1] / "samples"
APPLICATION, MODEL = (SAMPLES / f"bodas-test-advanced.{suffix}" for suffix in ("yaml", "amxmi"))
IMPORTS = "import numpy, click, yaml, pydantic"
COMMANDS = {
    "amuros --help": ["--help"],
    "amuros analyze app.yaml": ["analyze", APPLICATION],
    "amuros analyze x.amxmi": ["analyze", MODEL],
    "amuros check app.yaml": ["check", APPLICATION],
    "amuros build app.yaml": ["build", APPLICATION, "-o", "app.amxmi"],
    "amuros analyze app.yaml --explain CHAIN": ["analyze", APPLICATION, "--explain", "factor-to-output"],
    "amuros report app.yaml": ["report", APPLICATION, "-o", "report.html"],
}


def main() -> None:
    with TemporaryDirectory() as folder:
        words = {name: ["-m", "amalthea_uros", *map(str, command)] for name, command in COMMANDS.items()}
        words[IMPORTS] = ["-c", IMPORTS]
        rounds = [{name: _cpu([sys.executable, *each], folder) for name, each in words.items()} for _ in range(ROUNDS)]
    least = {name: min(each[name] for each in rounds) for name in words}
    print(f"{IMPORTS}: {least[IMPORTS]:.2f} s of CPU time")
    for name in COMMANDS:
        print(f"{name}: {least[name]:.2f} s, {least[name] / least[IMPORTS]:.1f} times the imports")


def _cpu(command: list[str], folder: str) -> float:
    """Seconds of CPU time of a process."""
    environment = {**os.environ, "PYTHONPATH": str(SAMPLES.parent)}
    streams = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    process = subprocess.Popen(command, cwd=folder, env=environment, **streams)
    _, _, usage = os.wait4(process.pid, 0)
    return usage.ru_utime + usage.ru_stime


if __name__ == "__main__":
    main()
