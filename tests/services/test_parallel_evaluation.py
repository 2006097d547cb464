"""Designs judged elsewhere are judged as here."""

import pickle

import pytest
from support import ROOT

from amalthea_uros.optimize.enumeration import designs_with
from amalthea_uros.services.campaign import executors
from amalthea_uros.services.optimize import plan_optimization
from amalthea_uros.services.parallel_evaluation import EvaluationJob, evaluated_by

SAMPLES = ("bodas-test-advanced.yaml", "bodas-test-advanced.amxmi")
LIMIT = "factor-to-output.max_reduced_reaction_time<=11ms"


@pytest.mark.parametrize("sample", SAMPLES)
def test_processes_judge_as_this_one_does(sample):
    plan = plan_optimization(ROOT / "samples" / sample, limits=[LIMIT])
    designs = list(designs_with(plan.problem.space, 1))[:8]
    with evaluated_by(plan.evaluator, executors.processes(2)) as evaluate:
        assert evaluate(designs) == plan.evaluator(designs)
        # Other designs, by the same workers.
        assert evaluate(designs[:3]) == plan.evaluator(designs[:3])


def test_what_is_sent_has_no_model_in_it():
    small, model = (plan_optimization(ROOT / "samples" / sample, limits=[LIMIT]).evaluator for sample in SAMPLES)
    assert len(pickle.dumps(EvaluationJob(model))) < 3 * len(pickle.dumps(EvaluationJob(small)))


def test_a_dask_cluster_judges_as_this_process_does():
    distributed = pytest.importorskip("distributed")
    plan = plan_optimization(ROOT / "samples" / SAMPLES[0], limits=[LIMIT])
    designs = list(designs_with(plan.problem.space, 1))[:4]
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=False, dashboard_address=None) as cluster,
        evaluated_by(plan.evaluator, executors.cluster(cluster.scheduler_address)) as evaluate,
    ):
        assert evaluate(designs) == plan.evaluator(designs)
