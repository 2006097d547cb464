"""Designs judged in processes on this computer or on a Dask cluster; the results do not depend on where and by how many."""

from __future__ import annotations

import pickle
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace

from amalthea_uros.design.campaign.campaign import execute
from amalthea_uros.design.campaign.executors import Executor, Workers, executor_for, serial
from amalthea_uros.design.campaign.run import Outcome, Run
from amalthea_uros.design.campaign.sending import compact_bytes
from amalthea_uros.design.optimize.candidate import Candidate
from amalthea_uros.design.optimize.evaluation import DesignEvaluator
from amalthea_uros.design.optimize.problem import Evaluation, Evaluator, Feasibility

#: So many designs are judged about as fast as processes start.
ALONE = 32

_EVALUATION = "evaluation"


@dataclass(frozen=True, slots=True)
class EvaluationJob:
    """Judges the design of the changes of a run."""

    evaluator: DesignEvaluator

    def __call__(self, run: Run) -> Mapping[str, Evaluation]:
        """The evaluation."""
        return {_EVALUATION: self.evaluator.evaluate(run.changes)}

    def __reduce__(self) -> tuple[object, ...]:
        designs = self.evaluator.designs
        present = designs.present._replace(system=replace(designs.present.system))  # without tables of names
        return _received_job, (compact_bytes(replace(self.evaluator, designs=replace(designs, present=present))),)


def _received_job(evaluator: bytes) -> EvaluationJob:
    return EvaluationJob(pickle.loads(evaluator))


@contextmanager
def evaluated_by(evaluator: DesignEvaluator, executor: Executor) -> Iterator[Evaluator]:
    """An evaluator that has its designs judged by an executor, which works until the end of the context."""
    with executor(EvaluationJob(evaluator)) as workers:
        yield _Evaluator(workers)


@contextmanager
def evaluator_on(evaluator: DesignEvaluator, workers: int | None, cluster: str | None) -> Iterator[Evaluator]:
    """An evaluator that judges designs here, in processes, or on a cluster.

    Parameters
    ----------
    workers : designs judged at the same time on this computer; None: one for each core, but the first `ALONE` designs are judged by
        this process, because most searches are over before others have started
    cluster : address of a Dask scheduler, on whose workers designs are judged instead
    """
    with ExitStack() as stack:
        yield _LateStart(
            evaluator, stack, executor_for(sys.maxsize, workers, cluster), ALONE if workers is None and cluster is None else 0
        ).judge


@dataclass(slots=True)
class _LateStart:
    """Judges the first designs itself, and has the others judged by an executor, which is started when it is needed.

    Attributes
    ----------
    alone : how many designs it judges itself
    """

    evaluator: DesignEvaluator
    stack: ExitStack
    executor: Executor
    alone: int
    others: Evaluator | None = None

    def judge(self, candidates: Sequence[Candidate]) -> Iterator[Evaluation]:
        """Judge designs."""
        if self.executor is serial:
            yield from self.evaluator.each(candidates)
            return
        own, rest = candidates[: self.alone], candidates[self.alone :]
        self.alone -= len(own)
        yield from self.evaluator.each(own)
        if rest:
            if self.others is None:
                self.others = self.stack.enter_context(evaluated_by(self.evaluator, self.executor))
            yield from self.others(rest)


@dataclass(frozen=True, slots=True)
class _Evaluator:
    """Judges designs in parallel, and puts the evaluations into their order, each as soon as those before it are there."""

    workers: Workers

    def __call__(self, candidates: Sequence[Candidate]) -> Iterator[Evaluation]:
        runs = [Run(number, 0, candidate) for number, candidate in enumerate(candidates)]
        early: dict[int, Evaluation] = {}
        number = 0
        for outcome in execute(self.workers, runs):
            early[outcome.run.number] = _evaluation(outcome)
            while number in early:
                yield early.pop(number)
                number += 1


def _evaluation(outcome: Outcome) -> Evaluation:
    """The evaluation; of a design of which nobody could finish the analysis, nothing is known."""
    if not outcome.error:
        found: Evaluation = outcome.record[_EVALUATION]
        return found
    return Evaluation(candidate=outcome.run.changes, feasible=Feasibility.UNKNOWN, reason=outcome.error)
