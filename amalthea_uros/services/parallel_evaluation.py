"""Designs judged in processes on this computer or on a Dask cluster; the results do not depend on where and by how many."""

from __future__ import annotations

import pickle
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace

from amalthea_uros.optimize.candidate import Candidate
from amalthea_uros.optimize.evaluation import DesignEvaluator
from amalthea_uros.optimize.problem import Evaluation, Evaluator, Feasibility
from amalthea_uros.services.campaign.campaign import execute
from amalthea_uros.services.campaign.executors import Executor, Workers
from amalthea_uros.services.campaign.run import Outcome, Run
from amalthea_uros.services.campaign.sending import compact_bytes

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


@dataclass(frozen=True, slots=True)
class _Evaluator:
    """Judges designs in parallel, and puts the evaluations into their order."""

    workers: Workers

    def __call__(self, candidates: Sequence[Candidate]) -> list[Evaluation]:
        runs = [Run(number, 0, candidate) for number, candidate in enumerate(candidates)]
        outcomes = sorted(execute(self.workers, runs), key=lambda outcome: outcome.run.number)
        return [_evaluation(outcome) for outcome in outcomes]


def _evaluation(outcome: Outcome) -> Evaluation:
    """The evaluation; of a design of which nobody could finish the analysis, nothing is known."""
    if not outcome.error:
        found: Evaluation = outcome.record[_EVALUATION]
        return found
    return Evaluation(candidate=outcome.run.changes, feasible=Feasibility.UNKNOWN, reason=outcome.error)
