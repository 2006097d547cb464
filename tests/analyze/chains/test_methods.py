"""Chains against three independent tools, published formulas, and schedules that are played through job by job."""

import json
from dataclasses import replace
from functools import cache, partial
from itertools import pairwise
from random import Random

import numpy as np
import pytest
from effort import examples
from hypothesis import assume, given
from hypothesis import strategies as st
from support import SHARED
from unit_player import UnitTask, play

from amalthea_uros.analyze.chains import job_chains
from amalthea_uros.analyze.chains.boundary_times import logical
from amalthea_uros.analyze.chains.bounds import (
    ChainTask,
    becker,
    bi,
    davare,
    duerr,
    duerr_data_age,
    hamann,
    kloda,
    on_grids,
    total,
)
from amalthea_uros.analyze.chains.read_write_times import ReadWriteTimes
from amalthea_uros.analyze.response_times import priority_levels, schedule
from amalthea_uros.analyze.response_times.schedule import PeriodicTask
from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models.models import PeriodicEvents


@cache
def vectors():
    path = SHARED / "vectors" / "chains.json"
    return json.loads(path.read_text())["cases"] if path.exists() else []


def cases(accept=lambda case: True):
    found = [pytest.param(case, id=case["id"]) for case in vectors() if accept(case)]
    return found or [pytest.param(None, marks=pytest.mark.skip("the vectors are not at hand"))]


def tasks_of(case):
    return [
        PeriodicTask(
            name=task["name"],
            period=task["period"],
            offset=task["offset"],
            demand=MultiframeDemand.constant(task["wcet"], task["bcet"]),
            priority=-task["priority"],
        )
        for task in case["tasks"]
    ]


def build_job_chains(tasks, chain):
    """The job chains through a schedule of all best and all worst cases."""
    cycle, start = schedule.hyperperiod(tasks), schedule.steady_state_start(tasks)
    until = start + 2 * cycle
    worst, best = (
        schedule.schedule(tasks, until, MultiframeDemand.worst_of),
        schedule.schedule(tasks, until, MultiframeDemand.best_of),
    )
    index = {task.name: number for number, task in enumerate(tasks)}
    chain_times = []
    for position, name in enumerate(chain):
        task, jobs = tasks[index[name]], worst[index[name]]
        reader = tasks[index[chain[position + 1]]] if position + 1 < len(chain) else None
        chain_times.append(
            ReadWriteTimes(
                releases=jobs.releases,
                reads=best[index[name]].begins,
                writes=jobs.ends,
                cycle=cycle,
                until=until,
                preempts_reader=reader is not None and task.priority > reader.priority,
            )
        )
    return job_chains.build_job_chains(chain_times, start + cycle)


def distribution(latencies):
    return {"count": len(latencies), "min": int(latencies.min()), "max": int(latencies.max()), "sum": int(latencies.sum())}


@pytest.mark.parametrize("case", cases())
def test_job_chains(case):
    found = build_job_chains(tasks_of(case), case["chain"])
    values = {
        "mrt": found.reaction_time,
        "mda": found.data_age,
        "mrda": int(found.last_to_last.max()),
        "mrrt": int(found.first_to_first.max()),
    }
    if case["kind"] == "bcet":
        bounds = {name.removeprefix("guenzel23_"): value for name, value in case["safe_upper_bound"].items()}
        assert {name: values[name] for name in bounds} == bounds
        for achieved in case["achieved"].values():
            assert all(achieved[name] <= values[name] for name in achieved)
    else:
        assert values == case["exact"]
        assert distribution(found.first_to_first) == case["distribution_one_hyperperiod"]["first_to_first"]
        assert distribution(found.last_to_last) == case["distribution_one_hyperperiod"]["last_to_last"]


def chain_tasks_of(case):
    tasks, responses = {}, {}
    for task, response in zip(case["tasks"], case["wcrt"], strict=True):
        tasks[task["name"]], responses[task["name"]] = task, response
    chain = case["chain"]
    return [
        ChainTask(
            period=tasks[name]["period"],
            response=responses[name],
            offset=tasks[name]["offset"],
            preempts_reader=then is not None and tasks[name]["priority"] < tasks[then]["priority"],
        )
        for name, then in zip(chain, [*chain[1:], None], strict=True)
    ]


