"""A line on the terminal while a command takes long: the work, how much of it is done, and for how long so far."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from threading import Event, RLock, Thread
from time import monotonic
from typing import Any, TextIO, cast

from amalthea_uros._internal.machine_code import is_available
from amalthea_uros._internal.records import dataclass
from amalthea_uros.report.basics.display import is_brief
from amalthea_uros.report.writers.terminal import Terminal

#: Seconds that nobody minds.
PATIENCE = 2.0
FASTER = "; faster: pip install 'amuros[fast]'"

#: Command -> what it does. The others show something that is at hand, or wait for a client.
WORK = {
    "import": "Reading",
    "build": "Building",
    "generate": "Generating",
    "check": "Checking",
    "analyze": "Analyzing",
    "chains": "Following paths",
    "simulate": "Simulating",
    "report": "Analyzing and simulating",
    "sweep": "Analyzing",
    "optimize": "Judging designs",
    "measure": "Measuring",
    "compare": "Comparing",
    "calibrate": "Calibrating",
    "info": "Reading",
    "diff": "Comparing",
    "fmt": "Formatting",
    "migrate": "Migrating",
    "export": "Exporting",
    "rules": "Reading rules",
}
#: What machine code makes faster.
_COMPUTING = {"analyze", "chains", "simulate", "report", "sweep", "optimize", "compare", "export"}


@dataclass(slots=True)
class Progress:
    """How much of something is done.

    Attributes
    ----------
    label : what is done
    total : the number of its steps; 0 if it is not made of steps
    """

    label: str
    total: int = 0
    done: int = 0

    def __str__(self) -> str:
        return f"{self.label} ({self.done}/{self.total})" if self.total else self.label

    def step(self, _outcome: object = None) -> None:
        """One more step is done."""
        self.done += 1

    def reach(self, done: int) -> None:
        """So many steps are done."""
        self.done = done


#: What the present command does, and the parts of it that it is in.
_present: list[Progress] = []


@contextmanager
def working(label: str, total: int = 0) -> Iterator[Progress]:
    """Name a part of what the present command does, for people who wait for it.

    Parameters
    ----------
    total : the number of steps, of which the caller reports each
    """
    _present.append(progress := Progress(label, total))
    try:
        yield progress
    finally:
        _present.pop()


def with_progress(name: str, callback: Callable[..., Any] | None) -> Callable[..., Any]:
    """The function of a command that says on a terminal what it does once that takes longer than two seconds.

    Files and pipes get nothing, as the line is for people who wait.
    """
    assert callback is not None

    @wraps(callback)
    def run(**values: Any) -> None:
        stream = sys.stderr
        with working(WORK[name]):
            if stream is None or not stream.isatty() or is_brief(stream):
                callback(**values)
                return
            with _ProgressLine(stream, FASTER if name in _COMPUTING and not is_available() else "").shown():
                callback(**values)

    return run


class _ProgressLine:
    """The line, which makes room for whatever the command writes."""

    def __init__(self, stream: TextIO, hint: str) -> None:
        self._stream = stream
        self._hint = hint
        self._start = monotonic()
        self._room = (Terminal(stream).width or 80) - 1
        self._ended = Event()
        self._lock = RLock()
        #: The columns that the line takes at present.
        self._width = 0
        #: Whether the text before it, if any, has ended.
        self._has_place = True

    @contextmanager
    def shown(self) -> Iterator[None]:
        """Show it while something takes long, and remove it then."""
        streams = sys.stdout, sys.stderr
        sys.stdout, sys.stderr = (cast("TextIO", _StreamBesideLine(each, self)) for each in streams)
        teller = Thread(target=self._repeat, daemon=True)
        teller.start()
        try:
            yield
        finally:
            self._ended.set()
            teller.join()
            sys.stdout, sys.stderr = streams

    def _repeat(self) -> None:
        pause = PATIENCE
        while not self._ended.wait(pause):
            self._show()
            pause = 1
        self.remove()

    def _show(self) -> None:
        with self._lock:
            if self._has_place:
                text = f"{_present[-1]}: {monotonic() - self._start:.0f} s so far{self._hint}"[: self._room]
                self._stream.write(f"\r{text:<{self._width}}")
                self._stream.flush()
                self._width = max(self._width, len(text))

    def remove(self) -> None:
        """Remove it until it is shown again."""
        with self._lock:
            if self._width:
                self._stream.write(f"\r{'':<{self._width}}\r")
                self._stream.flush()
                self._width = 0

    def write(self, stream: TextIO, text: str) -> int:
        """Write a text in its place; it is below the text then, once that is complete."""
        with self._lock:
            self.remove()
            self._has_place = text.endswith("\n")
            return stream.write(text)


class _StreamBesideLine:
    """A standard stream while the line is shown."""

    def __init__(self, stream: TextIO, line: _ProgressLine) -> None:
        self._stream = stream
        self._line = line

    def write(self, text: str) -> int:
        """Write a text."""
        return self._line.write(self._stream, text)

    def flush(self) -> None:
        """Write what is buffered; what comes next may be written past this object, as the bytes of a model are."""
        self._line.remove()
        self._stream.flush()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)
