"""The simulation plays as the player does, which shares no code with it, and shows nothing beyond what the analysis claims.

Where it is open how a system is to be read, the simulation has the readings of `SIMULATION`: what follows an execution is done before
somebody arrives at that instant, and a job with nothing left to do ends at once; equals go in the order of the model; cooperative
tasks let others go first after all calls, and others interrupt them anywhere; the most urgent one of those that wait gets a semaphore;
under earliest deadline first, the deadline of the holder is shortened; non-interruptible groups keep interrupts off; a time slice goes
on after a preemption.
"""

from importlib.util import find_spec
from random import Random

import numpy as np
import pytest
from effort import every
from opponent.generator import random_system
from opponent.invariants import disobeyed_priorities, violations
from opponent.observation import Horizon
from opponent.player import play
from opponent.readings import Ceilings, Handover, Instant, Intruders, Points, Readings
from opponent.simulation import beyond, contradictions, latencies, record
from opponent.systems import constructs_of, described, has_open_choices
from opponent.to_perf import MICROSECOND, to_perf
from opponent.vectors import facts, needs_vectors, plain_systems

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.simulate.options import Mode, Options

SIMULATION = Readings(
    instant=Instant.BEFORE_WITH_ACCESSES,
    points=Points.CALLS,
    intruders=Intruders.PREEMPTIVE,
    handover=Handover.URGENT,
    ceilings=Ceilings.DEADLINE,
)
#: The simulation takes a counter for something left to do, also where the counter then skips the rest of the job; the player does not.
SKIPPED_ENDS = {"counter of a trigger", "counter of a call"}


def has_same_jobs(plain):
    """Whether the jobs of a system without open choices are those of the player."""
    until = Horizon.of(plain).end
    found = record(to_perf(plain), Options(duration=until * MICROSECOND))
    played = play(plain, SIMULATION, Random(1), until)
    return all(
        _in_microseconds(found.jobs_of(process["name"])) == [(j.release.time, j.start, j.end) for j in jobs if j.end < until]
        for process, jobs in zip(plain["processes"], played, strict=True)
    )


def _in_microseconds(jobs):
    return [tuple(time // MICROSECOND for time in job) for job in jobs]


def is_comparable(plain):
    constructs = constructs_of(plain)
    return not has_open_choices(plain) and not ("trigger" in constructs and constructs & SKIPPED_ENDS)


@pytest.mark.parametrize("first", range(0, 2000, 200))
def test_jobs_of_determined_systems_are_those_of_the_player(first):
    systems = {seed: random_system(seed) for seed in every(5, range(first, first + 200))}
    different = [seed for seed, plain in systems.items() if is_comparable(plain) and not has_same_jobs(plain)]
    assert different == [], "\n".join(described(systems[seed]) for seed in different)


@pytest.mark.parametrize("first", range(0, 300, 50))
def test_nothing_is_beyond_a_claim(first):
    found = {seed: texts for seed in every(7, range(first, first + 50)) if (texts := contradictions(random_system(seed)))}
    assert found == {}, [constructs_of(random_system(seed)) for seed in found]


@pytest.mark.parametrize("first", range(0, 400, 100))
def test_schedules_keep_to_the_rules(first):
    found = {seed: texts for seed in every(5, range(first, first + 100)) if (texts := violations(random_system(seed)))}
    assert found == {}


def test_broken_rules_are_found():
    def task(name, priority):
        process = {"name": name, "kind": "task", "core": "core0", "priority": priority, "preemption": "preemptive"}
        return {**process, "arrival": {"periodic": {"period": 10}}, "body": [{"execute": [2, 2]}]}

    plain = {"cores": {"core0": "FPP"}, "semaphores": {}, "runnables": {}, "processes": [task("low", 1), task("high", 2)]}
    reversed_priorities = [p | {"priority": -p["priority"]} for p in plain["processes"]]
    run = record(to_perf(plain), Options(duration=Horizon.of(plain).end * MICROSECOND, traced=(0, 10**9)))
    assert list(disobeyed_priorities(plain, run)) == []
    assert list(disobeyed_priorities(plain | {"processes": reversed_priorities}, run))


# Models with every construct of the language are simulated, and nothing occurs that is known not to occur.


FACTS = facts() if not needs_vectors.args[0] else {}
SYSTEMS = plain_systems() if FACTS else {}
RUNS = ((Mode.SAMPLED, 1), (Mode.SAMPLED, 2), (Mode.WORST, 1), (Mode.BEST, 1), (Mode.AVERAGE, 1))


def runs_of(name):
    system, duration = to_perf(SYSTEMS[name]), Horizon.of(SYSTEMS[name]).end * MICROSECOND
    return [record(system, Options(duration=duration, mode=mode, seed=seed)) for mode, seed in RUNS]


@needs_vectors
@pytest.mark.parametrize("block", range(8))
def test_nothing_occurs_beyond_what_is_known_or_claimed(block):
    wrong = []
    for name in every(4, sorted(FACTS)[block::8]):
        runs, steady = runs_of(name), Horizon.of(SYSTEMS[name]).begin * MICROSECOND
        assert not any(run.program.left_out or run.program.chains_left_out for run in runs), name
        wrong += [f"{name} {text}" for text in different(FACTS[name], runs, steady)]
        wrong += [f"{name} {text}" for text in beyond(analyze_system(to_perf(SYSTEMS[name])), runs, steady)]
    assert wrong == []


def different(fact, runs, steady):
    """What is determined, but was simulated differently."""
    for name, known in fact["processes"].items():
        responses = {end - activation for run in runs for activation, _, end in run.jobs_of(name)}
        expected = known["occurs_min_us"] * MICROSECOND, known["occurs_max_us"] * MICROSECOND
        if known["determined"] and (min(responses), max(responses)) != expected:
            yield f"{name}: {min(responses)}..{max(responses)}, not {expected}"
    for chain, known in fact["chains"].items():
        for run in runs if known["determined"] else ():
            observed = latencies(run, chain, steady)
            for quantity, value in known.items():
                side, _, what = quantity.partition("_")
                if what in observed and value is not None:
                    found = getattr(observed[what], side)
                    if found != value * MICROSECOND:
                        yield f"{chain}: {quantity} {found}, not {value}"


@needs_vectors
@pytest.mark.skipif(find_spec("numba") is None, reason="numba is not installed")
def test_machine_code_plays_as_the_interpreted_kernel_does():
    for name in sorted(FACTS)[::12]:
        options = Options(duration=500 * MICROSECOND, seed=3, traced=(0, 300 * MICROSECOND))
        slow, fast = (record(to_perf(SYSTEMS[name]), options, is_compiled=compiled) for compiled in (False, True))
        for kind in ("jobs", "observations", "events"):
            np.testing.assert_array_equal(getattr(fast, kind), getattr(slow, kind), err_msg=f"{name} {kind}")
