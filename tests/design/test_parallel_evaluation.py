"""Designs judged elsewhere are judged as here."""

import json
import pickle
from contextlib import contextmanager
from multiprocessing import active_children

import pytest
from support import ROOT

from amalthea_uros.design.campaign import executors
from amalthea_uros.design.optimize.parallel_evaluation import EvaluationJob, evaluated_by
from amalthea_uros.design.optimize.space import designs_with
from amalthea_uros.report.writers.json import content
from amalthea_uros.services.optimize import optimize, plan_optimization

SMALL = """
amuros: 1
name: small
hardware: single-core
middleware: {executor: {period: 1 ms, execution_time: 10 us}}
tasks:
  - {name: A, period: 1 ms, execution_time: 100 us}
  - {name: B, period: 2 ms, execution_time: 300 us}
"""
SAMPLES = ("bodas-test-advanced.yaml", "bodas-test-advanced.amxmi")
LIMIT = "factor-to-output.max_reduced_reaction_time<=11ms"


@pytest.fixture(scope="module")
def plan():
    return plan_optimization(ROOT / "samples" / "executor.amxmi", goals=["load"])


def test_processes_judge_as_this_one_does(plan):
    designs = list(designs_with(plan.problem.space, 1))[:8]
    with evaluated_by(plan.evaluator, executors.processes(2)) as evaluate:
        assert list(evaluate(designs)) == list(plan.evaluator(designs))
        # Other designs, by the same workers.
        assert list(evaluate(designs[:3])) == list(plan.evaluator(designs[:3]))


def test_what_is_sent_has_no_model_in_it():
    small, model = (plan_optimization(ROOT / "samples" / sample, limits=[LIMIT]).evaluator for sample in SAMPLES)
    assert len(pickle.dumps(EvaluationJob(model))) < 3 * len(pickle.dumps(EvaluationJob(small)))


def test_a_dask_cluster_judges_as_this_process_does(plan):
    distributed = pytest.importorskip("distributed")
    designs = list(designs_with(plan.problem.space, 1))[:4]
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=False, dashboard_address=None) as cluster,
        evaluated_by(plan.evaluator, executors.cluster(cluster.scheduler_address)) as evaluate,
    ):
        assert list(evaluate(designs)) == list(plan.evaluator(designs))


# A whole search


def found_with(**parallel):
    """The JSON of a search at random."""
    result = optimize(SMALL, vary=["priorities", "offsets"], goals=["load", "jitter"], designs=12, seed=7, **parallel)
    return json.dumps(content(result), default=str)


def test_proposals_do_not_depend_on_the_number_of_processes():
    assert found_with(workers=2) == found_with(workers=1)


def test_proposals_of_a_cluster_are_those_of_one_process():
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=False, dashboard_address=None) as cluster:
        assert found_with(cluster=cluster.scheduler_address) == found_with(workers=1)


def test_designs_of_a_killed_process_are_judged_again():
    plan = plan_optimization(SMALL)
    designs = [(), *designs_with(plan.problem.space, 2)][:6]

    @contextmanager
    def fragile(job):
        others = set(active_children())
        with executors.processes(2)(job) as workers:
            killed = []

            def submit(runs):
                future = workers.submit(runs)
                if not killed:
                    killed.extend(set(active_children()) - others)
                    killed[0].kill()
                return future

            yield executors.Workers(workers.count, workers.ahead, submit)

    with evaluated_by(plan.evaluator, fragile) as evaluate:
        assert list(evaluate(designs)) == list(plan.evaluator(designs))


def test_most_searches_need_no_other_process(monkeypatch):
    monkeypatch.setattr(executors, "_Pool", lambda *_: pytest.fail("processes were started"))
    result = optimize(SMALL, vary=["priorities"], workers=None)
    assert result.search.tried
