"""Where runs are executed: here, in processes on this computer, or on a Dask cluster."""

from __future__ import annotations

import gc
import logging
import os
import pickle
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import AbstractContextManager, contextmanager
from functools import lru_cache
from importlib import import_module
from multiprocessing import active_children, get_context, parent_process
from threading import Thread
from typing import Any, TypeAlias

from amalthea_uros._internal.failures import failure
from amalthea_uros._internal.own_processes import can_start_safely, safe_start
from amalthea_uros._internal.records import dataclass
from amalthea_uros._version import __version__
from amalthea_uros.design.campaign.run import CampaignRun, Job, RunOutcome
from amalthea_uros.errors import AmurosError, InvalidArgumentError


@dataclass(frozen=True, slots=True)
class Workers:
    """What executes runs.

    Attributes
    ----------
    count : of the runs that are executed at the same time
    ahead : how many calls of `submit` may be open, so that nobody waits for work
    """

    count: int
    ahead: int
    submit: Callable[[Sequence[CampaignRun]], Future[list[RunOutcome]]]


#: Provides workers for a job, and releases them in the end, also when somebody interrupts.
Executor: TypeAlias = Callable[[Job], AbstractContextManager[Workers]]


def executor_for(runs: int, workers: int | None, cluster_address: str | None) -> Executor:
    """What executes so many runs.

    Parameters
    ----------
    workers : runs at the same time on this computer; None: as many as there are cores
    cluster_address : of the scheduler of a Dask cluster, on whose workers the runs are executed instead
    """
    if cluster_address is not None:
        return cluster(cluster_address)
    count = min(runs, _available_cores() if workers is None else workers)
    return processes(count) if count > 1 and can_start_safely() and _has_semaphores() else serial


def _available_cores() -> int:
    """The cores that this process may use; containers often have fewer than the computer."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _has_semaphores() -> bool:
    """Whether processes can talk to each other: in some containers, `/dev/shm` is missing or read-only."""
    try:
        # The first semaphore starts a process that keeps account of them.
        with _blocked_interrupts(), safe_start():
            get_context("spawn").Lock()
    except (OSError, ImportError):
        return False
    return True


@contextmanager
def serial(job: Job) -> Iterator[Workers]:
    """Run everything in this process, one run after the other."""

    def submit(runs: Sequence[CampaignRun]) -> Future[list[RunOutcome]]:
        future: Future[list[RunOutcome]] = Future()
        future.set_result(_execute(job, runs))
        return future

    yield Workers(1, 1, submit)


def processes(count: int) -> Executor:
    """Run in processes on this computer.

    The processes are spawned rather than forked: a fork copies locks that threads of numpy or of the caller hold at that moment, and
    could wait for them for ever. A script that uses this needs the usual `if __name__ == "__main__":`.
    """

    @contextmanager
    def provide(job: Job) -> Iterator[Workers]:
        pool = _Pool(count, pickle.dumps(job))
        try:
            yield Workers(count, 2 * count, pool.submit)
        finally:
            pool.close()

    return provide


#: What a pool raises at more work when a process was killed. If it knows: `RuntimeError`, of which `BrokenProcessPool` is a kind.
#: `OSError` if it closes its queues while it starts another process, or if the one that it starts was killed; `ValueError` if that
#: process was to be given what is closed then (multiprocessing `spawnv_passfds`).
_BREAKING = (RuntimeError, OSError, ValueError)


class _Pool:
    """Processes that are replaced if one of them dies, for example for lack of memory."""

    def __init__(self, count: int, job: bytes) -> None:
        self._count, self._job = count, job
        self._others = set(active_children())
        self._pool = self._start()

    def _start(self) -> ProcessPoolExecutor:
        with safe_start():
            return ProcessPoolExecutor(
                self._count,
                get_context("spawn"),
                initializer=_install,
                initargs=(self._job, _LOGGER.isEnabledFor(logging.INFO)),
            )

    def submit(self, runs: Sequence[CampaignRun]) -> Future[list[RunOutcome]]:
        """Have some runs executed."""
        with _blocked_interrupts(), safe_start():
            try:
                return self._pool.submit(_execute_installed, runs)
            except _BREAKING:
                # The former pool is let go, and ends by itself; what it has not done comes back from its futures.
                self._pool = self._start()
                return self._pool.submit(_execute_installed, runs)

    def close(self) -> None:
        """End the processes, also those that still work."""
        self._pool.shutdown(wait=False, cancel_futures=True)
        for process in set(active_children()) - self._others:
            process.terminate()
        self._pool.shutdown()
        # Its semaphores belong to cycles of objects. The command line ends without collecting them, and Python would complain of leaks.
        del self._pool
        gc.collect()


@contextmanager
def _blocked_interrupts() -> Iterator[None]:
    """A process that is started meanwhile inherits that Ctrl-C is blocked: it would report the interrupt while it imports."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    former = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, former)


