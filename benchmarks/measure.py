"""One measurement in a process of its own: `python measure.py VARIANT FILE` prints it as JSON.

What a process does once (imports, the facts of the version) is measured apart from the work on the file.
"""

from __future__ import annotations

import json
import resource
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter, process_time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    Work = Callable[[], object]

#: ru_maxrss is in kilobytes, on macOS in bytes.
_PEAK_UNIT = 1 if sys.platform == "darwin" else 1024


def lxml_parse(path: Path, scratch: Path) -> Work:
    from lxml import etree

    return lambda: etree.parse(path)


def amuros_load(path: Path, scratch: Path) -> Work:
    from files import write_empty

    import amalthea_uros

    write_empty(path, scratch)
    amalthea_uros.load(scratch)
    return lambda: amalthea_uros.load(path)


def amuros_save(path: Path, scratch: Path) -> Work:
    import amalthea_uros

    model = amalthea_uros.load(path)
    return lambda: amalthea_uros.save(model, scratch)


def amuros_save_changed(path: Path, scratch: Path) -> Work:
    import amalthea_uros
    from amalthea_uros.metamodel.classes import Task

    model = amalthea_uros.load(path)
    task = next(iter(model.all(Task)), None)
    if task is None:
        raise SystemExit("the model has no task whose value could be changed")
    task.multiple_task_activation_limit = 17
    return lambda: amalthea_uros.save(model, scratch)


def pyecore_load(path: Path, scratch: Path) -> Work:
    import pyecore_reader
    from files import file_version

    pyecore_reader.metamodel(file_version(path))
    return lambda: pyecore_reader.load(path)


def pyecore_save(path: Path, scratch: Path) -> Work:
    import pyecore_reader

    model = pyecore_reader.load(path)
    return lambda: pyecore_reader.save(model, scratch)


VARIANTS = {
    "lxml parse": lxml_parse,
    "amuros load": amuros_load,
    "amuros save": amuros_save,
    "amuros save, one value changed": amuros_save_changed,
    "pyecore load": pyecore_load,
    "pyecore save": pyecore_save,
}


def measure(variant: str, path: Path) -> dict[str, float]:
    """Seconds of wall and CPU time, of CPU time for what happens once, and the peak of memory in bytes."""
    with TemporaryDirectory() as folder:
        begin = process_time()
        work = VARIANTS[variant](path, Path(folder) / "scratch.amxmi")
        wall, cpu = perf_counter(), process_time()
        kept = work()
        wall, cpu, once = perf_counter() - wall, process_time() - cpu, cpu - begin
        del kept
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * _PEAK_UNIT
    return {"wall": wall, "cpu": cpu, "once": once, "peak": peak}


if __name__ == "__main__":
    print(json.dumps(measure(sys.argv[1], Path(sys.argv[2]))))
