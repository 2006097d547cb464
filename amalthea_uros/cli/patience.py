"""A line on the terminal while something takes long: the work, how much of it is done, and for how long so far."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event, Thread
from time import monotonic
from typing import TextIO

from amalthea_uros._internal.machine_code import is_available
from amalthea_uros._internal.records import dataclass
from amalthea_uros.report.basics.display import is_brief

#: Seconds that nobody minds.
PATIENCE = 2.0
FASTER = "; faster: pip install 'amuros[fast]'"


@dataclass(slots=True)
class Progress:
    """How much of something is done.

    Attributes
    ----------
    label : what is done
    total : the number of its steps; 0 if it is not made of steps
    """

    label: str
    total: int
    done: int = 0

    def __str__(self) -> str:
        return f"{self.label} ({self.done}/{self.total})" if self.total else self.label

    def step(self, _outcome: object = None) -> None:
        """One more step is done."""
        self.done += 1

    def reach(self, done: int) -> None:
        """So many steps are done."""
        self.done = done


@contextmanager
def working(label: str, total: int = 0, *, is_computing: bool = True) -> Iterator[Progress]:
    """Say on a terminal that something is in progress once it takes longer than two seconds, and how it becomes faster.

    Files and pipes get nothing, as the line is for people who wait.

    Parameters
    ----------
    total : the number of steps, of which the caller reports each
    is_computing : whether machine code makes it faster
    """
    progress, stream = Progress(label, total), sys.stderr
    if stream is None or not stream.isatty() or is_brief(stream):
        yield progress
        return
    ended, hint = Event(), FASTER if is_computing and not is_available() else ""
    teller = Thread(target=_report, args=(progress, hint, stream, ended), daemon=True)
    teller.start()
    try:
        yield progress
    finally:
        ended.set()
        teller.join()


def _report(progress: Progress, hint: str, stream: TextIO, ended: Event) -> None:
    start = monotonic()
    if ended.wait(PATIENCE):
        return
    width = 0
    while True:
        line = f"{progress}: {monotonic() - start:.0f} s so far{hint}"
        width = max(width, len(line))
        stream.write(f"\r{line:<{width}}")
        stream.flush()
        if ended.wait(1):
            break
    stream.write(f"\r{'':<{width}}\r")
    stream.flush()
