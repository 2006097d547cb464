"""What a command says and returns when it ends early."""

from __future__ import annotations

import os

#: The exit code that shells give a process that Ctrl-C ended: 128 and the number of the signal.
INTERRUPTED = 130
#: The exit code for a flaw of this program: EX_SOFTWARE of sysexits.h, of BSD. It is none of those that say something about the input.
INTERNAL_ERROR = 70
#: Where such a flaw is reported.
ISSUES = "https://github.com/amuros/amuros/issues"
#: The environment variable that has the traceback shown.
TRACEBACK = "AMUROS_TRACEBACK"
#: Characters of an exception in one sentence; some quote what they were given.
_LONGEST = 300


def failed(error: OSError) -> int:
    """Say what could not be read or written, by the descriptor, because the stream may be what failed; the exit code."""
    # The reader of our output is gone, as in `amuros info m.amxmi | head`; that needs no words.
    if not isinstance(error, BrokenPipeError):
        from amalthea_uros.report.basics.escape import visible

        what = "the output cannot be written" if error.filename is None else os.fsdecode(error.filename)
        say(visible(f"{what}: {error.strerror or error}"))
    return 2


def broken(error: Exception) -> int:
    """Say that something went wrong that must not, and how to report it; the exit code."""
    from amalthea_uros.report.basics.escape import visible

    if os.environ.get(TRACEBACK):
        import traceback

        for line in "".join(traceback.format_exception(error)).splitlines():
            say(visible(line))
    where = "with the lines above" if os.environ.get(TRACEBACK) else f"with the traceback, which {TRACEBACK}=1 shows"
    say(f"internal error, a flaw of amuros: {visible(repr(error))[:_LONGEST]}; please report it at {ISSUES}, {where}")
    return INTERNAL_ERROR


def say(message: str) -> None:
    """Say something by the descriptor of standard error."""
    os.write(2, f"amuros: {message}\n".encode(errors="backslashreplace"))
