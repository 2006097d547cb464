"""Minima of response times and latencies where releases are known, beside a process that comes at any time.

That process keeps the schedule from being known, so that bounds by releases and response times remain. A player executes such systems
unit of time by unit of time: the most important ready job goes on, and a job reads at its first unit and writes at the end of its last.
"""

from dataclasses import replace
from itertools import pairwise
from random import Random

from effort import examples
from hypothesis import assume, given
from hypothesis import strategies as st
from support import ROOT
from test_chain_systems import END, START, at, evaluate, read, results, system, ticks, write

from amalthea_uros import Settings, analyze_system, describe
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.software import Preemption
from amalthea_uros.perf.stimuli import RelativePeriodic
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import NANOSECOND as NS
from amalthea_uros.units import Duration

#: The minimum time between two activations of the process that comes at any time.
RARELY = 40
#: Best cases are those once every process has come for the first time.
ALL_CAME = 12


def built(tasks, chain):
    """Tasks (name, period, offset, (best, worst)), the most important one first; one without a period comes at any time."""
    reads = {then: f"L{first}" for first, then in pairwise(chain)}
    rows = []
    for name, period, offset, (best, worst) in tasks:
        body = [*([read(reads[name])] if name in reads else []), ticks(worst, best), write(f"L{name}")]
        rows.append((name, period, body, "core", offset))
    events = [at(chain[0], START), *(at(name, END) for name in chain[1:])]
    any_time = [
        RelativePeriodic(name=name, distance=Uniform(lower=RARELY * US, upper=(RARELY + 9) * US))
        for name, period, _, _ in tasks
        if not period
    ]
    return system(rows, events, stimuli=any_time)


def played(tasks, until, random, not_preempted=()):
    """(release, start, end) of each job of each task; what comes at any time does so at random, as do execution times."""
    due = {}
    for name, period, offset, _ in tasks:
        first, distance = (offset, period) if period else (random.randrange(ALL_CAME), RARELY + random.randrange(9))
        due[name] = set(range(first, until, distance))
    found, ready, running = {name: [] for name, *_ in tasks}, [], None
    for now in range(until):
        for rank, (name, _, _, (best, worst)) in enumerate(tasks):
            if now in due[name]:
                ready.append({"key": (rank, now), "name": name, "left": random.choice([best, worst]), "start": None})
        if not ready:
            continue
        if running not in ready or running["name"] not in not_preempted:
            running = min(ready, key=lambda job: job["key"])
        running["start"] = now if running["start"] is None else running["start"]
        running["left"] -= 1
        if not running["left"]:
            ready.remove(running)
            found[running["name"]].append((running["key"][1], running["start"], now + 1))
    return found


def reactions(jobs, chain):
    """(start, end) of each job of the first task and of the first job of the last one that uses its data."""
    first, *others = chain
    for _, start, written in jobs[first]:
        for name in others:
            job = next((job for job in jobs[name] if job[1] >= written), None)
            if job is None:
                return
            written = job[2]
        yield start, written


#: E, C and M are released together, and S comes at any time.
TASKS = [("S", None, 0, (1, 1)), ("E", 10, 0, (2, 5)), ("C", 10, 0, (2, 2)), ("M", 20, 0, (1, 1))]


def test_who_is_released_together_with_more_important_ones_ends_after_them():
    analysis = analyze_system(built(TASKS, ["E", "M", "C"]))
    # E comes first with at least 2; C adds 2, M adds 1. Nothing has to precede E, and S need not come.
    assert [analysis[name].response.best // US for name in "ECM"] == [2, 4, 5]


def test_who_precedes_a_writer_does_not_read_its_output():
    # E starts at 1 at the latest, after S. M writes at 5 at the earliest, and C can start at 6: but if it starts after 5, so does M.
    # The next job of C ends at 14 at the earliest, after E and itself with 2 each.
    _, values, _, _ = evaluate(built(TASKS, ["E", "M", "C"]))
    assert values["min_first_to_first"] == 14 - 1
    observed = [end - start for seed in range(60) for start, end in reactions(played(TASKS, 60, Random(seed)), ["E", "M", "C"])]
    assert min(observed) == 13


def test_a_writer_that_is_not_preempted_can_write_while_the_reader_waits():
    # M starts at 5, C is released at 6 and waits until M has written at 9: no bound may say that C reads only at 16.
    tasks = [("S", None, 0, (1, 1)), ("C", 10, 6, (1, 1)), ("M", 20, 5, (4, 4))]
    made = built(tasks, ["M", "C"])
    software = made.software
    rows = tuple(replace(each, preemption=Preemption.NON_PREEMPTIVE) if each.name == "M" else each for each in software.tasks)
    made = replace(made, software=replace(software, tasks=rows))
    _, values, _, _ = results(analyze_system(made, Settings()), US)
    observed = [end - start for start, end in reactions(played(tasks, 60, Random(1), "M"), ["M", "C"])]
    assert min(observed) == 5
    assert values["min_first_to_first"] <= 5


def test_the_controller_answers_as_late_as_it_can_at_least():
    description = describe(ROOT / "samples" / "bodas-test-hardware.yaml")
    analysis = analyze_system(description.system)
    # The executor starts up to 2 us after its release, for the interrupt. It executes 11 + 1 + 0.5 us without a message, the control
    # function 4 us; the message is written behind both in one millisecond, and read in the next one.
    assert analysis.chains["factor-to-output"].best == 1_014_500 * NS
    assert analysis["Control_Function"].response.best == 16_500 * NS
    for seed in range(12):
        run = simulate_system(description.system, Options(duration=Duration(100_000 * US), seed=seed))
        assert run.chains["factor-to-output"].quantities[ChainQuantity.FIRST_TO_FIRST].min >= 1_014_500 * NS


@st.composite
def task_sets(draw):
    tasks = [("S", None, 0, (1, draw(st.integers(1, 2))))]
    for name in "ABCD"[: draw(st.integers(2, 4))]:
        best = draw(st.integers(1, 2))
        row = (name, draw(st.sampled_from([6, 8, 12])), draw(st.integers(0, 7)), (best, best + draw(st.integers(0, 1))))
        tasks.append(row)
    tasks = draw(st.permutations(tasks))
    assume(sum(worst / (period or RARELY) for _, period, _, (_, worst) in tasks) < 0.9)
    names = draw(st.permutations([name for name, period, *_ in tasks if period]))
    return tasks, names[: draw(st.integers(2, len(names)))]


@examples(40)
@given(task_sets(), st.integers(0, 2**16))
def test_no_run_is_faster_than_the_minimum_or_slower_than_the_maximum(drawn, seed):
    tasks, chain = drawn
    analysis = analyze_system(built(tasks, chain))
    _, values, _, _ = results(analysis, US)
    for number in range(6):
        jobs = played(tasks, 150, Random(seed + number))
        for name, own in jobs.items():
            response = analysis[name].response
            assert all(
                response.best <= (end - release) * US <= response.worst for release, _, end in own if release >= ALL_CAME
            )
        for start, end in reactions(jobs, chain):
            assert start < ALL_CAME or values.get("min_first_to_first", 0) <= end - start
            assert end - start <= values.get("max_reduced_reaction_time", end)