@pytest.mark.parametrize("case", cases(lambda case: "bounds" in case))
def test_published_bounds(case):
    chain_tasks = chain_tasks_of(case)
    assert {
        "davare07": total(davare(chain_tasks)),
        "duerr19_mrt": total(duerr(chain_tasks)),
        "duerr19_mrda": total(duerr_data_age(chain_tasks)),
        "kloda18_mrt": total(kloda(chain_tasks)),
        "bi22_mrda": total(bi(chain_tasks)),
        "becker17_response_times_mrda": total(becker(chain_tasks)),
        "becker17_no_information_mrda": total(becker([replace(task, response=task.period) for task in chain_tasks])),
        "hamann17_let": total(hamann(chain_tasks)),
    } == case["bounds"]


def logically(periods, offsets=None):
    offsets = offsets or [0] * len(periods)
    chain_times = [
        logical(Periodic(name="t", period=period, offset=offset), unit=1).pessimistic
        for period, offset in zip(periods, offsets, strict=True)
    ]
    return job_chains.build_job_chains(chain_times, max(offsets))


@pytest.mark.parametrize("case", cases())
def test_logical_execution_times(case):
    chain_tasks = chain_tasks_of(case)
    found = logically([task.period for task in chain_tasks], [task.offset for task in chain_tasks])
    assert {"mrt": found.reaction_time, "mda": found.data_age, "mrda": int(found.last_to_last.max())} == case["let"]


class TestTheChallengeOf2017:
    """Three chains of the model, by hand and by the programs of the published solutions; in microseconds."""

    def figures(self):
        path = SHARED / "vectors" / "waters2017.json"
        if not path.exists():
            pytest.skip("the figures of the challenge are not at hand")
        return {chain["name"]: chain for chain in json.loads(path.read_text())["chains"]}

    def test_logical_execution_times(self):
        known = {"EffectChain_1": [10000, 10000], "EffectChain_2": [100000, 10000, 2000]}
        for name, chain in self.figures().items():
            for variant, expected in chain["LET_exact_us"].items():
                _, _, period = variant.partition("=")
                periods = known.get(name) or [int(period), 2000, 50000]
                found = logically(periods)
                assert expected == {
                    "max_reaction": found.reaction_time,
                    "max_reaction_without_sampling": found.first_to_first.max(),
                    "max_data_age_L2L": found.last_to_last.max(),
                    "max_data_age_until_replaced": found.data_age,
                    "min_forward": found.first_to_first.min(),
                }, (name, variant)

    def test_bounds(self):
        path = SHARED / "vectors" / "waters2017.json"
        chains = self.figures()
        tasks = {task["name"]: task for task in json.loads(path.read_text())["tasks"]}
        variant = "unimore_300MHz_nomem"
        for chain in chains.values():
            names = chain["task_sequence_for_analysis"]
            chain_tasks = [
                ChainTask(
                    period=round(tasks[name]["max_interarrival_us"] * 1000),
                    response=round(tasks[name]["wcrt_us"][variant] * 1000),
                    # A task comes before its own next job, and before those of lower priority on its core.
                    preempts_reader=then is not None
                    and tasks[name]["core"] == tasks[then]["core"]
                    and tasks[name]["priority"] >= tasks[then]["priority"],
                )
                for name, then in zip(names, [*names[1:], None], strict=True)
            ]
            expected = chain["implicit_bounds"][variant]
            assert total(davare(chain_tasks)) == pytest.approx(expected["davare2007_us"] * 1000, abs=1)
            assert total(duerr(chain_tasks)) == pytest.approx(expected["duerr2019_max_reaction_us"] * 1000, abs=1)
            assert total(duerr_data_age(chain_tasks)) == pytest.approx(expected["duerr2019_max_data_age_us"] * 1000, abs=1)


# Brute force: jobs with random execution times, played through moment by moment.

ROWS = st.lists(
    st.tuples(st.sampled_from([4, 6, 8, 12]), st.integers(1, 3), st.integers(0, 2), st.integers(0, 7)), min_size=2, max_size=4
)


def drawn(rows):
    tasks = [
        PeriodicTask(
            name=str(index),
            period=period,
            offset=offset,
            demand=MultiframeDemand.constant(wcet, max(1, wcet - less)),
            priority=-index,
        )
        for index, (period, wcet, less, offset) in enumerate(rows)
    ]
    assume(sum(task.demand.mean_worst / task.period for task in tasks) <= 1)
    return tasks


def observe(tasks, chain, until, random):
    """The latencies of a chain in one run: reads and writes of all jobs, then each value followed on its way."""
    rows = [
        UnitTask(task.period, partial(drawn_demand, task.demand, random), task.offset, rank=-task.priority) for task in tasks
    ]
    found = {
        task.name: [(job.start, job.end) for job in jobs if not job.left]
        for task, jobs in zip(tasks, play(rows, until), strict=True)
    }
    chain_times = [found[name] for name in chain]
    return list(forward(chain_times)), list(backward(chain_times))


