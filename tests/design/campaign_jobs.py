"""Jobs for tests of campaigns, in a module that other processes can import."""

import os
import signal
import time

from amalthea_uros.errors import InvalidArgumentError


def square(run):
    return {"square": run.seed**2, "process": os.getpid()}


def slow_first(run, folder):
    """The first run takes until the outcome of another one is in the folder, however long the other process takes to start."""
    deadline = time.monotonic() + 60
    while run.number == 1 and not any(folder.iterdir()) and time.monotonic() < deadline:
        time.sleep(0.01)
    return {"number": run.number}


def failing(run):
    if run.seed % 3 == 0:
        raise InvalidArgumentError("a multiple of three")
    if run.seed % 3 == 1:
        raise KeyError("unexpected")
    return {"seed was": run.seed}


def dying(run, folder):
    """One run kills its worker whenever it is tried; others do so once, as if somebody killed it from outside."""
    if run.number == 1 or (run.number % 20 == 7 and not (folder / str(run.number)).exists()):
        (folder / str(run.number)).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return {"number": run.number}


def endless(run):
    if run.number > 2:
        time.sleep(600)
    return {"number": run.number}
