"""A line on the terminal while something takes long: what is done, and for how long so far."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event, Thread
from time import monotonic
from typing import TextIO

from amalthea_uros._internal.machine_code import is_available
from amalthea_uros.report.basics.display import is_brief

#: Seconds that nobody minds.
PATIENCE = 2.0
FASTER = "pip install 'amuros[fast]' makes this faster"


@contextmanager
def working(label: str) -> Iterator[None]:
    """Say on a terminal that something is in progress once it takes longer than two seconds, and how it becomes faster.

    Files and pipes get nothing, as the line is for people who wait.
    """
    stream = sys.stderr
    if stream is None or not stream.isatty() or is_brief(stream):
        yield
        return
    ended = Event()
    teller = Thread(target=_report, args=(label, "" if is_available() else f"; {FASTER}", stream, ended), daemon=True)
    teller.start()
    try:
        yield
    finally:
        ended.set()
        teller.join()


def _report(label: str, hint: str, stream: TextIO, ended: Event) -> None:
    start = monotonic()
    if ended.wait(PATIENCE):
        return
    width = 0
    while True:
        line = f"{label}: {monotonic() - start:.0f} s so far{hint}"
        width = max(width, len(line))
        stream.write(f"\r{line:<{width}}")
        stream.flush()
        if ended.wait(1):
            break
    stream.write(f"\r{'':<{width}}\r")
    stream.flush()
