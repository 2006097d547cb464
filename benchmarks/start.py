"""How much a first look costs: CPU time of whole commands on a sample, as a multiple of what Python takes to import their libraries.

The commands take turns, so that whatever else the computer does concerns all of them; of each the least time counts. All modules are
compiled before, as those of an installed package are. With the folder of another checkout, `python benchmarks/start.py FOLDER`, its
commands take turns with the present ones, as the figures before a change.

The unit is measured with one thread of OpenBLAS, to which the commands limit numpy, and with a thread for each processor, as numpy
has it by itself: on an idle computer these wait busily, so that the unit is longer than on a busy one. The unit contains pydantic, a
library of amuros when the targets were set; the extra `bench` has it.
"""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

ROUNDS = 5
ROOT = Path(__file__).parents[1]
SAMPLES = ROOT / "samples"
APPLICATION, MODEL = (SAMPLES / f"bodas-test-advanced.{suffix}" for suffix in ("yaml", "amxmi"))
IMPORTS = "import numpy, click, yaml, pydantic"
ONE_THREAD, MORE_THREADS = f"{IMPORTS}, one thread", f"{IMPORTS}, a thread for each processor"
#: The unit -> the threads of OpenBLAS.
UNITS = {ONE_THREAD: 1, MORE_THREADS: os.cpu_count()}
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
    if find_spec("pydantic") is None:
        sys.exit("the unit needs pydantic: pip install 'amuros[bench]'")
    roots = [ROOT, *map(Path, sys.argv[1:2])]
    calls = {(name, root): ["-m", "amalthea_uros", *map(str, words)] for name, words in COMMANDS.items() for root in roots}
    calls |= {(unit, ROOT): ["-c", IMPORTS] for unit in UNITS}
    with TemporaryDirectory() as folder:
        # The first round compiles.
        rounds = [{call: _cpu(words, folder, *call) for call, words in calls.items()} for _ in range(ROUNDS + 1)][1:]
    least = {call: min(each[call] for each in rounds) for call in calls}
    for name in UNITS:
        print(f"{name}: {least[name, ROOT]:.2f} s of CPU time")
    one, more = (least[name, ROOT] for name in UNITS)
    for name in COMMANDS:
        now, *before = (least[name, root] for root in roots)
        times = f"{now / one:.1f} times the imports with one thread, {now / more:.1f} times with more"
        print(f"{name}: {now:.2f} s, {times}{''.join(f'; before {each:.2f} s' for each in before)}")


def _cpu(words: list[str], folder: str, name: str, root: Path) -> float:
    """Seconds of CPU time of a process of Python."""
    own = {"PYTHONPATH": str(root), "PYTHONPYCACHEPREFIX": str(Path(folder, "compiled"))}
    own["OPENBLAS_NUM_THREADS"] = str(UNITS.get(name, 1))
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"} | own
    streams = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    process = subprocess.Popen([sys.executable, *words], cwd=folder, env=environment, **streams)
    _, _, usage = os.wait4(process.pid, 0)
    return usage.ru_utime + usage.ru_stime


if __name__ == "__main__":
    main()
