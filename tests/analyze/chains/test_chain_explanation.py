"""The hops of explained chains, against runs that are played through unit of time by unit of time, and the terms of bounds."""

from dataclasses import replace
from itertools import pairwise
from random import Random

import pytest
from effort import examples
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT, analysis_of
from test_brute_force import ALWAYS, ANY, built, run, systems
from test_chain_systems import END, START, at, read, system, ticks, write
from unit_player import UnitTask, play

from amalthea_uros.analyze.chains import bounds
from amalthea_uros.analyze.chains.bounds import ChainTask, total
from amalthea_uros.analyze.explanations.chains import explain_chain
from amalthea_uros.analyze.results.chains import EXPLAINED, LatencyQuantity
from amalthea_uros.analyze.results.explanations import CauseKind
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Communication
from amalthea_uros.perf.hardware import StructureKind
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import MICROSECOND as US


def check_sums(explanation):
    """Waits, runs and the time until the output is overwritten add up to the value, and times fit waits and runs."""
    hops = explanation.hops
    total = sum(hop.wait + hop.run for hop in hops) + explanation.overwritten
    assert total == explanation.value.value
    assert hops[0].read == 0
    now = -hops[0].wait
    for hop in hops:
        assert (hop.read, hop.write) == (now + hop.wait, now + hop.wait + hop.run)
        assert sum(cause.time for cause in hop.wait_causes) == hop.wait
        assert sum(cause.time for cause in hop.run_causes) == hop.run
        now = hop.write
    return hops