def drawn_demand(demand, random, _job):
    return random.randint(demand.best, demand.worst)


def forward(chain_times):
    """(read before, read, end) of each job of the first task."""
    first, *others = chain_times
    for (before, _), (read, written) in pairwise(first):
        end = written
        for times in others:
            end = next((write for start, write in times if start >= end), None)
            if end is None:
                break
        if end is not None:
            yield before, read, end


def backward(chain_times):
    """(read, write, next write) of each job of the last task."""
    *others, last = chain_times
    for (read, write), (_, next_write) in pairwise(last):
        start = read
        for times in reversed(others):
            start = next((begin for begin, end in reversed(times) if end <= start), None)
            if start is None:
                break
        if start is not None:
            yield start if others else read, write, next_write


@examples(60)
@given(rows=ROWS, data=st.data())
def test_no_run_is_worse_than_a_bound(rows, data):
    tasks = drawn(rows)
    names = [task.name for task in tasks]
    chain = data.draw(st.permutations(names).map(lambda order: order[: data.draw(st.integers(1, len(names)))]))
    found = build_job_chains(tasks, chain)
    responses = priority_levels.response_times(
        [AnalysedTask(name=t.name, events=PeriodicEvents(t.period), demand=t.demand, priority=t.priority) for t in tasks]
    )
    by_name = {task.name: (task, response.worst) for task, response in zip(tasks, responses, strict=True)}
    chain_tasks = [
        ChainTask(
            period=by_name[name][0].period,
            response=by_name[name][1],
            offset=by_name[name][0].offset,
            preempts_reader=then is not None and by_name[name][0].priority > by_name[then][0].priority,
        )
        for name, then in zip(chain, [*chain[1:], None], strict=True)
    ]
    reactions = [found.reaction_time, total(davare(chain_tasks))]
    ages = [int(found.last_to_last.max())]
    if all(task.response <= task.period for task in chain_tasks):
        reactions += [total(duerr(chain_tasks)), total(kloda(chain_tasks))]
        ages += [total(duerr_data_age(chain_tasks)), total(becker(chain_tasks))]
        if on_grids(chain_tasks):
            ages.append(total(bi(chain_tasks)))
    for seed in range(3):
        reacting, ageing = observe(tasks, chain, 150, Random(seed))
        steady_state_start = max(task.offset + task.period for task in tasks)
        for before, read, end in reacting:
            if before >= steady_state_start:
                assert end - before <= min(reactions)
                assert end - read <= found.first_to_first.max()
        for read, write, next_write in ageing:
            if read >= steady_state_start:
                assert next_write - read <= found.data_age
                assert write - read <= min(ages)


@given(rows=ROWS, data=st.data())
def test_constant_execution_times_are_exact(rows, data):
    tasks = drawn([(period, wcet, 0, offset) for period, wcet, _, offset in rows])
    names = [task.name for task in tasks]
    chain = data.draw(st.permutations(names).map(lambda order: order[: data.draw(st.integers(1, len(names)))]))
    found = build_job_chains(tasks, chain)
    reacting, shown = observe(tasks, chain, 400, Random(0))
    reacting = [(before, read, end) for before, read, end in reacting if before >= 100]
    ageing = [(read, write, next_write) for read, write, next_write in shown if read >= 100]
    assert found.reaction_time == max(end - before for before, _, end in reacting)
    assert found.data_age == max(next_write - read for read, _, next_write in ageing)
    # Reaction time and data age are the same, whatever the schedule (Günzel and others 2023).
    assert found.reaction_time == found.data_age
    assert {*found.first_to_first.tolist()} == {end - read for _, read, end in reacting}
    assert {*found.last_to_last.tolist()} == {write - read for read, write, _ in ageing}
    # Inputs count from the start on.
    outputs = {}
    for read, write, _ in shown:
        outputs.setdefault(read, []).append(write)
    inputs = sorted(outputs)[:-2]
    assert {*found.inputs.last_to_first.tolist()} == {outputs[read][0] - read for read in inputs}
    before = dict(zip(sorted(outputs)[1:], sorted(outputs), strict=False))
    assert {*found.inputs.first_to_last.tolist()} == {outputs[read][-1] - before[read] for read in inputs[1:]}
    # Events that come at any moment alike: between two reads the reaction time falls evenly, so that the middles will do.
    moments = [reacting[0][0] + number + 0.5 for number in range(schedule.hyperperiod(tasks))]
    reactions = [next(end for before, read, end in reacting if before < moment < read) - moment for moment in moments]
    assert found.mean_reaction_time == pytest.approx(np.mean(reactions))
