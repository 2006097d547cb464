"""What a command says and returns when it ends early."""

from __future__ import annotations

import os

#: The exit code that shells give a process that Ctrl-C ended: 128 and the number of the signal.
INTERRUPTED = 130


def failed(error: OSError) -> int:
    """Say what could not be read or written, by the descriptor, because the stream may be what failed; the exit code."""
    # The reader of our output is gone, as in `amuros info m.amxmi | head`; that needs no words.
    if not isinstance(error, BrokenPipeError):
        from amalthea_uros.report.basics.escape import visible

        what = "the output cannot be written" if error.filename is None else os.fsdecode(error.filename)
        say(visible(f"{what}: {error.strerror or error}"))
    return 2


def say(message: str) -> None:
    """Say something by the descriptor of standard error."""
    os.write(2, f"amuros: {message}\n".encode(errors="backslashreplace"))
