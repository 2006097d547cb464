"""The simulation plays as the player does, which shares no code with it.

Where it is open how a system is to be read, the simulation has the readings of `SIMULATION`: what follows an execution is done before
somebody arrives at that instant, and a job with nothing left to do ends at once; equals go in the order of the model; cooperative
tasks let others go first after all calls, and others interrupt them anywhere; the most urgent one of those that wait gets a semaphore;
under earliest deadline first, the deadline of the holder is shortened; non-interruptible groups keep interrupts off; a time slice goes
on after a preemption.
"""

from importlib.util import find_spec

import numpy as np
import pytest
from effort import every
from opponent.generator import random_system
from opponent.invariants import disobeyed_priorities, violations
from opponent.models.facts import horizon
from opponent.models.player import play
from opponent.models.reading import read
from opponent.models.variants import Ceilings, Choices, Handover, Intruders, Points, Variant
from opponent.simulation import record
from opponent.systems import constructs_of, has_open_choices
from opponent.to_perf import MICROSECOND, read_system, to_perf
from opponent.to_text import to_text

from amalthea_uros.simulate.options import Options
from amalthea_uros.units import Duration

SIMULATION = Variant(
    accesses_last=True,
    points=Points.CALLS,
    intruders=Intruders.PREEMPTIVE,
    handover=Handover.URGENT,
    ceilings=Ceilings.DEADLINE,
)
#: The simulation takes a counter for something left to do, also where the counter then skips the rest of the job; the player does not.
SKIPPED_ENDS = {"counter of a trigger", "counter of a call"}


def has_same_jobs(plain):
    """Whether the jobs of a system without open choices are those of the player."""
    text = to_text(plain)
    model = read(text)
    until = horizon(model) // 2
    found = record(read_system(text), Options(duration=Duration(until)))
    played = play(model, SIMULATION, Choices(1), until).jobs
    return all(
        found.jobs_of(process.name) == [(j.activated, j.start, j.end) for j in jobs if j.end is not None and j.end < until]
        for process, jobs in zip(model.processes, played, strict=True)
    )


def is_comparable(plain):
    constructs = constructs_of(plain)
    return not has_open_choices(plain) and not ("trigger" in constructs and constructs & SKIPPED_ENDS)


@pytest.mark.parametrize("first", range(0, 2000, 200))
def test_jobs_of_determined_systems_are_those_of_the_player(first):
    systems = {seed: random_system(seed) for seed in every(8, range(first, first + 200))}
    assert [seed for seed, plain in systems.items() if is_comparable(plain) and not has_same_jobs(plain)] == []


@pytest.mark.parametrize("first", range(0, 400, 100))
def test_schedules_keep_to_the_rules(first):
    found = {seed: texts for seed in every(10, range(first, first + 100)) if (texts := violations(random_system(seed)))}
    assert found == {}


def test_broken_rules_are_found():
    def task(name, priority):
        process = {"name": name, "kind": "task", "core": "core0", "priority": priority, "preemption": "preemptive"}
        return {**process, "arrival": {"periodic": {"period": 10}}, "body": [{"execute": [2, 2]}]}

    plain = {"cores": {"core0": "FPP"}, "semaphores": {}, "runnables": {}, "processes": [task("low", 1), task("high", 2)]}
    reversed_priorities = [p | {"priority": -p["priority"]} for p in plain["processes"]]
    run = record(to_perf(plain), Options(duration=Duration(100 * MICROSECOND), traced=(0, Duration(10**9))))
    assert list(disobeyed_priorities(plain, run)) == []
    assert list(disobeyed_priorities(plain | {"processes": reversed_priorities}, run))


@pytest.mark.skipif(find_spec("numba") is None, reason="numba is not installed")
def test_machine_code_plays_as_the_interpreted_kernel_does():
    for seed in every(5, range(25)):
        system = to_perf(random_system(seed))
        options = Options(duration=Duration(500 * MICROSECOND), seed=3, traced=(0, Duration(300 * MICROSECOND)))
        slow, fast = (record(system, options, is_compiled=compiled) for compiled in (False, True))
        for kind in ("jobs", "observations", "events"):
            np.testing.assert_array_equal(getattr(fast, kind), getattr(slow, kind), err_msg=f"{seed} {kind}")
