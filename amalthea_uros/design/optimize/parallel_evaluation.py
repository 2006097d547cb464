"""Designs judged in processes on this computer or on a Dask cluster; the results do not depend on where and by how many."""

from __future__ import annotations

import pickle
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.design.campaign.campaign import execute
from amalthea_uros.design.campaign.executors import Executor, executor_for, serial
from amalthea_uros.design.campaign.run import CampaignRun, RunOutcome, compact_bytes
from amalthea_uros.design.optimize.evaluation import DesignEvaluator
from amalthea_uros.design.optimize.problem import DesignEvaluation, Evaluator, Feasibility
from amalthea_uros.design.optimize.space import Candidate

#: So many designs are judged about as fast as processes start.
ALONE = 32

_EVALUATION = "evaluation"


@dataclass(frozen=True, slots=True)
class EvaluationJob:
    """Judges the design of the changes of a run."""

    evaluator: DesignEvaluator

    def __call__(self, run: CampaignRun) -> Mapping[str, DesignEvaluation]:
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
    """An evaluator that has its designs judged by an executor, which works until the end of the context.

    The evaluations are in the order of the designs, each as soon as those before it are there.
    """
    with executor(EvaluationJob(evaluator)) as workers:

        def judge(candidates: Sequence[Candidate]) -> Iterator[DesignEvaluation]:
            runs = [CampaignRun(number, 0, candidate) for number, candidate in enumerate(candidates)]
            early: dict[int, DesignEvaluation] = {}
            number = 0
            for outcome in execute(workers, runs):
                early[outcome.run.number] = _evaluation(outcome)
                while number in early:
                    yield early.pop(number)
                    number += 1

        yield judge


@contextmanager
def evaluator_on(evaluator: DesignEvaluator, workers: int | None, cluster: str | None) -> Iterator[Evaluator]:
    """An evaluator that judges designs here, in processes, or on a cluster.

    Parameters
    ----------
    workers : designs judged at the same time on this computer; None: one for each core, but the first `ALONE` designs are judged by
        this process, because most searches are over before others have started
    cluster : address of a Dask scheduler, on whose workers designs are judged instead
    """
    executor = executor_for(sys.maxsize, workers, cluster)
    if executor is serial:
        yield evaluator
        return
    alone = ALONE if workers is None and cluster is None else 0
    others: Evaluator | None = None
    with ExitStack() as stack:

        def judge(candidates: Sequence[Candidate]) -> Iterator[DesignEvaluation]:
            nonlocal alone, others
            own, rest = candidates[:alone], candidates[alone:]
            alone -= len(own)
            yield from evaluator(own)
            if rest:
                others = others or stack.enter_context(evaluated_by(evaluator, executor))
                yield from others(rest)

        yield judge


def _evaluation(outcome: RunOutcome) -> DesignEvaluation:
    """The evaluation; of a design of which nobody could finish the analysis, nothing is known."""
    if not outcome.error:
        found: DesignEvaluation = outcome.record[_EVALUATION]
        return found
    return DesignEvaluation(candidate=outcome.run.changes, feasible=Feasibility.UNKNOWN, reason=outcome.error)