_LOGGER = logging.getLogger("amalthea_uros")

#: The job of a worker process: it is sent once, not with each run.
_installed: list[Job] = []


def _install(job: bytes, is_verbose: bool) -> None:
    """Prepare a worker process. Ctrl-C reaches it, too: it is up to the process that started it what to do.

    Parameters
    ----------
    is_verbose : whether to show on standard error what is logged, as the process that started it does
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=_end_with_parent, daemon=True).start()
    if is_verbose:
        logging.basicConfig(format="%(message)s", level=logging.INFO)
    _installed.append(pickle.loads(job))


def _end_with_parent() -> None:
    """End this process once the one that started it is killed; the queue of work that it waits for stays open in the others."""
    parent = parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _execute_installed(runs: Sequence[CampaignRun]) -> list[RunOutcome]:
    return _execute(_installed[0], runs)


def cluster(address: str) -> Executor:
    """Run on a Dask cluster, on whose workers the same version of this package is installed.

    Parameters
    ----------
    address : of the scheduler, such as "tcp://10.0.0.1:8786"
    """

    @contextmanager
    def provide(job: Job) -> Iterator[Workers]:
        with _connected(address) as client:
            threads = sum(client.nthreads().values())
            if not threads:
                raise InvalidArgumentError(
                    f"the cluster at {address!r} has no workers; start some with 'dask worker {address}'"
                )
            _check_versions(client)
            shared = client.scatter(pickle.dumps(job), broadcast=True, hash=False)
            executor = client.get_executor(pure=False)
            try:
                # The way to a cluster is longer than to a process, so more work is kept there.
                yield Workers(threads, 4 * threads, lambda runs: executor.submit(_execute_shared, shared, runs))
            finally:
                executor.shutdown(wait=False)

    return provide


def _connected(address: str) -> Any:
    """A client of the cluster."""
    try:
        client: Any = import_module("distributed").Client
    except ImportError:
        raise InvalidArgumentError(
            "a cluster needs the package 'distributed'; install it with: pip install amuros[cluster]"
        ) from None
    try:
        return client(address, timeout=10)
    except (OSError, ValueError) as error:
        raise InvalidArgumentError(
            f"no Dask scheduler answers at {address!r}: {error}; start one with 'dask scheduler'"
        ) from None


def _check_versions(client: Any) -> None:
    """Refuse workers with another version, whose results might differ."""
    try:
        versions = client.run(_version)
    except ImportError:
        raise InvalidArgumentError("amuros is not installed on the workers of the cluster; install it there, too") from None
    for worker, version in versions.items():
        if version != __version__:
            raise InvalidArgumentError(
                f"the worker {worker} has amuros {version}, not {__version__}; install the same version there"
            )


def _version() -> str:
    return __version__


@lru_cache(maxsize=1)
def _received(job: bytes) -> Job:
    found: Job = pickle.loads(job)
    return found


def _execute_shared(job: bytes, runs: Sequence[CampaignRun]) -> list[RunOutcome]:
    return _execute(_received(job), runs)


def _execute(job: Job, runs: Sequence[CampaignRun]) -> list[RunOutcome]:
    return [_outcome(job, run) for run in runs]


def _outcome(job: Job, run: CampaignRun) -> RunOutcome:
    """What comes out of a run; that one fails does not concern the others."""
    try:
        return RunOutcome(run, dict(job(run)))
    except (AmurosError, ValueError) as error:
        return RunOutcome(run, {}, str(error))
    except Exception as error:
        return RunOutcome(run, {}, failure(error))