@pytest.mark.parametrize("communication", [Communication.IMPLICIT, Communication.EXPLICIT])
@examples(12)
@given(systems(["one", "two"], ALWAYS, varying=False, triggered=False))
def test_the_jobs_of_exact_values_are_those_of_a_run(communication, drawn):
    tasks, chain = drawn
    analysis = analyze_system(built(tasks, chain), Settings(communication=communication))
    jobs = run(tasks, 600, Random(0), communication)
    for quantity in EXPLAINED:
        explanation = explain_chain(analysis, "chain", quantity)
        hops = check_sums(explanation)
        assert [hop.process for hop in hops] == chain
        if explanation.value.claim is not Claim.EXACT:
            continue
        played = [jobs[hop.process][hop.job - 1] for hop in hops]
        # The chain leads from the start of the first job to the end of the last one.
        starts, reads, writes, ends = (list(column) for column in zip(*played, strict=True))
        origin, reads, writes = starts[0], [starts[0], *reads[1:]], [*writes[:-1], ends[-1]]
        assert [hop.start // US for hop in hops] == [start - origin for start in starts]
        if communication is Communication.EXPLICIT:
            # At a preemption it is open on which side of it an access takes place; only both ends are certain.
            assert (hops[0].read, hops[-1].write // US) == (0, writes[-1] - origin)
        else:
            assert [hop.read // US for hop in hops] == [moment - origin for moment in reads]
            assert [hop.write // US for hop in hops] == [moment - origin for moment in writes]
        periods = {task.name: (task.offset, task.period) for task in tasks}
        releases = [periods[hop.process][0] + (hop.job - 1) * periods[hop.process][1] for hop in hops]
        assert [hop.release // US for hop in hops] == [release - origin for release in releases]


@pytest.mark.parametrize("communication", [Communication.IMPLICIT, Communication.EXPLICIT])
@examples(12)
@given(systems(["one", "two"], ANY, varying=True, triggered=True), st.booleans())
def test_the_hops_of_bounds_add_up(communication, drawn, controllers):
    check_all_hops(communication, drawn, controllers)


@examples(12)
@given(systems(["one", "two"], ANY, varying=True, triggered=False), st.booleans())
def test_the_hops_of_logical_times_add_up(drawn, controllers):
    check_all_hops(Communication.LET, drawn, controllers)


def check_all_hops(communication, drawn, controllers):
    tasks, chain = drawn
    model = built(tasks, chain)
    if controllers:
        structures = tuple(replace(each, kind=StructureKind.ECU) for each in model.hardware.structures)
        model = replace(model, hardware=replace(model.hardware, structures=structures))
    analysis = analyze_system(model, Settings(communication=communication))
    for quantity in EXPLAINED:
        explanation = explain_chain(analysis, "chain", quantity)
        if explanation.value is not None:
            assert [hop.process for hop in check_sums(explanation)] == chain


def test_the_worst_message_of_the_thesis():
    """Taken one tick after the callback ran, 19 ticks before it runs again; the next control function also waits for a message."""
    explanation = explain_chain(analysis_of(ROOT / "samples" / "bodas-test-advanced.yaml"), "factor-to-output")
    executor, callback, control = check_sums(explanation)
    assert (executor.process, executor.release, executor.start, executor.write) == ("Executor_Task", 0, 0, 25 * US)
    assert (callback.process, callback.release, callback.start) == ("Message_Factor", 19_000 * US, 19_016 * US)
    # 12 and 13 for the executor with a message, and 4 of its own.
    assert (control.process, control.release, control.start) == ("Control_Function", 20_000 * US, 20_025 * US)
    assert (control.write, control.wait, control.run) == (20_029 * US, 20_025 * US - 19_018 * US, 4 * US)
    # The callback runs every 20 ms; the executor, 12 us without a message, and the control function, 4 us, run before it.
    assert [(cause.kind, cause.process, cause.time // US) for cause in callback.wait_causes] == [
        (CauseKind.NEXT_JOB, "", 19_000 - 25),
        (CauseKind.INTERFERENCE, "Executor_Task", 12),
        (CauseKind.INTERFERENCE, "Control_Function", 4),
    ]
    assert (callback.period, callback.one_in, control.period) == (20_000 * US, 1, 1_000 * US)
    assert [(limit.limit, limit.margin) for limit in explanation.requirements] == [(25_000 * US, 4_971 * US)]
    assert sum(explanation.share(hop.wait + hop.run) for hop in explanation.hops) == 1


def played(tasks, until):
    """For each core the process and job that it executes in each unit of time, played through."""
    rows = [UnitTask(task.period, task.worst, task.offset, rank, task.core) for rank, task in enumerate(tasks)]
    return {
        (task.core, moment - 1): (task.name, job.number)
        for task, jobs in zip(tasks, play(rows, until), strict=True)
        for job in jobs
        for moment in job.reached
    }


@examples(18)
@given(systems(["one", "two"], ALWAYS, varying=False, triggered=False))
def test_the_causes_are_what_the_core_executes(drawn):
    """Between release and read others execute first; between read and output the job itself and those that preempt it."""
    tasks, chain = drawn
    analysis = analyze_system(built(tasks, chain), Settings(communication=Communication.IMPLICIT))
    explanation = explain_chain(analysis, "chain")
    if explanation.value.claim is not Claim.EXACT:
        return
    executed = played(tasks, 600)
    first = explanation.hops[0]
    origin = min(now for (_, now), job in executed.items() if job == (first.process, first.job))
    previous = first.read
    for hop in explanation.hops:
        for causes, begin, end in (
            (hop.wait_causes, min(max(previous, hop.release), hop.read), hop.read),
            (hop.run_causes, hop.read, hop.write),
        ):
            units = [executed[hop.core, now + origin] for now in range(begin // US, end // US)]
            others = [unit for unit in units if unit[0] != hop.process]
            kinds = (CauseKind.INTERFERENCE, CauseKind.PREEMPTION)
            found = {cause.process: (cause.jobs, cause.time // US) for cause in causes if cause.kind in kinds}
            assert found == {
                name: (len({job for job in others if job[0] == name}), sum(job[0] == name for job in others))
                for name in {job[0] for job in others}
            }
            own = sum(cause.time // US for cause in causes if cause.kind is CauseKind.EXECUTION)
            assert own == len(units) - len(others)
        for each in hop.executions:
            for now in range(each.begin // US, each.end // US):
                assert executed[each.core, now + origin] == (each.process, each.job)
        previous = hop.write


def test_logical_execution_time_is_waiting():
    tasks = [("A", 10, [ticks(1), write("x")]), ("B", 10, [read("x"), ticks(1)])]
    settings = Settings(communication=Communication.LET)
    explanation = explain_chain(analyze_system(system(tasks, (at("A", START), at("B", END))), settings), "chain")
    # Each publishes at the end of its period, when the next one begins.
    assert [[(cause.kind, cause.time // US) for cause in hop.run_causes] for hop in explanation.hops] == [
        [(CauseKind.LOGICAL, 10)],
        [(CauseKind.LOGICAL, 10)],
    ]
    assert [hop.wait_causes for hop in explanation.hops] == [(), ()]


def test_data_that_wait_for_another_controller():
    tasks = [("A", 10, [ticks(4), write("x")], "one"), ("B", 10, [read("x"), ticks(1)], "two")]
    events = (at("A", START), at("B", END))
    analysis = analyze_system(system(tasks, events, cores=("one", "two"), controllers=True))
    a, b = check_sums(explain_chain(analysis, "chain", LatencyQuantity.MAX_REACTION_TIME))
    # The message arrives just after A has started, and its output just after B has: a period and an execution time each.
    assert [(hop.wait // US, hop.run // US) for hop in (a, b)] == [(10, 4), (10, 1)]


def test_a_chain_without_a_value():
    tasks = [("A", 10, [ticks(11), write("x")]), ("B", 10, [read("x"), ticks(1)])]
    explanation = explain_chain(analyze_system(system(tasks, (at("A", START), at("B", END)))), "chain")
    assert (explanation.value, explanation.hops) == (None, ())
    assert "'A' is unbounded" in explanation.reason


@st.composite
def chains(draw):
    tasks = []
    for _ in range(draw(st.integers(1, 4))):
        period = draw(st.sampled_from([2, 3, 4, 5, 6, 10]))
        response = draw(st.integers(1, period))
        tasks.append(
            ChainTask(period=period, response=response, offset=draw(st.integers(0, 9)), preempts_reader=draw(st.booleans()))
        )
    tasks[-1] = replace(tasks[-1], preempts_reader=False)
    return tasks


def between(task, reader):
    """The response time of a writer that does not preempt its reader, or what both do in parallel."""
    return max(task.response, reader.period + (0 if task.preempts_reader else task.response))


@given(chains())
def test_the_terms_of_a_bound_add_up_to_the_formula_of_the_paper(tasks):
    last = tasks[-1]
    unhidden = [0 if task.preempts_reader else task.response for task in tasks[:-1]]
    formulas = {
        bounds.davare: sum(task.period + task.response for task in tasks),
        bounds.hamann: sum(2 * task.period for task in tasks),
        bounds.duerr: tasks[0].period + sum(between(*pair) for pair in pairwise(tasks)) + last.response,
        bounds.duerr_data_age: sum(task.period for task in tasks[:-1]) + sum(unhidden) + last.response,
    }
    for terms_of, bound in formulas.items():
        assert total(terms_of(tasks)) == bound
    for method in (*bounds.REACTION_TIME.values(), *bounds.REDUCED_DATA_AGE.values()):
        assert len(method(tasks)) == len(tasks)
    assert total(bounds.kloda(tasks)) <= total(bounds.davare(tasks)) + sum(task.offset for task in tasks)
    assert all(wait == task.period for (wait, _), task in zip(bounds.davare(tasks), tasks, strict=True))
