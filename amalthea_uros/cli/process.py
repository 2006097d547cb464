"""The command as a process of its own: how it ends, whatever happens.

It imports next to nothing before it can handle Ctrl-C.
"""

from __future__ import annotations

import atexit
import gc
import os
import signal
import sys
from contextlib import suppress
from types import FrameType
from typing import Any

from amalthea_uros._internal.own_processes import forget_working_folder
from amalthea_uros.cli.ends import INTERRUPTED, broken, failed, say

#: Signals after which everything is cleaned up; one that the caller ignores, as `nohup` does, remains ignored.
_SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP")
#: How many more objects there are before garbage is collected; usually 700, so that imports alone are scanned dozens of times. The
#: imports of a command and a small model make about 110,000, so that these are not scanned at all.
GARBAGE_THRESHOLD = 200_000
#: numpy would otherwise start a thread for each processor when it is imported, to multiply matrices, of which there are none here.
_ONE_THREAD = "OPENBLAS_NUM_THREADS"
#: Somebody who sends so many signals does not want to wait for that.
_INSISTENCE = 3
#: The signals so far.
_received: list[int] = []


def run() -> None:
    """Run the command line; end at once, because to free a large model object by object takes a fifth of a run."""
    try:
        code = _code()
    except KeyboardInterrupt:
        code = INTERRUPTED
    with suppress(KeyboardInterrupt):
        # Libraries clean up, such as the semaphores of processes, whose leaks would be reported after our last line.
        atexit._run_exitfuncs()
    os._exit(128 + _received[0] if _received else code)


def _code() -> int:
    """Run the command line to the end of its output; the exit code."""
    _prepare()
    code, is_lost = 0, False
    try:
        from amalthea_uros.cli.main import main

        main()
    except SystemExit as end:
        if not isinstance(end.code, int):
            raise
        code = end.code
        # Python 3.14 keeps what could not be written, and would fail with it again.
        is_lost = isinstance(end.__cause__, OSError) and end.__cause__.filename is None
    except MemoryError:
        say("not enough memory; the input is too large for this computer, or for its limits")
        code = 2
    except Exception as error:
        code = broken(error)
    try:
        for stream in filter(None, () if is_lost else (sys.stdout, sys.stderr)):
            stream.flush()
    except OSError as error:
        code = failed(error)
    return code


def _prepare() -> None:
    """Have signals end the process, and let the standard streams take every text; import nothing foreign; collect garbage rarely."""
    forget_working_folder()
    gc.set_threshold(GARBAGE_THRESHOLD)
    os.environ.setdefault(_ONE_THREAD, "1")
    for name in _SIGNALS:
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _interrupt)
    sys.unraisablehook = _repeat_interrupt
    if sys.stderr is None:
        from io import StringIO

        sys.stderr = StringIO()  # closed by the caller, who wants no messages
    for stream in (sys.stdout, sys.stderr):
        # An encoding may lack letters of a name, and file names are of any bytes.
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")


def _interrupt(number: int, _frame: FrameType | None) -> None:
    _received.append(number)
    if len(_received) >= _INSISTENCE:
        os._exit(128 + number)
    raise KeyboardInterrupt


def _repeat_interrupt(ignored: Any) -> None:
    """Interrupt again a little later where Python or a library could not pass on an interrupt, as in a finalizer."""
    if not issubclass(ignored.exc_type, KeyboardInterrupt):
        sys.__unraisablehook__(ignored)
        return
    from _thread import interrupt_main
    from threading import Timer

    _received.clear()
    timer = Timer(0.01, interrupt_main)
    timer.daemon = True
    timer.start()
