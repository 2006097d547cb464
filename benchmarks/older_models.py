"""How long older models take from the file to response times: python benchmarks/older_models.py"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

_PACKAGES = ("central", "common", "components", "config", "constraints", "events", "hw", "mapping", "os", "stimuli", "sw")

#: Measured in a process of its own: nothing may be kept from one measurement to the next.
_MEASURE = """
import resource, sys
from amalthea_uros import analyze_files, load
(analyze_files if sys.argv[2] == "analyze" else load)(sys.argv[1])
used = resource.getrusage(resource.RUSAGE_SELF)
print(used.ru_utime + used.ru_stime, used.ru_maxrss / 1000)
"""


def main() -> None:
    parser = argparse.ArgumentParser(description="Measures reading, migrating and analysing older models.")
    parser.add_argument("--runnables", type=int, default=500, help="size of the smallest synthetic model (500)")
    parser.add_argument("--repeat", type=int, default=3, help="measurements (3)")
    parser.add_argument("--model", type=Path, help="a file to measure instead")
    options = parser.parse_args()
    if options.model:
        report(options.model.name, options.model, options.repeat)
        return
    with TemporaryDirectory() as folder:
        for factor in (1, 2, 4):
            path = Path(folder) / f"{factor}.amxmi"
            path.write_text(itea_model(options.runnables * factor))
            report(f"ITEA 1.2.0, ids, {options.runnables * factor} runnables", path, options.repeat)


def report(name: str, path: Path, repeat: int) -> None:
    """Print the least CPU time and the largest memory of some runs."""
    for what in ("load", "analyze"):
        runs = [measured(path, what) for _ in range(repeat)]
        seconds, megabytes = min(run[0] for run in runs), max(run[1] for run in runs)
        print(f"{name}, {path.stat().st_size / 1e6:.1f} MB, {what}: {seconds:.2f} s CPU with imports, {megabytes:.0f} MB")


def measured(path: Path, what: str) -> tuple[float, float]:
    """CPU seconds and megabytes of a process that loads or analyses a file."""
    output = subprocess.run(
        [sys.executable, "-c", _MEASURE, str(path), what], check=True, capture_output=True, text=True
    ).stdout
    seconds, megabytes = map(float, output.split())
    return seconds, megabytes


def itea_model(runnables: int, accesses: int = 60) -> str:
    """A model in the form of ITEA 1.2.0, with ten labels for each runnable and references by id."""
    labels = runnables * 10
    spaces = " ".join(f'xmlns:{name}="http://www.amalthea.itea2.org/model/1.2.0/{name}"' for name in _PACKAGES)
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<central:AMALTHEA xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" {spaces} '
        'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">',
        f'<swModel xmi:id="{uuid("m", 0)}"><tasks xmi:id="{uuid("t", 0)}" name="T" priority="1" preemption="preemptive" '
        f'stimuli="{uuid("s", 0)}"><callGraph><graphEntries xsi:type="sw:CallSequence">',
    ]
    lines += [f'<calls xsi:type="sw:TaskRunnableCall" runnable="{uuid("r", number)}"/>' for number in range(runnables)]
    lines.append("</graphEntries></callGraph></tasks>")
    for number in range(runnables):
        lines.append(f'<runnables xmi:id="{uuid("r", number)}" name="R{number}">')
        lines.append(f'<runnableItems xsi:type="sw:InstructionsConstant" xmi:id="{uuid("i", number)}" value="100"/>')
        for access in range(accesses):
            label, kind = (number * 7 + access * 13) % labels, "write" if access % 3 == 0 else "read"
            identifier = uuid("a", number * accesses + access)
            lines.append(
                f'<runnableItems xsi:type="sw:LabelAccess" xmi:id="{identifier}" data="{uuid("l", label)}" access="{kind}"/>'
            )
        lines.append("</runnables>")
    lines += [
        f'<labels xmi:id="{uuid("l", number)}" name="L{number}"><size numberBits="32"/></labels>' for number in range(labels)
    ]
    lines.append(f'</swModel><stimuliModel><stimuli xsi:type="stimuli:Periodic" xmi:id="{uuid("s", 0)}" name="S">')
    lines.append('<recurrence value="1000" unit="ms"/></stimuli></stimuliModel></central:AMALTHEA>')
    return "\n".join(lines)


def uuid(kind: str, number: int) -> str:
    """An id as editors made them: an underscore and 22 characters."""
    return f"_{kind}{number:021d}"


if __name__ == "__main__":
    main()
