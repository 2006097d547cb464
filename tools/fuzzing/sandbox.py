"""A case in a process of its own, with limits of time and memory."""

from __future__ import annotations

import resource
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from multiprocessing.context import ForkProcess
from pathlib import Path
from tempfile import TemporaryDirectory
from traceback import extract_tb

from fuzzing.cases import Case
from fuzzing.invariants import Invariant, invariants_of

SECONDS_PER_INVARIANT = 20
_MEMORY = 3 * 2**30
_FORK = get_context("fork")


@dataclass(frozen=True, slots=True)
class Failure:
    """An invariant that does not hold.

    Attributes
    ----------
    reason : the kind of failure and its place in the code; equal for cases with the same cause
    """

    invariant: str
    reason: str
    message: str


def prepare(cases: Iterable[Case]) -> None:
    """Import what cases need and fill the caches, so that the processes, which are copies of this one, need not."""
    for case in cases:
        with TemporaryDirectory(prefix="amuros-fuzz-") as folder:
            for _ in _examined(case, Path(folder)):
                pass


def failures(cases: Iterable[Case], jobs: int) -> Iterator[tuple[Case, list[Failure]]]:
    """The failures of each case, as soon as they are known."""
    running: list[_Run] = []
    source = iter(cases)
    exhausted = False
    while running or not exhausted:
        while len(running) < jobs and not exhausted:
            case = next(source, None)
            if case is None:
                exhausted = True
            else:
                running.append(_Run(case))
        wait([run.connection for run in running], timeout=0.2)
        for run in [run for run in running if run.is_finished()]:
            running.remove(run)
            yield run.case, run.failures


class _Run:
    """A process that examines a case."""

    def __init__(self, case: Case) -> None:
        self.case = case
        self.failures: list[Failure] = []
        self.connection, theirs = _FORK.Pipe(duplex=False)
        self.current = ""
        self.started = time.monotonic()
        self.process: ForkProcess = _FORK.Process(target=_examine, args=(case, theirs))
        self.process.start()
        theirs.close()

    def is_finished(self) -> bool:
        """Take what the process reports; end it if it takes too long."""
        try:
            while self.connection.poll():
                self._take(self.connection.recv())
        except EOFError:
            self.process.join()
            if self.process.exitcode:
                self._fail(f"ended by signal or code {self.process.exitcode}")
            self.connection.close()
            return True
        if time.monotonic() - self.started > 5 * SECONDS_PER_INVARIANT:  # which counts when others use the machine, too
            self.process.kill()
            self._fail("no end")
            self.process.join()
            self.connection.close()
            return True
        return False

    def _take(self, reported: str | Failure) -> None:
        if isinstance(reported, Failure):
            self.failures.append(reported)
        else:
            self.current, self.started = reported, time.monotonic()

    def _fail(self, reason: str) -> None:
        self.failures.append(Failure(self.current, reason, reason))


def _examine(case: Case, connection: Connection) -> None:
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with TemporaryDirectory(prefix="amuros-fuzz-") as folder:
        for reported in _examined(case, Path(folder)):
            connection.send(reported)
    connection.close()


def _examined(case: Case, folder: Path) -> Iterator[str | Failure]:
    """The name of each invariant before it is examined, and its failure after it."""
    path = folder / case.name
    path.write_bytes(case.content)
    for invariant in invariants_of(path):
        yield invariant.__name__
        own = folder / invariant.__name__
        own.mkdir()
        failure = _failure(invariant, path, own)
        if failure is not None:
            yield failure


def _failure(invariant: Invariant, path: Path, folder: Path) -> Failure | None:
    started = time.process_time()
    try:
        invariant(path, folder)
    except Exception as error:
        # The last frame of the package is nearer to the cause than one of a library.
        frames = extract_tb(error.__traceback__)
        own = [frame for frame in frames if "amalthea_uros" in frame.filename or "fuzzing" in frame.filename]
        place = f"{Path(own[-1].filename).name}:{own[-1].lineno}" if own else ""
        return Failure(invariant.__name__, f"{type(error).__name__} {place}", f"{error}"[:500])
    seconds = time.process_time() - started
    if seconds > SECONDS_PER_INVARIANT:
        return Failure(invariant.__name__, "slow", f"{seconds:.0f} s")
    return None
