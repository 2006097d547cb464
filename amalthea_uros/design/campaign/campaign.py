"""The execution of a campaign."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import closing, suppress
from itertools import islice
from sys import intern

from amalthea_uros._internal.limits import CAMPAIGN_VALUES
from amalthea_uros._internal.records import replace
from amalthea_uros.design.campaign.executors import Executor, Workers, serial
from amalthea_uros.design.campaign.run import CampaignRun, Job, RunOutcome
from amalthea_uros.errors import InvalidArgumentError

#: Runs are sent in chunks only if there are more than so many for each worker: an interruption loses the chunks that are not finished.
_SINGLE_RUNS = 256
_LARGEST_CHUNK = 16


def run_campaign(job: Job, runs: Sequence[CampaignRun], executor: Executor = serial) -> Generator[RunOutcome]:
    """Execute the runs; each outcome as soon as it is there, so not in the order of the runs.

    A run that fails has an outcome, too. To stop early, close the iterator: runs that are not finished are given up.
    """
    with executor(job) as workers:
        yield from execute(workers, runs)


def execute(workers: Workers, runs: Sequence[CampaignRun]) -> Generator[RunOutcome]:
    """Have workers execute runs; as `run_campaign`.

    What a worker had to do when it died is executed again, one run after the other, so that nothing else is lost if one of them is the
    cause; a run fails with which a worker dies twice.
    """
    chunks = _chunks(runs, workers.count)
    again: deque[CampaignRun] = deque()
    pending: dict[Future[list[RunOutcome]], Sequence[CampaignRun]] = {}
    while True:
        if not again:
            for chunk in islice(chunks, workers.ahead - len(pending)):
                pending[workers.submit(chunk)] = chunk
        elif not pending:
            yield from _last_try(workers, again.popleft())
            continue
        if not pending:
            return
        for future in wait(pending, return_when=FIRST_COMPLETED).done:
            chunk = pending.pop(future)
            try:
                found = future.result()
            except Exception:
                again.extend(chunk)
            else:
                yield from found


def _last_try(workers: Workers, run: CampaignRun) -> list[RunOutcome]:
    """The outcome of a run, also if a worker dies again."""
    try:
        return workers.submit([run]).result()
    except Exception as error:
        return [RunOutcome(run, {}, f"the worker failed twice: {type(error).__name__}: {error}")]


def finished_runs(
    job: Job, runs: Sequence[CampaignRun], executor: Executor, on_outcome: Callable[[RunOutcome], None] | None = None
) -> tuple[RunOutcome, ...]:
    """Execute the runs; their outcomes in the order of the runs. Ctrl-C ends it early, with the runs that are finished.

    Parameters
    ----------
    on_outcome : called after each run
    """
    outcomes: list[RunOutcome] = []
    with suppress(KeyboardInterrupt), closing(run_campaign(job, runs, executor)) as finished:
        for outcome in finished:
            outcomes.append(_compact(outcome, len(runs)))
            if on_outcome is not None:
                on_outcome(outcome)
    return tuple(sorted(outcomes, key=lambda outcome: outcome.run.number))


def _compact(outcome: RunOutcome, runs: int) -> RunOutcome:
    """An outcome that shares the names of its columns with all others; refuse more outcomes of this size than can be kept."""
    columns = len(outcome.record)
    if columns * runs > CAMPAIGN_VALUES:
        raise InvalidArgumentError(
            f"{runs:,} runs with {columns:,} values each are too many to keep; at most {CAMPAIGN_VALUES:,} values are kept, "
            f"those of {CAMPAIGN_VALUES // columns:,} runs"
        )
    return replace(outcome, record={intern(name): value for name, value in outcome.record.items()})


def _chunks(runs: Sequence[CampaignRun], workers: int) -> Iterator[Sequence[CampaignRun]]:
    size = 1 if workers == 1 else max(1, min(_LARGEST_CHUNK, len(runs) // (workers * _SINGLE_RUNS)))
    return (runs[start : start + size] for start in range(0, len(runs), size))
